// Bodies tied up in more joints and springs than they have freedom, thrown about: whatever happens to them, a
// run goes on to its end with finite speeds. Each of these once ended at a state that was not a finite
// number.
#include <gtest/gtest.h>

#include <cmath>

#include "world/world.h"

namespace smokebox {
namespace {

/// Runs two seconds; a state that is not finite throws. The fastest body at the end, m/s.
double fastest(const std::string& yaml) {
  World world(
      SceneDocument::parse("domain: {size: [4, 4], resolution: 32}\ntime: {step: 1/60, duration: 2}\n" + yaml,
                           "tied.yaml"),
      {.threads = 1, .figures = true});
  double most = 0;
  while (world.stepCount() < 120) {
    world.step();
    most = 0;
    for (const BodyFigures& body : world.figures().bodies) most = std::max(most, length(body.velocity));
  }
  return most;
}

TEST(TiedUp, TwoRailsAndASpringBetweenThem) {
  EXPECT_LT(
      fastest("walls: {left: periodic, right: periodic}\n"
              "bodies:\n"
              "- {name: b0, shape: {circle: {radius: 0.2}}, position: [1.83,0.45], bounce: 0.00, velocity: "
              "[-1.41,0.75], spin: -426}\n"
              "- {name: b1, shape: {circle: {radius: 0.2}}, position: [3.51,0.84], bounce: 0.37, velocity: "
              "[0.78,-1.82], spin: 312, held_until: 0.90}\n"
              "cloth: [{name: s, corner: [1,1], size: [1,1], cells: [5,5], mass: 0.3, stiffness: 127.173, "
              "tear: 10}]\n"
              "springs:\n"
              "- {name: k0, from: {body: s.5.5}, to: {body: b0}, stiffness: 515, damping: 1, length: 0.75}\n"
              "joints:\n"
              "- {name: j0, slide: [b0, world], at: [2.50,2.03]}\n"
              "- {name: j3, slide: [b1, b0], at: [3.71,1.11]}\n"),
      1000);
}

TEST(TiedUp, ARailOfParticlesAndARopeToWhatIsPinned) {
  EXPECT_LT(
      fastest(
          "bodies:\n"
          "- {name: b0, shape: {capsule: {length: 0.4, radius: 0.1}}, position: [3.20,3.44], bounce: 0.43, "
          "velocity: [3.07,-3.45], spin: 833}\n"
          "- {name: b1, shape: {ellipse: {radii: [0.3,0.1]}}, position: [1.00,3.31], bounce: 0.76, velocity: "
          "[3.29,-2.83], spin: -287, held_until: 0.58}\n"
          "particles: [{name: p, position: [2,2]}]\n"
          "cloth: [{name: s, corner: [1,1], size: [1,1], cells: [5,5], mass: 0.3, stiffness: 1.30529, tear: "
          "10}]\n"
          "springs:\n"
          "- {name: k0, from: {body: p}, to: {body: b0}, stiffness: 466, damping: 0, length: 0.76}\n"
          "- {name: k2, from: {body: b0}, to: {body: s.5.5}, stiffness: 44.1, damping: 100, length: 0.18}\n"
          "- {name: k3, from: {body: p}, to: {body: s.2.2}, stiffness: 0.535, damping: 1, length: 0.50}\n"
          "joints:\n"
          "- {name: j0, slide: [s.5.5, s.2.2], at: [0.78,0.05]}\n"
          "- {name: j2, rope: [b1, p]}\n"
          "- {name: j3, pin: [world, p], at: [2.89,0.40]}\n"),
      1000);
}

TEST(TiedUp, SpinningBodiesAndARailThroughACloth) {
  EXPECT_LT(
      fastest(
          "bodies:\n"
          "- {name: b3, shape: {regular: {sides: 5, radius: 0.2}}, position: [1.31,2.09], bounce: 0.52, "
          "velocity: [2.91,-0.40], spin: 912}\n"
          "- {name: b5, shape: {capsule: {length: 0.4, radius: 0.1}}, position: [3.09,1.32], bounce: 0.35, "
          "velocity: [-2.11,-0.60], spin: 749}\n"
          "cloth: [{name: s, corner: [1,1], size: [1,1], cells: [5,5], mass: 0.3, stiffness: 1114.61, tear: "
          "10}]\n"
          "springs:\n"
          "- {name: k1, from: {body: b5}, to: {body: b3}, stiffness: 2.27e+05, damping: 0, length: 1.01}\n"
          "joints:\n"
          "- {name: j0, slide: [world, s.2.2], at: [1.09,2.42]}\n"),
      1000);
}

TEST(TiedUp, AParticleOfAClothThatIsWelded) {
  EXPECT_LT(
      fastest("gravity: [0, -10]\n"
              "bodies:\n"
              "- {name: b0, shape: {capsule: {length: 0.4, radius: 0.1}}, position: [2.53,3.06], bounce: "
              "0.44, velocity: [0.72,2.68], spin: -723}\n"
              "- {name: b1, shape: {box: {size: [0.4,0.2]}}, position: [1.38,1.22], bounce: 0.13, velocity: "
              "[-0.11,-3.75], spin: 226, held_until: 0.91}\n"
              "cloth: [{name: s, corner: [1,1], size: [1,1], cells: [5,5], mass: 0.3, stiffness: 8242.66, "
              "tear: 0.1}]\n"
              "springs:\n"
              "- {name: k2, from: {body: b0}, to: {body: s.5.5}, stiffness: 155, damping: 0, length: 0.18}\n"
              "joints:\n"
              "- {name: j0, slide: [s.2.2, s.5.5], at: [0.37,2.02]}\n"
              "- {name: j2, weld: [s.2.2, world], at: [0.04,0.74]}\n"),
      1000);
}

TEST(TiedUp, ARopeToWhatIsWeldedAndAPinToWhatIsHeld) {
  EXPECT_LT(
      fastest(
          "bodies:\n"
          "- {name: b0, shape: {regular: {sides: 5, radius: 0.2}}, position: [0.62,3.23], bounce: 0.72, "
          "velocity: [-2.62,-2.07], spin: -708, held_until: 0.42}\n"
          "- {name: b1, shape: {circle: {radius: 0.2}}, position: [0.68,2.32], bounce: 0.88, velocity: "
          "[-2.91,-3.39], spin: 999}\n"
          "- {name: b2, shape: {polygon: [[0,0],[0.4,0],[0.4,0.4],[0.3,0.1]]}, position: [1.82,0.83], "
          "bounce: 0.26, velocity: [-0.73,-1.33], spin: -953, held_until: 0.12}\n"
          "- {name: b3, shape: {box: {size: [0.4,0.2]}}, position: [1.82,2.19], bounce: 0.98, velocity: "
          "[-1.93,2.90], spin: 143}\n"
          "- {name: b5, shape: {circle: {radius: 0.2}}, position: [2.50,1.75], bounce: 0.69, velocity: "
          "[-0.22,-2.17], spin: -13}\n"
          "particles: [{name: p, position: [2,2]}]\n"
          "cloth: [{name: s, corner: [1,1], size: [1,1], cells: [5,5], mass: 0.3, stiffness: 7351.86, tear: "
          "0.5}]\n"
          "springs:\n"
          "- {name: k1, from: {body: b0}, to: {body: b5}, stiffness: 4.73e+03, damping: 100, length: 0.54}\n"
          "- {name: k2, from: {body: b1}, to: {body: b0}, stiffness: 2.13, damping: 100, length: 0.76}\n"
          "joints:\n"
          "- {name: j1, weld: [p, world], at: [2.42,1.99]}\n"
          "- {name: j2, rope: [p, b5]}\n"
          "- {name: j3, pin: [b3, b2], at: [2.68,3.89]}\n"),
      1000);
}

TEST(TiedUp, ARingOfAPinAndTwoRails) {
  EXPECT_LT(fastest("gravity: [0, -10]\n"
                    "walls: {left: periodic, right: periodic}\n"
                    "bodies:\n"
                    "- {name: b0, shape: {regular: {sides: 5, radius: 0.2}}, position: [0.85,1.50], bounce: "
                    "0.89, velocity: [-1.97,-3.02], spin: 233}\n"
                    "- {name: b1, shape: {regular: {sides: 5, radius: 0.2}}, position: [3.47,2.62], bounce: "
                    "0.02, velocity: [1.27,2.22], spin: 447}\n"
                    "- {name: b2, shape: {capsule: {length: 0.4, radius: 0.1}}, position: [3.47,0.85], "
                    "bounce: 0.37, velocity: [-0.13,2.93], spin: 439}\n"
                    "- {name: b3, shape: {regular: {sides: 5, radius: 0.2}}, position: [3.38,3.08], bounce: "
                    "0.30, velocity: [-2.15,-0.09], spin: -481}\n"
                    "particles: [{name: p, position: [2,2]}]\n"
                    "cloth: [{name: s, corner: [1,1], size: [1,1], cells: [5,5], mass: 0.3, stiffness: "
                    "11880.7, tear: 0.1}]\n"
                    "joints:\n"
                    "- {name: j0, pin: [b1, s.5.5], at: [3.65,2.73]}\n"
                    "- {name: j1, slide: [b0, b1], at: [1.56,2.83]}\n"
                    "- {name: j3, slide: [s.5.5, b0], at: [2.07,2.86]}\n"),
            1000);
}

TEST(TiedUp, AStiffSpringToAParticleOnARail) {
  EXPECT_LT(
      fastest(
          "bodies:\n"
          "- {name: b0, shape: {circle: {radius: 0.2}}, position: [1.31,3.41], bounce: 0.94, velocity: "
          "[-2.82,0.16], spin: -383}\n"
          "- {name: b1, shape: {box: {size: [0.4,0.2]}}, position: [1.57,3.60], bounce: 0.12, velocity: "
          "[-0.00,-0.16], spin: -505}\n"
          "- {name: b2, shape: {regular: {sides: 5, radius: 0.2}}, position: [0.47,0.47], bounce: 0.62, "
          "velocity: [-3.53,0.07], spin: -40, held_until: 0.34}\n"
          "cloth: [{name: s, corner: [1,1], size: [1,1], cells: [5,5], mass: 0.3, stiffness: 59.9853, tear: "
          "0.5}]\n"
          "springs:\n"
          "- {name: k0, from: {body: b2}, to: {body: s.5.5}, stiffness: 4.1e+04, damping: 1, length: 0.73}\n"
          "joints:\n"
          "- {name: j2, slide: [s.5.5, world], at: [2.24,1.56]}\n"),
      1000);
}

}  // namespace
}  // namespace smokebox
