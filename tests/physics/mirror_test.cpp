// A mirrored problem has the mirrored solution.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "world/world.h"

namespace smokebox {
namespace {

// How many values of velocity, pressure and smoke differ from those in the mirror, and the largest speed.
struct Unlike {
  long values = 0;
  double speed = 0;
};
Unlike unlikeAfter(int steps, const std::string& scene, bool leftRight) {
  World world(SceneDocument::parse(scene, "mirror.yaml"), {.threads = 2});
  for (int k = 0; k < steps; ++k) world.step();
  const Fluid& fluid = *world.fluid();
  const int nx = world.boundary().grid.nx, ny = world.boundary().grid.ny;
  Unlike unlike;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int x = leftRight ? nx - 1 - i : i, y = leftRight ? j : ny - 1 - j;
      const float u = leftRight ? -fluid.u()(nx - i, j) : fluid.u()(i, y);
      const float v = leftRight ? fluid.v()(x, j) : -fluid.v()(i, ny - j);
      unlike.values += fluid.u()(i, j) != u;
      unlike.values += fluid.v()(i, j) != v;
      unlike.values += fluid.phi()(i, j) != fluid.phi()(x, y);
      if (world.smoke())
        unlike.values += world.smoke()->smoke().value(0)(i, j) != world.smoke()->smoke().value(0)(x, y);
      unlike.speed =
          std::max<double>(unlike.speed, std::max(std::abs(fluid.u()(i, j)), std::abs(fluid.v()(i, j))));
    }
  return unlike;
}

TEST(Mirror, IsMirroredToTheBitBetweenLeftAndRight) {
  // Truth: u(x) = -u(-x), v and phi the same on both sides, after 40 steps of a stirred, confined, viscous
  // flow against a disk on the axis: not a bit differs, though no iteration is exact.
  const Unlike unlike = unlikeAfter(40, R"yaml(
domain: {size: [1, 1.25], resolution: 64}
walls: {top: open, left: no-slip, right: no-slip}
fluid:
  viscosity: 1e-4
  vorticity: 0.3
  velocity: ["(x - 0.5)*sin(9*y)", "cos(5*(x - 0.5))*sin(3*y)"]
solids: [{name: disk, shape: {circle: {radius: 0.12}}, position: [0.5, 0.8]}]
output: {fps: 1}
time: {duration: 1, step: 1/100}
)yaml",
                                    true);
  EXPECT_GT(unlike.speed, 0.2);
  EXPECT_EQ(unlike.values, 0);
}

TEST(Mirror, IsMirroredToTheBitBetweenUpAndDown) {
  // Truth: the same on its side, v(y) = -v(-y).
  const Unlike unlike = unlikeAfter(40, R"yaml(
domain: {size: [1.25, 1], resolution: 80}
walls: {right: open, bottom: no-slip, top: no-slip}
fluid:
  viscosity: 1e-4
  vorticity: 0.3
  velocity: ["cos(5*(y - 0.5))*sin(3*x)", "(y - 0.5)*sin(9*x)"]
solids: [{name: disk, shape: {circle: {radius: 0.12}}, position: [0.8, 0.5]}]
output: {fps: 1}
time: {duration: 1, step: 1/100}
)yaml",
                                    false);
  EXPECT_GT(unlike.speed, 0.2);
  EXPECT_EQ(unlike.values, 0);
}

TEST(Mirror, SmokeIsMirroredToTheBitBothWays) {
  // Truth: a jet of smoke shot up from the middle between two disks is its own image, and so is the picture
  // turned on its side, to the bit: what rounding, flux limits and full cells take goes no way rather than
  // the other.
  const std::string rest = R"yaml(
fluid: {vorticity: 0.2}
output: {fps: 1}
time: {duration: 10, step: 1/50}
)yaml";
  const Unlike up = unlikeAfter(100, R"yaml(
domain: {size: [2, 2], resolution: 64}
smoke: {sources: [{shape: {circle: {center: [1, 1], radius: 0.15}}, rate: 2}]}
solids:
  - {shape: {circle: {radius: 0.12}}, position: [0.7, 1.3]}
  - {shape: {circle: {radius: 0.12}}, position: [1.3, 1.3]}
events: [{at: 0.1, force: {circle: {center: [1, 1], radius: 0.3}, acceleration: [0, 8], for: 0.3}}]
)yaml" + rest,
                                true);
  const Unlike aside = unlikeAfter(100, R"yaml(
domain: {size: [2, 2], resolution: 64}
smoke: {sources: [{shape: {circle: {center: [1, 1], radius: 0.15}}, rate: 2}]}
solids:
  - {shape: {circle: {radius: 0.12}}, position: [1.3, 0.7]}
  - {shape: {circle: {radius: 0.12}}, position: [1.3, 1.3]}
events: [{at: 0.1, force: {circle: {center: [1, 1], radius: 0.3}, acceleration: [8, 0], for: 0.3}}]
)yaml" + rest,
                                   false);
  EXPECT_GT(up.speed, 0.5);
  EXPECT_EQ(up.values, 0);
  EXPECT_GT(aside.speed, 0.5);
  EXPECT_EQ(aside.values, 0);
}

}  // namespace
}  // namespace smokebox
