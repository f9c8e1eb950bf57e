// Taylor-Green vortices that drift: an exact solution of Euler's equations which moves without change. At
// rest they would prove nothing, for then a flux scheme stands still too.
#include <algorithm>
#include <cmath>

#include "base/maths.h"
#include "study/cases.h"
#include "world/world.h"

namespace smokebox {

namespace {

constexpr double kEnd = 2, kDriftX = 1, kDriftY = 0.5;  // s, m/s

std::string sceneOf(int size) {
  // The largest velocity along x is 2 m/s: a Courant number of 0.8.
  const std::string steps = std::to_string(static_cast<int>(std::ceil(kEnd * 2 * size / 0.8)));
  return "domain: {size: [1, 1], resolution: " + std::to_string(size) + R"yaml(}
walls: {left: periodic, right: periodic, bottom: periodic, top: periodic}
fluid: {velocity: ["1 - cos(2*pi*x)*sin(2*pi*y)", "0.5 + sin(2*pi*x)*cos(2*pi*y)"]}
output: {fps: 1}
time: {duration: 2, step: 2/)yaml" +
         steps + "}\n";
}

StudyOutcome measure(const SceneDocument& scene, int threads) {
  World world(scene, {.threads = threads});
  while (world.stepCount() < world.spec().time.steps) world.step();
  const Grid& grid = world.spec().domain.grid;
  const Fluid& fluid = *world.fluid();
  const double t = world.time(), k = 2 * kPi;
  double error = 0;
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      const Vec2 a = grid.xFaceCentre(i, j) - Vec2{kDriftX * t, kDriftY * t},
                 b = grid.yFaceCentre(i, j) - Vec2{kDriftX * t, kDriftY * t};
      const double u = kDriftX - std::cos(k * a.x) * std::sin(k * a.y),
                   v = kDriftY + std::sin(k * b.x) * std::cos(k * b.y);
      error = std::max({error, std::fabs(fluid.u()(i, j) - u), std::fabs(fluid.v()(i, j) - v)});
    }
  return {{{"max error of the velocity", error, 0, error}}, world.stepCount()};
}

}  // namespace

Study driftingVortices() {
  return {"drifting-vortices",
          "Taylor-Green vortices drifting at (1, 0.5) m/s for 2 s; size: cells along a side",
          "exact",
          {32, 64, 128, 256},
          sceneOf,
          measure};
}

}  // namespace smokebox
