// Fluid at rest under gravity with a solid in it stays at rest. The second case fills it with smoke that is
// heavier than air: the pressure has to carry it, to rounding.
#include <algorithm>
#include <cmath>

#include "study/cases.h"
#include "world/world.h"

namespace smokebox {

namespace {

constexpr double kGravity = 9.81, kHeight = 1;  // m/s^2, m

std::string sceneOf(bool heavySmoke, int size) {
  return "domain: {size: [1, 1], resolution: " + std::to_string(size) + R"yaml(}
gravity: [0, -9.81]
fluid: {viscosity: 1e-4, vorticity: 0.3}
solids: [{name: disk, shape: {circle: {radius: 0.17}}, position: [0.41, 0.53]}]
output: {fps: 1}
time: {duration: 1, step: 1/100}
)yaml" +
         (heavySmoke ? "smoke: {buoyancy: -9.81}\n"
                       "events: [{at: 0, burst: {box: {size: [2, 2]}, position: [0.5, 0.5], smoke: 1}}]\n"
                     : "");
}

StudyOutcome measure(const SceneDocument& scene, int threads) {
  World world(scene, {.threads = threads});
  while (world.stepCount() < world.spec().time.steps) world.step();
  const Grid& grid = world.spec().domain.grid;
  double speed = 0;
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i)
      speed = std::max({speed, std::fabs(static_cast<double>(world.fluid()->u()(i, j))),
                        std::fabs(static_cast<double>(world.fluid()->v()(i, j)))});
  const double relative = speed / std::sqrt(kGravity * kHeight);
  return {{{"largest speed over sqrt(g height)", relative, 0, relative}}, world.stepCount()};
}

Study rest(bool heavySmoke) {
  return {heavySmoke ? "rest-heavy-smoke" : "rest",
          "speed after 100 steps of a fluid that should be at rest; size: cells along a side",
          "exact",
          {64, 128},
          [heavySmoke](int size) { return sceneOf(heavySmoke, size); },
          measure};
}

}  // namespace

std::vector<Study> fluidsAtRest() { return {rest(false), rest(true)}; }

}  // namespace smokebox
