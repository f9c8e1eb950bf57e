// Solids and walls on the grid: shares at the sides, velocities of what closes a face, cut links, periodic
// images.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/maths.h"
#include "coupling/solids_on_grid.h"

namespace smokebox {
namespace {

Boundary boundaryWith(Grid grid, WallKind left, WallKind right, WallKind bottom, WallKind top) {
  Boundary boundary;
  boundary.grid = grid;
  boundary.sides[0].kind = left;
  boundary.sides[1].kind = right;
  boundary.sides[2].kind = bottom;
  boundary.sides[3].kind = top;
  return boundary;
}

Boundary closedBox(Grid grid) {
  return boundaryWith(grid, WallKind::slip, WallKind::slip, WallKind::slip, WallKind::slip);
}

MovingSolid solidOf(const Shape& shape, Pose pose, double tolerance = 1e-5) {
  MovingSolid solid;
  solid.outlines = outlinesOf({shape, pose}, tolerance);
  solid.origin = pose.position;
  return solid;
}

double fluxBalance(const Boundary& b, int i, int j) {  // of what the walls drive into a cell, m/s
  auto x = [&](int a) { return (1.0 - b.openX(a, j)) * b.wallU(a, j); };
  auto y = [&](int c) { return (1.0 - b.openY(i, c)) * b.wallV(i, c); };
  return x(i + 1) - x(i) + y(j + 1) - y(j);
}

const CutLink* find(const std::vector<CutLink>& links, int i, int j, int di, int dj) {
  const CutLink* found = nullptr;
  for (const CutLink& link : links)
    if (link.i == i && link.j == j && link.di == di && link.dj == dj) {
      EXPECT_EQ(found, nullptr) << "listed twice";
      found = &link;
    }
  return found;
}

TEST(SolidsOnGrid, ClosedSidesAreShutAndOpenOnesKeepTheirShare) {
  // Faces on closed sides have share 0, open sides what a solid on them leaves; the margins are 0.
  Boundary b = boundaryWith({16, 8, 0.125}, WallKind::noSlip, WallKind::open, WallKind::slip, WallKind::open);
  SolidsOnGrid grid;
  grid.cover({solidOf(BoxShape{{0.2, 0.3}}, {{2, 0.55}, 0})}, true, b);
  for (int j = 0; j < 8; ++j) EXPECT_EQ(b.openX(0, j), 0);
  for (int i = 0; i < 16; ++i) EXPECT_EQ(b.openY(i, 0), 0);
  for (int i = 0; i < 14; ++i) EXPECT_EQ(b.openY(i, 8), 1);
  EXPECT_EQ(b.openX(16, 0), 1);
  EXPECT_EQ(b.openX(16, 4), 0);
  EXPECT_NEAR(b.openX(16, 5), 1 - 0.6, 1e-5);  // covered from 5 * 0.125 to 0.7
  EXPECT_NEAR(b.openX(16, 3), 0.2, 1e-5);
  EXPECT_EQ(b.openX(17, 0), 0);
  EXPECT_EQ(b.openX(-1, 0), 0);
  EXPECT_EQ(b.volume(0, -1), 0);
  EXPECT_EQ(b.volume(0, 8), 0);
}

TEST(SolidsOnGrid, InflowIsAClosedFaceWhoseWallMoves) {
  // An inflow face is closed and moves at the inflow's speed, where no solid covers it.
  Boundary b = boundaryWith({8, 8, 1}, WallKind::inflow, WallKind::open, WallKind::slip, WallKind::slip);
  b.side(Side::left);
  b.sides[0].u.assign(8, 2.0f);
  SolidsOnGrid grid;
  MovingSolid block = solidOf(BoxShape{{2, 2.5}}, {{0, 1.25}, 0});
  block.velocity = {-1, 0};
  grid.cover({block}, true, b);
  EXPECT_EQ(b.openX(0, 5), 0);
  EXPECT_FLOAT_EQ(b.wallU(0, 5), 2);
  EXPECT_FLOAT_EQ(b.wallU(0, 1), -1);
  EXPECT_NEAR(b.wallU(0, 2), 0.5, 1e-4);
}

TEST(SolidsOnGrid, RigidMotionHasNoDivergenceInsideASolid) {
  // Inside a solid that moves and turns, what its faces carry into a cell adds up to 0; over the whole solid
  // too.
  Boundary b = closedBox({64, 64, 1.0 / 64});
  SolidsOnGrid grid;
  MovingSolid disk = solidOf(CircleShape{0.3}, {{0.51, 0.48}, 0});
  disk.velocity = {0.7, -0.4};
  disk.spin = 3;
  grid.cover({disk}, true, b);
  double total = 0;
  int inside = 0;
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 64; ++i) {
      const double flux = fluxBalance(b, i, j);
      total += flux;
      if (b.volume(i, j) > 0) continue;
      ++inside;
      ASSERT_NEAR(flux, 0, 1e-6) << i << ' ' << j;
      ASSERT_FLOAT_EQ(b.wallU(i, j), static_cast<float>(disk.velocityAt(b.grid.xFaceCentre(i, j)).x));
    }
  EXPECT_GT(inside, 1000);
  EXPECT_NEAR(total, 0, 1e-4);
  EXPECT_EQ(b.wallU(2, 2), 0);
  // Cut cells too: the wall's share of their boundary is what the solid sweeps out of them, zero only in sum
  // with the part of its surface inside the cell; over all cut cells of a translating disk nothing is left.
  disk.spin = 0;
  grid.cover({disk}, false, b);
  total = 0;
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 64; ++i) total += fluxBalance(b, i, j);
  EXPECT_NEAR(total, 0, 1e-4);
}

TEST(SolidsOnGrid, VersionFollowsTheFractions) {
  // Velocities may change without a new version; shapes may not.
  Boundary b = closedBox({16, 16, 1});
  SolidsOnGrid grid;
  MovingSolid block = solidOf(BoxShape{{4, 4}}, {{8, 8}, 0});
  grid.cover({block}, true, b);
  const auto version = b.version;
  block.velocity = {1, 2};
  block.drag = 0.5;
  grid.cover({block}, false, b);
  EXPECT_EQ(b.version, version);
  EXPECT_EQ(b.wallU(8, 8), 1);
  EXPECT_EQ(b.wallV(8, 8), 2);
  for (const CutLink& link : b.linksU) {
    if (link.solid == 0) {
      EXPECT_EQ(link.drag, 0.5f);
    }
  }
  grid.cover({}, true, b);
  EXPECT_GT(b.version, version);
  EXPECT_EQ(b.wallU(8, 8), 0);
}

TEST(SolidsOnGrid, SolidsComeInAgainOnPeriodicSides) {
  // A disk moved by any vector across periodic sides covers the same, moved along; margins repeat the other
  // side.
  const Grid g{32, 32, 1};
  Boundary a =
      boundaryWith(g, WallKind::periodic, WallKind::periodic, WallKind::periodic, WallKind::periodic);
  Boundary b = a;
  SolidsOnGrid one, two;
  MovingSolid disk = solidOf(CircleShape{5.3}, {{16.2, 15.7}, 0});
  disk.velocity = {1, 0.5};
  disk.spin = 0.25;
  one.cover({disk}, true, a);
  const int si = 14, sj = -17;
  MovingSolid moved = disk;
  for (Vec2& p : moved.outlines[0]) p = p + Vec2{1.0 * si, 1.0 * sj};
  moved.origin = moved.origin + Vec2{1.0 * si, 1.0 * sj};
  two.cover({moved}, true, b);
  auto wrap = [](int k) { return ((k % 32) + 32) % 32; };
  for (int j = 0; j < 32; ++j)
    for (int i = 0; i < 32; ++i) {
      const int m = wrap(i + si), n = wrap(j + sj);
      ASSERT_NEAR(a.volume(i, j), b.volume(m, n), 1e-6) << i << ' ' << j;
      ASSERT_NEAR(a.openX(i, j), b.openX(m, n), 1e-6);
      ASSERT_NEAR(a.openY(i, j), b.openY(m, n), 1e-6);
      ASSERT_NEAR(a.wallU(i, j), b.wallU(m, n), 1e-5);
      ASSERT_NEAR(a.wallV(i, j), b.wallV(m, n), 1e-5);
    }
  for (int j = 0; j < 32; ++j) {
    EXPECT_EQ(b.openX(32, j), b.openX(0, j));
    EXPECT_EQ(b.openX(-3, j), b.openX(29, j));
    EXPECT_EQ(b.volume(35, j), b.volume(3, j));
    EXPECT_EQ(b.wallU(-1, j), b.wallU(31, j));
    EXPECT_EQ(b.openY(j, -2), b.openY(j, 30));
    EXPECT_EQ(b.volume(-2, -2), b.volume(30, 30));
  }
  ASSERT_EQ(a.linksU.size(), b.linksU.size());
  for (const CutLink& link : a.linksU) {
    const CutLink* same = find(b.linksU, wrap(link.i + si), wrap(link.j + sj), link.di, link.dj);
    ASSERT_NE(same, nullptr);
    EXPECT_NEAR(same->theta, link.theta, 1e-5);
    EXPECT_NEAR(same->velocity, link.velocity, 1e-5);
    EXPECT_EQ(same->solid, 0);
  }
}

TEST(CutLinks, EndOnTheCircleWhereItIs) {
  // Every link that leaves the fluid ends at the analytic crossing with the circle, and moves with it.
  const Grid g{40, 40, 0.025};
  Boundary b = closedBox(g);
  SolidsOnGrid grid;
  MovingSolid disk = solidOf(CircleShape{0.3}, {{0.503, 0.489}, 0}, 1e-8);
  disk.velocity = {1, -2};
  disk.spin = 5;
  disk.drag = 0.7;
  grid.cover({disk}, true, b);
  auto inside = [&](Vec2 p) { return length(p - disk.origin) < 0.3; };
  for (bool ofU : {true, false}) {
    const std::vector<CutLink>& links = ofU ? b.linksU : b.linksV;
    auto place = [&](int i, int j) { return ofU ? g.xFaceCentre(i, j) : g.yFaceCentre(i, j); };
    std::size_t expected = 0;
    for (int j = 1; j < 39; ++j)
      for (int i = 1; i < 39; ++i) {
        const Vec2 from = place(i, j);
        if (inside(from)) continue;
        const int steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
        for (const auto& step : steps) {
          const Vec2 direction{1.0 * step[0], 1.0 * step[1]};
          if (!inside(from + g.h * direction)) continue;
          double lo = 0, hi = 1;
          for (int k = 0; k < 60; ++k)
            (inside(from + 0.5 * (lo + hi) * g.h * direction) ? hi : lo) = 0.5 * (lo + hi);
          const CutLink* link = find(links, i, j, step[0], step[1]);
          ASSERT_NE(link, nullptr) << i << ' ' << j;
          ++expected;
          EXPECT_NEAR(link->theta, std::max(lo, 1e-3), 3e-4);
          const Vec2 velocity = disk.velocityAt(from + lo * g.h * direction);
          EXPECT_NEAR(link->velocity, ofU ? velocity.x : velocity.y, 1e-4);
          EXPECT_EQ(link->drag, 0.7f);
          EXPECT_EQ(link->solid, 0);
        }
      }
    // A chord shorter than a cell may be met from both its ends as well.
    const auto ofDisk =
        std::count_if(links.begin(), links.end(), [](const CutLink& link) { return link.solid == 0; });
    EXPECT_GE(ofDisk, static_cast<long>(expected));
    EXPECT_LE(ofDisk, static_cast<long>(expected) + 8);
    EXPECT_TRUE(std::is_sorted(links.begin(), links.end(), [](const CutLink& x, const CutLink& y) {
      return x.j != y.j ? x.j < y.j : x.i < y.i;
    }));
  }
}

TEST(CutLinks, WallsOfTheDomainHoldTheFluidBesideThem) {
  // No-slip at half a cell along the surface, the wall's own face along the normal; nothing for slip and open
  // sides.
  Boundary b = boundaryWith({8, 6, 1}, WallKind::inflow, WallKind::open, WallKind::noSlip, WallKind::slip);
  b.sides[0].u.assign(6, 3.0f);
  b.sides[0].v.assign(6, 0.5f);
  b.sides[2].u = {0, 1, 2, 3, 4, 5, 6, 7};
  SolidsOnGrid grid;
  grid.cover({}, true, b);
  const CutLink* link = find(b.linksU, 3, 0, 0, -1);
  ASSERT_NE(link, nullptr);
  EXPECT_EQ(link->theta, 0.5f);
  EXPECT_EQ(link->drag, 1);
  EXPECT_EQ(link->velocity, 2.5f);  // between faces 2 and 3
  EXPECT_EQ(link->solid, -1);
  EXPECT_EQ(find(b.linksU, 3, 5, 0, 1), nullptr);   // slip
  EXPECT_EQ(find(b.linksU, 0, 2, -1, 0), nullptr);  // the inflow's own face is fixed
  EXPECT_EQ(find(b.linksU, 8, 2, 1, 0), nullptr);   // open
  ASSERT_NE(find(b.linksU, 8, 0, 0, -1), nullptr);  // but the wall goes on below the last face
  link = find(b.linksU, 1, 2, -1, 0);
  ASSERT_NE(link, nullptr);
  EXPECT_EQ(link->theta, 1);
  EXPECT_EQ(link->velocity, 3);
  link = find(b.linksV, 0, 3, -1, 0);
  ASSERT_NE(link, nullptr);
  EXPECT_EQ(link->theta, 0.5f);
  EXPECT_EQ(link->velocity, 0.5f);
  EXPECT_NE(find(b.linksV, 4, 1, 0, -1), nullptr);
  EXPECT_NE(find(b.linksV, 4, 5, 0, 1), nullptr);  // slip: closed along the normal
  EXPECT_EQ(find(b.linksV, 7, 3, 1, 0), nullptr);
  // 9 - 1 faces above the floor; one column beside the inflow.
  EXPECT_EQ(b.linksU.size(), 8u + 6u);
  EXPECT_EQ(b.linksV.size(), 8u + 8u + 5u);
}

TEST(CutLinks, ASolidBeforeAWallTakesItsPlace) {
  // Between a velocity and the floor lies a plate: the link ends on the plate, not on the floor.
  Boundary b =
      boundaryWith({8, 8, 1}, WallKind::noSlip, WallKind::noSlip, WallKind::noSlip, WallKind::noSlip);
  SolidsOnGrid grid;
  grid.cover({solidOf(BoxShape{{4, 0.25}}, {{4, 0.125}, 0})}, true, b);
  const CutLink* link = find(b.linksU, 4, 0, 0, -1);
  ASSERT_NE(link, nullptr);
  EXPECT_NEAR(link->theta, 0.25, 1e-5);
  EXPECT_EQ(link->solid, 0);
  link = find(b.linksU, 1, 0, 0, -1);
  ASSERT_NE(link, nullptr);
  EXPECT_EQ(link->theta, 0.5f);
}

TEST(CutLinks, ThinWallEndsThemOnBothSides) {
  // A plate between two rows of velocities cuts the links from both; what it shuts moves with it.
  Boundary b = closedBox({16, 16, 1});
  SolidsOnGrid grid;
  MovingSolid plate = solidOf(BoxShape{{20, 0.2}}, {{8, 8.0}, 0});
  plate.velocity = {0.25, -0.5};
  plate.drag = 1;
  grid.cover({plate}, true, b);
  const CutLink* below = find(b.linksU, 8, 7, 0, 1);
  const CutLink* above = find(b.linksU, 8, 8, 0, -1);
  ASSERT_NE(below, nullptr);
  ASSERT_NE(above, nullptr);
  EXPECT_NEAR(below->theta, 0.4, 1e-5);
  EXPECT_NEAR(above->theta, 0.4, 1e-5);
  EXPECT_EQ(below->velocity, 0.25f);
  EXPECT_EQ(b.openY(8, 8), 0);
  EXPECT_EQ(b.wallV(8, 8), -0.5f);
  // Off the grid lines: the cells it cuts keep their larger part, above it; the faces below are shut by it.
  for (Vec2& p : plate.outlines[0]) p = p + Vec2{0, 0.25};
  plate.origin.y += 0.25;
  grid.cover({plate}, true, b);
  EXPECT_EQ(b.openY(8, 8), 0);
  EXPECT_EQ(b.wallV(8, 8), -0.5f);
  EXPECT_NEAR(b.volume(8, 8), 0.65, 1e-5);
  EXPECT_EQ(b.openY(8, 9), 1);
  EXPECT_EQ(b.wallV(8, 9), 0);
  EXPECT_NEAR(b.openX(8, 8), 0.65, 1e-5);
  const CutLink* toShut = find(b.linksV, 8, 7, 0, 1);
  ASSERT_NE(toShut, nullptr);
  EXPECT_EQ(toShut->theta, 1);
  EXPECT_EQ(toShut->velocity, -0.5f);
}

}  // namespace
}  // namespace smokebox
