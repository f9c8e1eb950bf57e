#include <gtest/gtest.h>

#include <cmath>

#include "base/maths.h"
#include "support/velocity_run.h"

namespace smokebox {
namespace {

using test::VelocityRun;

struct Drifted {
  double error = 0;     // largest, m/s
  double momentum = 0;  // change of the mean velocity, m/s
  double energy = 0;    // at the end over that at the start
};

/// Vortices that drift through a periodic unit square at (1, 0.5) for 2 s, at this Courant number of the
/// largest u.
Drifted drift(int n, double courant = 0.8) {
  const double h = 1.0 / n, k = 2 * kPi;
  VelocityRun run(test::makeBox(n, n, h, test::kPeriodic), 2);
  auto exactU = [&](Vec2 p, double t) { return 1 - std::cos(k * (p.x - t)) * std::sin(k * (p.y - 0.5 * t)); };
  auto exactV = [&](Vec2 p, double t) {
    return 0.5 + std::sin(k * (p.x - t)) * std::cos(k * (p.y - 0.5 * t));
  };
  run.set([&](Vec2 p) { return exactU(p, 0); }, [&](Vec2 p) { return exactV(p, 0); });
  const int steps = static_cast<int>(std::ceil(2 * 2 / (courant * h)));
  const double dt = 2.0 / steps;
  run.findPressure(dt);

  const double energy = run.energy();
  for (int s = 0; s < steps; ++s) run.step(dt);
  Drifted result;
  double sumU = 0, sumV = 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Grid& g = run.boundary.grid;
      result.error = std::max(result.error, std::fabs(run.u(i, j) - exactU(g.xFaceCentre(i, j), 2)));
      result.error = std::max(result.error, std::fabs(run.v(i, j) - exactV(g.yFaceCentre(i, j), 2)));
      sumU += run.u(i, j);
      sumV += run.v(i, j);
    }
  result.momentum = std::hypot(sumU / (n * n) - 1, sumV / (n * n) - 0.5);
  result.energy = run.energy() / energy;
  std::printf("Taylor-Green %d: error %.3e, momentum %.1e, energy %.6f\n", n, result.error, result.momentum,
              result.energy);
  return result;
}

TEST(TaylorGreen, DriftingVorticesKeepTheirShapeWithHighOrder) {
  // The exact solution of Euler's equations moves without change; the error falls by more than 2^2.5 per
  // halving.
  const Drifted coarse = drift(32), middle = drift(64), fine = drift(128);
  EXPECT_LT(middle.error, 6.5e-4);
  EXPECT_LT(fine.error, 1.0e-4);
  const double order = std::log2(coarse.error / fine.error) / 2;
  std::printf("Taylor-Green: fitted order %.2f\n", order);
  EXPECT_GT(order, 2.5);
  // Momentum is conserved to rounding, energy nearly.
  for (const Drifted& d : {coarse, middle, fine}) EXPECT_LT(d.momentum, 1e-6);
  EXPECT_NEAR(fine.energy, 1, 1e-5);
}

TEST(TaylorGreen, SubStepsAreAsExactAsStepsOfTheirSize) {
  // The pressure follows between sub-steps: three times the step costs no more than twice the error.
  EXPECT_LT(drift(64, 2.4).error, 2 * drift(64, 0.8).error);
}

}  // namespace
}  // namespace smokebox
