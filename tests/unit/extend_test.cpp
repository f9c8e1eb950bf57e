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

TEST(Extend, ASurfaceSharesItsVelocityByItsDrag) {
  // Below a floor at y = 1/2 the tangential velocity goes on by 1 - drag and has the floor's by drag; normal
  // to it, and deep inside, stands the floor's velocity.
  const int n = 32;
  for (const double drag : {0.0, 0.25, 1.0}) {
    Boundary b = test::makeBox(n, n, 1.0 / n, test::kPeriodic);
    test::addSolid(
        b, [](Vec2 p) { return std::fabs(p.y - 0.25) - 0.2501; },
        [](Vec2) {
          return Vec2{3, 0.5};
        },
        drag);
    ThreadPool pool(1);
    Field u(n, n, 1), v(n, n, 0.5f);
    VelocityExtension(b, pool).apply(b, u, v);
    for (int i = 0; i < n; ++i) {
      EXPECT_EQ(u(i, n / 2), 1);
      for (int depth = 1; depth <= VelocityExtension::kLayers; ++depth)
        EXPECT_NEAR(u(i, n / 2 - depth), (1 - drag) * 1 + drag * 3, 1e-6) << drag << ' ' << depth;
      EXPECT_EQ(u(i, n / 4), 3);
      EXPECT_EQ(v(i, n / 2 - 1), 0.5f);
    }
  }
}

}  // namespace
}  // namespace smokebox
