#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "base/maths.h"
#include "support/velocity_run.h"

namespace smokebox {
namespace {

using test::VelocityRun;

/// Swirls inside a slip box with a disk off its middle.
VelocityRun swirlAroundDisk(int n, int threads, double drag) {
  Boundary b = test::makeBox(n, n, 1.0 / n, test::kSlipBox);
  test::addSolid(
      b,
      [](Vec2 p) {
        return length(p - Vec2{0.52, 0.43}) - 0.17;
      },
      [](Vec2) { return Vec2{}; }, drag);
  return VelocityRun(b, threads);
}

void setSwirl(VelocityRun& run) {
  run.set(
      [](Vec2 p) {
        return std::sin(kPi * p.x) * std::cos(kPi * p.y) +
               0.5 * std::sin(3 * kPi * p.x) * std::cos(2 * kPi * p.y);
      },
      [](Vec2 p) { return -std::cos(kPi * p.x) * std::sin(kPi * p.y); });
  run.project();
  run.phi.fill(0);
}

bool sameBits(const Field& a, const Field& b) {
  for (int j = 0; j < a.ny(); ++j)
    if (std::memcmp(a.row(j), b.row(j), sizeof(float) * a.nx()) != 0) return false;
  return true;
}

TEST(Advection, UniformFlowAroundASolidThatMovesWithItStaysUniform) {
  // Without any relative motion there is nothing to carry, whatever the fractions of the faces.
  for (const double drag : {0.0, 1.0}) {
    const int n = 40;
    Boundary b = test::makeBox(n, n, 1.0 / n, test::kPeriodic);
    test::addSolid(
        b,
        [](Vec2 p) {
          return length(p - Vec2{0.5, 0.47}) - 0.2;
        },
        [](Vec2) {
          return Vec2{1, 0.5};
        },
        drag);
    VelocityRun run(b);
    run.u.fill(1);
    run.v.fill(0.5f);
    for (int s = 0; s < 10; ++s) run.step(0.01);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        EXPECT_NEAR(run.u(i, j), 1, 1e-5) << i << ' ' << j;
        EXPECT_NEAR(run.v(i, j), 0.5, 1e-5) << i << ' ' << j;
      }
  }
}

TEST(Advection, StaysBoundedAtAnyStepBesideASolid) {
  // No step size makes the energy of an unforced flow grow by more than the error of a coarse grid.
  for (const double courant : {0.1, 1.4, 3.0, 50.0})
    for (const double drag : {0.0, 1.0}) {
      VelocityRun run = swirlAroundDisk(32, 2, drag);
      setSwirl(run);
      const double start = run.energy(), dt = courant / 32 / 1.5;
      Advection::Result first;
      for (int s = 0; s < 120; ++s) {
        const Advection::Result result = run.step(dt);
        if (s == 0) first = result;
        ASSERT_TRUE(std::isfinite(run.energy())) << courant << ' ' << s;
        ASSERT_LT(run.energy(), 1.02 * start) << courant << ' ' << s;
      }
      if (courant == 0.1) {
        EXPECT_EQ(first.subSteps, 1);
      }
      if (courant == 3.0) {
        EXPECT_GT(first.subSteps, 1);
      }
      if (courant == 50.0) {
        EXPECT_EQ(first.subSteps, 0);
      }
    }
}

TEST(Advection, TheStepSizeHardlyChangesTheEnergyThatIsLost) {
  // What is lost beside a surface is the error in space; the time steps add next to nothing.
  double energy[2];
  for (int k = 0; k < 2; ++k) {
    VelocityRun run = swirlAroundDisk(32, 2, 0);
    setSwirl(run);
    const double dt = (k == 0 ? 0.25 : 1.0) / 32;
    for (int s = 0; s < (k == 0 ? 128 : 32); ++s) run.step(dt);
    energy[k] = run.energy();
  }
  EXPECT_NEAR(energy[1] / energy[0], 1, 1e-3);
}

TEST(Advection, TwoThreadsGiveTheBitsOfOne) {
  // Blocks do not depend on the number of threads.
  for (const double dt : {0.02, 0.06, 2.0}) {
    VelocityRun one = swirlAroundDisk(80, 1, 0.5), two = swirlAroundDisk(80, 2, 0.5);
    setSwirl(one);
    setSwirl(two);
    one.carry(dt);
    two.carry(dt);
    EXPECT_TRUE(sameBits(one.u, two.u) && sameBits(one.v, two.v)) << dt;
  }
}

TEST(Advection, MirroredFlowStaysMirroredToTheBit) {
  // Stencils treat both directions alike: only the projection, which is left out here, adds in an order of
  // its own.
  const int n = 48;
  const Boundary b =
      test::makeBox(n, n, 1.0 / n, {WallKind::noSlip, WallKind::noSlip, WallKind::slip, WallKind::open});
  auto carried = [&](bool mirrored) {
    VelocityRun run(b);
    auto x = [&](double place) { return mirrored ? 1 - place : place; };
    run.set([&](Vec2 p) { return std::sin(kPi * x(p.x)) * std::cos(3 * x(p.x) + 2 * p.y); },
            [&](Vec2 p) { return std::cos(5 * x(p.x) - p.y) * p.y; });
    // The same bits on both sides of the mirror, whatever the rounding of 1 - x.
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        run.u(i, j) = std::round(run.u(i, j) * 1024) / 1024 * (mirrored ? -1.0f : 1.0f);
        run.v(i, j) = std::round(run.v(i, j) * 1024) / 1024;
      }
    run.advection.advance(b, run.u, run.v, run.phi, nullptr, nullptr, 0.01,
                          [](Field&, Field&, int, double) {});
    return run.u;
  };
  const Field u = carried(false), m = carried(true);
  for (int j = 0; j < n; ++j)
    for (int i = 1; i < n; ++i) ASSERT_EQ(u(i, j), -m(n - i, j)) << i << ' ' << j;
}

TEST(Advection, AccelerationAndLaggedPressureAreAppliedOnceAtAnyStepSize) {
  // A uniform stream takes dt a - grad phi, however the step is cut: one step, sub-steps, semi-Lagrangian.
  const int n = 24;
  for (const double speed : {0.0, 2.0, 50.0}) {
    VelocityRun run(test::makeBox(n, n, 1.0 / n, test::kPeriodic));
    auto carry = [&](const Field* acceleration) {
      run.u.fill(static_cast<float>(speed));
      run.v.fill(0);
      run.advection.advance(run.boundary, run.u, run.v, run.phi, acceleration, nullptr, 0.05,
                            [](Field&, Field&, int, double) {});
    };
    const Field acceleration(n, n, 3);
    carry(&acceleration);
    for (const int i : {0, 5}) EXPECT_NEAR(run.u(i, 5), speed + 0.15, 1e-6 * (1 + speed));
    // Small, so that what it drives carries nothing itself.
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) run.phi(i, j) = j % 2 ? 1e-4f : 0.0f;
    carry(nullptr);
    for (const int j : {0, 5}) EXPECT_NEAR(run.v(7, j), j == 0 ? 1e-4 : -1e-4, 1e-6);
  }
}

TEST(Advection, VorticesLeaveThroughAnOpenSide) {
  // A dipole that swims out takes its energy with it, and the side does not feed it back.
  const int n = 48;
  const double h = 1.0 / n;
  VelocityRun run(test::makeBox(n, n, h, {WallKind::slip, WallKind::open, WallKind::slip, WallKind::slip}),
                  2);
  auto stream = [](double x, double y) {
    double sum = 0;
    for (const int side : {-1, 1}) {
      const double dx = x - 0.6, dy = y - 0.5 - side * 0.1;
      sum += side * 0.15 * std::exp(-(dx * dx + dy * dy) / 0.01);
    }
    return sum;
  };
  run.set([&](Vec2 p) { return (stream(p.x, p.y + h / 2) - stream(p.x, p.y - h / 2)) / h; },
          [&](Vec2 p) { return -(stream(p.x + h / 2, p.y) - stream(p.x - h / 2, p.y)) / h; });
  run.project();
  const double start = run.energy();
  for (int s = 0; s < 250; ++s) run.step(0.4 * h / 2.2);
  const double left = run.energy();
  EXPECT_LT(left, 0.4 * start);
  for (int s = 0; s < 600; ++s) run.step(0.4 * h / 2.2);
  EXPECT_LT(run.energy(), 1.01 * left);
}

}  // namespace
}  // namespace smokebox
