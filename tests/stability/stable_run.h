// A scene run for some steps, with what must hold in every one of them: all finite, the divergence below the
// tolerance, no smoke lost or made, no smoke outside 0 to what can be, the energy bounded.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "world/world.h"

namespace smokebox::test {

struct StableRun {
  double energyStart = 0, energyMost = 0, energyEnd = 0;  // J per metre of depth
  double compressionMost = 0;                             // 1/s
  double speedMost = 0;                                   // m/s at the end
  long steps = 0;
};

constexpr double kSmokeError = 1e-6;

/// `energyBound`: J per metre of depth; 0: none but that it is a number.
inline StableRun runStably(const std::string& scene, long steps, double energyBound = 0) {
  StableRun run;
  SCOPED_TRACE(scene);
  try {
    World world(SceneDocument::parse(scene, "scene.yaml"), {.threads = 2, .figures = true});
    const double tolerance = world.spec().method.tolerance;
    run.energyStart = run.energyMost = world.figures().energyFluid;
    for (; run.steps < steps; ++run.steps) {
      world.step();
      const StepFigures& f = world.figures();
      run.energyMost = std::max(run.energyMost, f.energyFluid);
      run.compressionMost = std::max(run.compressionMost, std::fabs(f.compression));
      if (!std::isfinite(f.energyFluid) || !std::isfinite(f.momentum.x) || !std::isfinite(f.momentum.y)) {
        ADD_FAILURE() << "step " << run.steps + 1 << ": not finite";
        return run;
      }
      if (!(f.divergence <= tolerance)) {
        ADD_FAILURE() << "step " << run.steps + 1 << ": divergence " << f.divergence;
        return run;
      }
      if (world.smoke() && !(f.smoke.min >= -1e-6 && std::isfinite(f.smoke.max))) {
        ADD_FAILURE() << "step " << run.steps + 1 << ": smoke from " << f.smoke.min << " to " << f.smoke.max;
        return run;
      }
    }
    EXPECT_LE(std::fabs(world.summary().smokeError), kSmokeError);
    run.energyEnd = world.figures().energyFluid;
    if (energyBound > 0) {
      EXPECT_LE(run.energyMost, energyBound);
    }
    if (const Fluid* fluid = world.fluid()) {
      const Grid& grid = world.spec().domain.grid;
      for (int j = 0; j < grid.ny; ++j)
        for (int i = 0; i < grid.nx; ++i)
          run.speedMost =
              std::max<double>({run.speedMost, std::fabs(fluid->u()(i, j)), std::fabs(fluid->v()(i, j))});
    }
  } catch (const Error& error) {
    ADD_FAILURE() << "step " << run.steps + 1 << ": " << error.what();
  }
  return run;
}

}  // namespace smokebox::test
