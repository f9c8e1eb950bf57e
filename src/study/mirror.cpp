// A scene that is its own mirror image, and must stay so: smoke that rises against a disk on the axis, with
// vorticity confinement. The second case is the same turned on its side.
#include <algorithm>
#include <cmath>

#include "study/cases.h"
#include "world/world.h"

namespace smokebox {

namespace {

std::string sceneOf(bool upright, int size) {
  const std::string n = std::to_string(size);
  const std::string head = upright ? "domain: {size: [1, 1.5], resolution: " + n + "}\n"
                                   : "domain: {size: [1.5, 1], resolution: 3*" + n + "/2}\n";
  const std::string rest = upright ? R"yaml(
walls: {top: open, left: no-slip, right: no-slip}
gravity: [0, -9.81]
smoke:
  buoyancy: 2
  sources: [{shape: {circle: {center: [0.5, 0.25], radius: 0.1}}, rate: 8, velocity: [0, 0.5]}]
solids: [{name: disk, shape: {circle: {radius: 0.12}}, position: [0.5, 0.8]}]
)yaml"
                                   : R"yaml(
walls: {right: open, bottom: no-slip, top: no-slip}
gravity: [-9.81, 0]
smoke:
  buoyancy: 2
  sources: [{shape: {circle: {center: [0.25, 0.5], radius: 0.1}}, rate: 8, velocity: [0.5, 0]}]
solids: [{name: disk, shape: {circle: {radius: 0.12}}, position: [0.8, 0.5]}]
)yaml";
  return head + rest + "fluid: {viscosity: 1e-4, vorticity: 0.3}\noutput: {fps: 1}\n" +
         "time: {duration: 2, step: 1/100}\n";
}

StudyOutcome measure(bool upright, const SceneDocument& scene, int threads) {
  World world(scene, {.threads = threads});
  while (world.stepCount() < world.spec().time.steps) world.step();
  const Grid& grid = world.spec().domain.grid;
  const Fluid& fluid = *world.fluid();
  const Field& smoke = world.smoke()->smoke().value(0);
  double speed = 0, densest = 0, velocityOff = 0, smokeOff = 0;
  auto compare = [](double a, double b, double& largest, double& off) {
    largest = std::max(largest, std::fabs(a));
    off = std::max(off, std::fabs(a - b));
  };
  const int nx = grid.nx, ny = grid.ny;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      if (upright) {
        compare(fluid.u()(i, j), -fluid.u()(nx - i, j), speed, velocityOff);
        compare(fluid.v()(i, j), fluid.v()(nx - 1 - i, j), speed, velocityOff);
        compare(smoke(i, j), smoke(nx - 1 - i, j), densest, smokeOff);
      } else {
        compare(fluid.u()(i, j), fluid.u()(i, ny - 1 - j), speed, velocityOff);
        compare(fluid.v()(i, j), -fluid.v()(i, ny - j), speed, velocityOff);
        compare(smoke(i, j), smoke(i, ny - 1 - j), densest, smokeOff);
      }
    }
  return {{{"asymmetry of the velocity", velocityOff / speed, 0, velocityOff / speed},
           {"asymmetry of the smoke", smokeOff / densest, 0, smokeOff / densest},
           {"largest speed", speed, speed, 0}},
          world.stepCount()};
}

Study mirror(bool upright) {
  return {upright ? "mirror-left-right" : "mirror-up-down",
          "how unlike its mirror image a symmetric flow gets in 200 steps; size: cells across the axis",
          "exact",
          {64, 96, 100, 128},
          [upright](int size) { return sceneOf(upright, size); },
          [upright](const SceneDocument& scene, int threads) { return measure(upright, scene, threads); }};
}

}  // namespace

std::vector<Study> mirrorImages() { return {mirror(true), mirror(false)}; }

}  // namespace smokebox
