#include "fluid/extend.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/velocity_helpers.h"

namespace smokebox {
namespace {

float numbered(int i, int j) { return static_cast<float>(i + 100 * j); }

TEST(Extend, APeriodicDomainIsWrappedOnAllSides) {
  // Beyond a periodic side stands what is one period away, corners too.
  const int n = 16;
  ThreadPool pool(1);
  const Boundary b = test::makeBox(n, n, 1.0 / n, test::kPeriodic);
  Field u(n, n), v(n, n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) u(i, j) = v(i, j) = numbered(i, j);
  VelocityExtension(b, pool).apply(b, u, v);
  for (int j = -4; j < n + 4; ++j)
    for (int i = -6; i <= n + 6; ++i) {
      EXPECT_EQ(u(i, j), numbered((i + n) % n, (j + n) % n)) << i << ' ' << j;
      EXPECT_EQ(v(i, j), numbered((i + n) % n, (j + n) % n)) << i << ' ' << j;
    }
}

TEST(Extend, ASlipWallIsAMirror) {
  // Tangential velocity is even about the wall, normal velocity odd.
  const int n = 16;
  const Boundary b = test::makeBox(n, n, 1.0 / n, test::kSlipBox);
  ThreadPool pool(1);
  Field u(n, n), v(n, n);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      if (j < n) u(i, j) = numbered(i, j);
      if (i < n) v(i, j) = numbered(i, j);
    }
  VelocityExtension(b, pool).apply(b, u, v);
  for (int k = 1; k <= 3; ++k)
    for (int m = 1; m < n; ++m) {
      EXPECT_EQ(u(-k, m), -u(k, m));
      EXPECT_EQ(u(n + k, m), -u(n - k, m));
      EXPECT_EQ(v(-k, m), v(k - 1, m));
      EXPECT_EQ(v(n - 1 + k, m), v(n - k, m));
      EXPECT_EQ(v(m, -k), -v(m, k));
      EXPECT_EQ(u(m, n - 1 + k), u(m, n - k));
    }
  EXPECT_EQ(u(0, 3), 0);
  EXPECT_EQ(v(3, n), 0);
}

TEST(Extend, ANoSlipWallContinuesAParabolaExactly) {
  // A parabolic profile that has the wall's velocity at the wall goes on unchanged for two faces beyond it.
  const int n = 16;
  const double h = 1.0 / n;
  Boundary b =
      test::makeBox(n, n, h, {WallKind::periodic, WallKind::periodic, WallKind::noSlip, WallKind::noSlip});
  b.sides[static_cast<int>(Side::top)].u.assign(n, 1.5f);
  auto profile = [](double y) { return 2 * y - 0.5 * y * y; };  // 0 at the bottom, 1.5 at the top
  ThreadPool pool(1);
  Field u(n, n), v(n, n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i <= n; ++i) u(i, j) = static_cast<float>(profile((j + 0.5) * h));
  VelocityExtension(b, pool).apply(b, u, v);
  for (const int j : {-2, -1, n, n + 1})
    for (int i = 0; i <= n; ++i) EXPECT_NEAR(u(i, j), profile((j + 0.5) * h), 2e-5) << i << ' ' << j;
}

TEST(Extend, ASurfaceContinuesALinearFlowExactly) {
  // Behind a flat floor without slip, wherever it cuts the cells, a velocity that is linear in space goes on
  // through the floor's velocity; with less drag it stays between that and the fluid's. Deep inside stands
  // the floor's.
  const int n = 32;
  const double h = 1.0 / n;
  for (const double floor : {0.5001, 0.509, 0.52, 0.53})
    for (const double drag : {0.0, 0.25, 1.0}) {
      Boundary b = test::makeBox(n, n, h, test::kPeriodic);
      test::addSolid(
          b, [&](Vec2 p) { return std::fabs(p.y - 0.25) - (floor - 0.25); },
          [](Vec2) {
            return Vec2{3, 0.5};
          },
          drag);
      // Faces whose centre is covered have no links of their own.
      for (auto* links : {&b.linksU, &b.linksV})
        std::erase_if(*links, [&](const CutLink& link) {
          const double y = (link.j + (links == &b.linksU ? 0.5 : 0.0)) * h;
          return y < floor;
        });
      auto flow = [&](double y) { return 3 + 2 * (y - floor); };  // has the floor's velocity at the floor
      ThreadPool pool(1);
      Field u(n, n), v(n, n, 0.5f);
      for (int j = 0; j < n; ++j)
        for (int i = 0; i <= n; ++i) u(i, j) = static_cast<float>(flow((j + 0.5) * h));
      const Field before = u;
      VelocityExtension extension(b, pool);
      extension.hideCovered(b, u, v);
      extension.apply(b, u, v);
      const int first = static_cast<int>(std::floor(floor / h - 0.5));  // the first covered centre
      for (int i = 0; i < n; ++i)
        for (int depth = 0; depth < 2; ++depth) {
          const double straight = flow((first - depth + 0.5) * h);
          if (drag == 1) {
            EXPECT_NEAR(u(i, first - depth), straight, 1e-5) << floor << ' ' << depth;
          } else {
            EXPECT_GE(u(i, first - depth), straight - 1e-5) << floor << ' ' << drag << ' ' << depth;
            EXPECT_LE(u(i, first - depth), flow((first + 1.5) * h) + 1e-5) << floor << ' ' << drag;
          }
        }
      EXPECT_EQ(u(5, n / 4), 3);
      EXPECT_NEAR(v(5, first - 1), 0.5f, 1e-6);
    }
}

TEST(Extend, WhatIsHiddenIsGivenBack) {
  // Faces with covered centres show stencils another value than the one that the projection needs; revealed,
  // they have it again, and what a stage has added.
  const int n = 32;
  Boundary b = test::makeBox(n, n, 1.0 / n, test::kPeriodic);
  test::addSolid(
      b,
      [](Vec2 p) {
        return length(p - Vec2{0.5, 0.5}) - 0.2;
      },
      [](Vec2) { return Vec2{}; }, 1);
  for (auto* links : {&b.linksU, &b.linksV})
    std::erase_if(*links, [&](const CutLink& link) {
      const Vec2 at =
          links == &b.linksU ? b.grid.xFaceCentre(link.i, link.j) : b.grid.yFaceCentre(link.i, link.j);
      return length(at - Vec2{0.5, 0.5}) < 0.2;
    });
  ThreadPool pool(1);
  Field u(n, n, 1), v(n, n, 1);
  VelocityExtension extension(b, pool);
  VelocityExtension::Hidden hidden;
  extension.hideCovered(b, u, v, &hidden);
  ASSERT_GT(hidden.u.size(), 4u);
  float least = 1;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) least = std::min(least, u(i, j));
  EXPECT_LT(least, 0);  // behind a surface at rest a flow at 1 goes on below 0
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) u(i, j) += 0.5f;
  extension.reveal(hidden, u, v);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) EXPECT_NEAR(u(i, j), 1.5f, 1e-6);
}

}  // namespace
}  // namespace smokebox
