#include "fluid/vorticity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/maths.h"
#include "support/velocity_run.h"

namespace smokebox {
namespace {

/// Sets a round vortex in the middle of a periodic unit square, with a second, weaker one beside it.
void setVortices(test::VelocityRun& run) {
  auto swirl = [](Vec2 p) {
    Vec2 total;
    for (const auto& [centre, strength] :
         {std::pair{Vec2{0.45, 0.5}, 1.0}, std::pair{Vec2{0.62, 0.55}, -0.5}}) {
      const Vec2 d = p - centre;
      total = total + strength * std::exp(-dot(d, d) / 0.01) * perpendicular(d);
    }
    return total;
  };
  run.set([&](Vec2 p) { return swirl(p).x; }, [&](Vec2 p) { return swirl(p).y; });
  run.advection.extend(run.boundary, run.u, run.v);
}

TEST(Vorticity, RigidRotationHasTwiceItsSpinEverywhere) {
  // The curl of Omega x r is 2 Omega, exactly on this grid.
  const int n = 16;
  test::VelocityRun run(test::makeBox(n, n, 1.0 / n, test::kSlipBox));
  run.set([](Vec2 p) { return -3 * (p.y - 0.5); }, [](Vec2 p) { return 3 * (p.x - 0.5); });
  Field omega(n, n);
  vorticityAtNodes(run.boundary, run.u, run.v, run.pool, omega);
  for (int j = 1; j < n; ++j)
    for (int i = 1; i < n; ++i) EXPECT_NEAR(omega(i, j), 6, 1e-4);
}

TEST(Vorticity, ConfinementOfAnIrrotationalFlowIsExactlyZero) {
  // No vorticity, no force: not even rounding noise blown up by the normalisation.
  const int n = 32;
  test::VelocityRun run(test::makeBox(n, n, 1.0 / n, test::kPeriodic));
  run.u.fill(0.3f);
  run.v.fill(-0.7f);
  run.advection.extend(run.boundary, run.u, run.v);
  Confinement confinement(run.boundary, run.pool);
  Field au(n, n), av(n, n);
  confinement.addForce(run.boundary, run.u, run.v, 1, 1, au, av);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      EXPECT_EQ(au(i, j), 0);
      EXPECT_EQ(av(i, j), 0);
    }
}

TEST(Vorticity, ConfinementConvergesWithTheResolution) {
  // The force on a smooth flow has a limit: its mean size changes by less and less as the grid is refined.
  auto meanForce = [](int n) {
    test::VelocityRun run(test::makeBox(n, n, 1.0 / n, test::kPeriodic), 2);
    setVortices(run);
    Confinement confinement(run.boundary, run.pool);
    Field au(n, n), av(n, n);
    confinement.addForce(run.boundary, run.u, run.v, 0.3, 1.0 / 256, au, av);
    double sum = 0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) sum += std::fabs(au(i, j)) + std::fabs(av(i, j));
    return sum / (n * n);
  };
  const double coarse = meanForce(64), middle = meanForce(128), fine = meanForce(256),
               finest = meanForce(512);
  std::printf("Confinement, mean |force| at 64, 128, 256, 512: %.6e %.6e %.6e %.6e\n", coarse, middle, fine,
              finest);
  EXPECT_GT(finest, 1e-6);
  EXPECT_NEAR(coarse / finest, 1, 0.08);
  EXPECT_NEAR(middle / finest, 1, 0.03);
  EXPECT_LT(std::fabs(finest - fine), 0.7 * std::fabs(middle - coarse));
}

TEST(Vorticity, ConfinementSpinsAVortexUp) {
  // The force points along the swirl: it feeds a lone vortex, of either sign.
  for (const double sign : {1.0, -1.0}) {
    const int n = 64;
    test::VelocityRun run(test::makeBox(n, n, 1.0 / n, test::kPeriodic));
    auto swirl = [&](Vec2 p) {
      const Vec2 d = p - Vec2{0.5, 0.5};
      return sign * std::exp(-dot(d, d) / 0.01) * perpendicular(d);
    };
    run.set([&](Vec2 p) { return swirl(p).x; }, [&](Vec2 p) { return swirl(p).y; });
    run.advection.extend(run.boundary, run.u, run.v);
    Confinement confinement(run.boundary, run.pool);
    Field au(n, n), av(n, n);
    confinement.addForce(run.boundary, run.u, run.v, 1, 1, au, av);
    double power = 0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) power += au(i, j) * run.u(i, j) + av(i, j) * run.v(i, j);
    EXPECT_GT(power, 0);
  }
}

TEST(Vorticity, ConfinementLeavesShutFacesAlone) {
  // No force inside a solid or on a wall.
  const int n = 32;
  Boundary b = test::makeBox(n, n, 1.0 / n, test::kSlipBox);
  test::addSolid(
      b,
      [](Vec2 p) {
        return length(p - Vec2{0.5, 0.5}) - 0.2;
      },
      [](Vec2) { return Vec2{}; }, 1);
  test::VelocityRun run(b);
  run.set([](Vec2 p) { return std::sin(5 * p.y) * std::cos(3 * p.x); },
          [](Vec2 p) { return std::cos(7 * p.x); });
  run.advection.extend(b, run.u, run.v);
  Confinement confinement(b, run.pool);
  Field au(n, n), av(n, n);
  confinement.addForce(b, run.u, run.v, 1, 1, au, av);
  int pushed = 0;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      if (j < n && b.openX(i, j) == 0) {
        EXPECT_EQ(au(i, j), 0);
      }
      if (i < n && b.openY(i, j) == 0) {
        EXPECT_EQ(av(i, j), 0);
      }
      pushed += j < n && au(i, j) != 0;
    }
  EXPECT_GT(pushed, n * n / 4);
}

}  // namespace
}  // namespace smokebox
