#include "fluid/viscosity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/maths.h"
#include "support/velocity_run.h"

namespace smokebox {
namespace {

TEST(Viscosity, APeriodicWaveDecaysByTheExactImplicitFactor) {
  // An eigenvector of the five-point Laplacian is divided by 1 + c (4 - 2 cos - 2 cos), for a small step and
  // a huge one.
  const int n = 32;
  const double h = 1.0 / n, k = 2 * kPi;
  for (const double c : {0.1, 10.0, 1e5}) {
    const Boundary b = test::makeBox(n, n, h, test::kPeriodic);
    ThreadPool pool(2);
    Viscosity viscosity(b, pool);
    Field u(n, n), v(n, n);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i <= n; ++i) u(i, j) = static_cast<float>(std::cos(k * i * h) * std::sin(k * j * h));
    const Field before = u;
    const Viscosity::Result result = viscosity.diffuse(b, u, v, c * h * h, 1);
    EXPECT_TRUE(result.converged);
    const double factor = 1 / (1 + c * (4 - 4 * std::cos(k * h)));
    for (int j = 0; j < n; ++j)
      for (int i = 0; i <= n; ++i) EXPECT_NEAR(u(i, j), factor * before(i, j), 4e-6);
    EXPECT_EQ(v(3, 3), 0);
  }
}

struct Couette {
  double torque = 0;    // relative error
  double velocity = 0;  // largest error, m/s
  bool converged = false;
};

/// Steady flow between a cylinder that turns at 1 rad/s and a fixed one, `gap` cells apart.
Couette couette(double gap) {
  const double inner = 0.2, outer = 0.45, h = (outer - inner) / gap;
  const int n = static_cast<int>(1 / h) + 4;
  const Vec2 centre{(n / 2 - 0.137) * h, (n / 2 - 0.291) * h};
  Boundary b = test::makeBox(n, n, h, test::kSlipBox);
  const double middle = 0.5 * (inner + outer);
  test::addSolid(
      b,
      [&](Vec2 p) {
        const double r = length(p - centre);
        return std::min(r - inner, outer - r);
      },
      [&](Vec2 p) { return length(p - centre) < middle ? perpendicular(p - centre) : Vec2{}; }, 1);
  // Unknowns are the faces whose centre is in the fluid.
  for (int component = 0; component < 2; ++component) {
    Field& open = component ? b.openY : b.openX;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double r = length((component ? b.grid.yFaceCentre(i, j) : b.grid.xFaceCentre(i, j)) - centre);
        open(i, j) = r > inner && r < outer ? 1.0f : 0.0f;
      }
    std::erase_if(component ? b.linksV : b.linksU,
                  [&](const CutLink& link) { return open(link.i, link.j) == 0; });
  }
  // A face that was shut by its share but has its centre in the fluid misses its links: there are none here.
  ThreadPool pool(2);
  Viscosity viscosity(b, pool);
  Field u(n, n), v(n, n);
  Couette result;
  // A few huge steps are the steady state.
  for (int s = 0; s < 20; ++s) {
    viscosity.bendAtWalls(b, u, v);
    result.converged = viscosity.diffuse(b, u, v, 1, 1e3).converged;
  }
  SurfaceShear shear;
  findSurfaceShear(b, u, v, shear);

  const double ratio = inner * inner * outer * outer / (outer * outer - inner * inner);
  const double solidBody = -inner * inner / (outer * outer - inner * inner);
  double torque = -2 * kPi * inner * inner;  // the transposed part of the stress, exact for a rigid rotation
  for (int component = 0; component < 2; ++component) {
    const Field &open = component ? b.openY : b.openX, &f = component ? v : u;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        if (open(i, j) == 0) continue;
        const Vec2 p = (component ? b.grid.yFaceCentre(i, j) : b.grid.xFaceCentre(i, j)) - centre;
        const double r = length(p), swirl = solidBody * r + ratio / r;
        const double exact = component ? swirl * p.x / r : -swirl * p.y / r;
        result.velocity = std::max(result.velocity, std::fabs(f(i, j) - exact));
      }
    const auto& links = component ? b.linksV : b.linksU;
    for (std::size_t k = 0; k < links.size(); ++k) {
      const CutLink& link = links[k];
      const Vec2 p = (component ? b.grid.yFaceCentre(link.i, link.j) : b.grid.xFaceCentre(link.i, link.j)) +
                     link.theta * h * Vec2{double(link.di), double(link.dj)} - centre;
      if (length(p) > middle) continue;
      const double force = (component ? shear.v : shear.u)[k];
      torque += component ? p.x * force : -p.y * force;
    }
  }
  result.torque = torque / (-4 * kPi * ratio) - 1;
  std::printf("Couette, gap of %g cells: torque off by %.3f%%, velocity by %.2e\n", gap, 100 * result.torque,
              result.velocity);
  return result;
}

TEST(Viscosity, TurningCylindersFeelTheExactTorqueToSecondOrder) {
  // Torque 4 pi nu Omega / (1/R1^2 - 1/R2^2) per density: within 0.6% at a gap of 8 cells, 0.1% at 32.
  const Couette coarse = couette(8), middle = couette(16), fine = couette(32);
  EXPECT_TRUE(coarse.converged && middle.converged && fine.converged);
  EXPECT_LT(std::fabs(coarse.torque), 6e-3);
  EXPECT_LT(std::fabs(middle.torque), 2e-3);
  EXPECT_LT(std::fabs(fine.torque), 1e-3);
  EXPECT_GT(std::log2(coarse.velocity / fine.velocity) / 2, 1.7);
}

TEST(Viscosity, AForcedChannelReachesItsParabola) {
  // u = a y (H - y) / (2 nu) between walls at rest, exactly; carrying it does not disturb it.
  double errors[2];
  for (int k = 0; k < 2; ++k) {
    const int n = 8 << k;
    const double h = 1.0 / n, nu = 0.1, push = 0.8;
    Boundary b =
        test::makeBox(n, n, h, {WallKind::periodic, WallKind::periodic, WallKind::noSlip, WallKind::noSlip});
    for (int i = 0; i < n; ++i) {
      CutLink link;
      link.theta = 0.5f;
      link.i = i, link.j = 0, link.dj = -1;
      b.linksU.push_back(link);
    }
    for (int i = 0; i < n; ++i) {
      CutLink link;
      link.theta = 0.5f;
      link.i = i, link.j = n - 1, link.dj = 1;
      b.linksU.push_back(link);
    }
    test::VelocityRun run(b);
    Viscosity viscosity(b, run.pool);
    Field acceleration(n, n, static_cast<float>(push));
    for (int s = 0; s < 400; ++s) {
      run.carry(0.1, &acceleration);
      viscosity.bendAtWalls(b, run.u, run.v);
      viscosity.diffuse(b, run.u, run.v, nu, 0.1);
      run.project(0.1);
    }
    errors[k] = 0;
    for (int j = 0; j < n; ++j) {
      const double y = (j + 0.5) * h, exact = push * y * (1 - y) / (2 * nu);
      for (int i = 0; i < n; ++i) errors[k] = std::max(errors[k], std::fabs(run.u(i, j) - exact));
    }
  }
  std::printf("Channel: error %.2e at 8 cells, %.2e at 16\n", errors[0], errors[1]);
  EXPECT_LT(errors[0], 1e-4);
  EXPECT_LT(errors[1], 1e-4);
}

TEST(Viscosity, ALinkWithoutDragPullsNothing) {
  // drag scales the wall link's weight; at 0 a uniform flow along the wall stays as it is.
  const int n = 16;
  for (const float drag : {0.0f, 1.0f}) {
    Boundary b = test::makeBox(n, n, 1.0 / n,
                               {WallKind::periodic, WallKind::periodic, WallKind::slip, WallKind::slip});
    for (int i = 0; i < n; ++i) {
      CutLink link;
      link.i = i, link.dj = -1, link.theta = 0.5f, link.drag = drag;
      b.linksU.push_back(link);
    }
    ThreadPool pool(1);
    Viscosity viscosity(b, pool);
    Field u(n, n, 1), v(n, n);
    viscosity.diffuse(b, u, v, 0.01, 1);
    if (drag == 0)
      EXPECT_EQ(u(5, 0), 1);
    else
      EXPECT_LT(u(5, 0), 0.9f);
  }
}

TEST(Viscosity, SurfaceDragMovesAFaceTowardsTheSurface) {
  // Without viscosity a surface takes along the faces that it cuts, by drag and nearness; others keep their
  // velocity.
  Boundary b = test::makeBox(8, 8, 0.125, test::kSlipBox);
  CutLink link;
  link.i = 3, link.j = 4, link.dj = -1, link.theta = 0.25f, link.drag = 0.5f, link.velocity = 2;
  b.linksU.push_back(link);
  Field u(8, 8, 1), v(8, 8, 1);
  applySurfaceDrag(b, u, v);
  EXPECT_FLOAT_EQ(u(3, 4), 1 + 0.5f * 0.75f * (2 - 1));
  EXPECT_EQ(u(4, 4), 1);
  EXPECT_EQ(v(3, 4), 1);
}

}  // namespace
}  // namespace smokebox
