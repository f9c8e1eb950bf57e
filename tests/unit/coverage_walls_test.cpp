// Thin walls never leak: floods of the open faces from one side of walls thinner than a cell never reach the
// other.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "base/maths.h"
#include "geometry/coverage.h"

namespace smokebox {
namespace {

Outline box(Vec2 centre, Vec2 size, double angleRad = 0) {
  return outlinesOf({BoxShape{size}, {centre, angleRad}}, 0)[0];
}

/// Cells that open faces join to the cell (i, j).
std::vector<char> flood(const Grid& grid, const GridCover& cover, int i, int j) {
  std::vector<char> reached(grid.cells(), 0);
  std::vector<std::pair<int, int>> stack{{i, j}};
  reached[j * grid.nx + i] = 1;
  auto go = [&](int a, int b, float open) {
    if (open <= 0 || a < 0 || b < 0 || a >= grid.nx || b >= grid.ny || reached[b * grid.nx + a]) return;
    reached[b * grid.nx + a] = 1;
    stack.push_back({a, b});
  };
  while (!stack.empty()) {
    const auto [a, b] = stack.back();
    stack.pop_back();
    go(a - 1, b, cover.openX(a, b));
    go(a + 1, b, cover.openX(a + 1, b));
    go(a, b - 1, cover.openY(a, b));
    go(a, b + 1, cover.openY(a, b + 1));
  }
  return reached;
}

int reachedCount(const std::vector<char>& reached) {
  int count = 0;
  for (char r : reached) count += r;
  return count;
}

TEST(CoverageWalls, WallAcrossTheDomainPartsIt) {
  // A wall of 0.2 h from side to side leaves no way across, at any offset and angle.
  const Grid grid{40, 40, 1};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> offset(-6, 6), angle(0, 2 * kPi);
  GridCover cover;
  for (int round = 0; round < 400; ++round) {
    const double turn = round % 8 == 0 ? round / 8 * kPi / 4 : angle(random);
    double shift = offset(random);
    if (round % 4 == 0) shift = std::round(2 * shift) / 2;
    const Vec2 normal{-exact::sin(turn), exact::cos(turn)}, centre = Vec2{20, 20} + shift * normal;
    coverGrid(grid, {{{box(centre, {200, 0.2}, turn)}}}, cover);
    const Vec2 from = centre + 3.3 * normal, to = centre - 3.3 * normal;
    const auto reached = flood(grid, cover, static_cast<int>(from.x), static_cast<int>(from.y));
    ASSERT_FALSE(reached[static_cast<int>(to.y) * 40 + static_cast<int>(to.x)]) << round;
    for (int j = 0; j < 40; ++j)  // nor is any cell well off the wall on the wrong side of it
      for (int i = 0; i < 40; ++i) {
        const double d = dot(grid.cellCentre(i, j) - centre, normal);
        if (std::fabs(d) > 1.5) {
          ASSERT_EQ(reached[j * 40 + i] != 0, d > 0) << round << ' ' << i << ' ' << j;
        }
      }
  }
}

TEST(CoverageWalls, WallsOnGridLinesAndThroughCentresPartTheDomain) {
  // The degenerate places: centred on a grid line, ending on one, through nodes, through the middles of
  // cells.
  const Grid grid{16, 16, 0.1};
  GridCover cover;
  for (double thickness : {0.02, 0.1, 0.2, 1e-4})
    for (int k = 4; k <= 24; ++k)
      for (double nudge : {0.0, 0.5 * thickness, -0.5 * thickness, 1e-17, -1e-9}) {
        const double y = 0.05 * k + nudge;
        coverGrid(grid, {{{box({0.8, y}, {1.6, thickness})}}}, cover);  // ends on the domain's sides exactly
        ASSERT_FALSE(flood(grid, cover, 8, 0)[15 * 16 + 8]) << thickness << ' ' << k << ' ' << nudge;
        coverGrid(grid, {{{box({y, 0.8}, {thickness, 1.6})}}}, cover);
        ASSERT_FALSE(flood(grid, cover, 0, 8)[8 * 16 + 15]) << thickness << ' ' << k << ' ' << nudge;
      }
  for (int k = -6; k <= 6; ++k) {  // diagonals through nodes
    coverGrid(grid, {{{box({0.8 + 0.1 * k, 0.8}, {4, 0.02}, kPi / 4)}}}, cover);
    ASSERT_FALSE(flood(grid, cover, 0, 15)[0 * 16 + 15]) << k;
  }
}

TEST(CoverageWalls, ClosedTurningBoxKeepsItsInside) {
  // Four thin walls that meet at the corners enclose the same region at every angle.
  const Grid grid{48, 48, 1};
  GridCover cover;
  const double half = 9, t = 0.2;
  for (int round = 0; round < 200; ++round) {
    const double turn = round * 0.05;
    const Pose pose{{24 + 0.013 * round, 24 - 0.007 * round}, turn};
    std::vector<SolidOutline> walls;
    for (int k = 0; k < 4; ++k) {
      const double side = k < 2 ? half : -half;
      const Vec2 centre = k % 2 == 0 ? Vec2{side, 0} : Vec2{0, side};
      const Vec2 size =
          k % 2 == 0 ? Vec2{t, 2 * half - t} : Vec2{2 * half + t, t};  // they touch, without overlap
      walls.push_back({outlinesOf({BoxShape{size}, combined(pose, {centre, 0})}, 0)});
    }
    coverGrid(grid, walls, cover);
    const auto reached = flood(grid, cover, 24, 24);
    ASSERT_FALSE(reached[0]) << round;
    ASSERT_NEAR(reachedCount(reached), 4 * half * half, 4 * 2 * half) << round;
    ASSERT_TRUE(flood(grid, cover, 0, 0)[47 * 48 + 47]) << round;
  }
}

TEST(CoverageWalls, CupWithAThinSlotOpensOnlyAtItsMouth) {
  // One concave polygon: a cup of thin walls. With a lid nothing gets in; without, everything does.
  const Grid grid{40, 40, 1};
  GridCover cover;
  for (int round = 0; round < 100; ++round) {
    const Pose pose{{20, 20}, 0.0631 * round};
    const double w = 7, t = 0.15;
    const Outline cup = {{-w, -w},       {w, -w},        {w, w},     {w - t, w},
                         {w - t, t - w}, {t - w, t - w}, {t - w, w}, {-w, w}};
    const Outline lid = {{-w, w}, {w, w}, {w, w + t}, {-w, w + t}};
    coverGrid(grid, {{{transformed(cup, pose)}}}, cover);
    ASSERT_TRUE(flood(grid, cover, 20, 20)[0]) << round;
    coverGrid(grid, {{{transformed(cup, pose)}}, {{transformed(lid, pose)}}}, cover);
    ASSERT_FALSE(flood(grid, cover, 20, 20)[0]) << round;
  }
}

TEST(CoverageWalls, WallShutsOnlyTheFacesBesideIt) {
  // Faces that no cell with a piece of the wall has are fully open; a wall's free end lets fluid pass.
  const Grid grid{32, 32, 1};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(0, 2 * kPi), place(14, 18);
  GridCover cover;
  for (int round = 0; round < 100; ++round) {
    const Vec2 centre{place(random), place(random)};
    const double turn = angle(random);
    const Vec2 along{exact::cos(turn), exact::sin(turn)};
    coverGrid(grid, {{{box(centre, {12, 0.2}, turn)}}}, cover);
    EXPECT_TRUE(flood(grid, cover, 0, 0)[31 * 32 + 31]);
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i <= 32; ++i) {
        const Vec2 away = grid.xFaceCentre(i, j) - centre;
        const double off = std::fabs(cross(along, away)), on = std::fabs(dot(along, away));
        if (off > 1.7 || on > 7.7) {
          ASSERT_EQ(cover.openX(i, j), 1) << round << ' ' << i << ' ' << j;
        }
      }
  }
}

TEST(CoverageWalls, JoinedSidesAreOneFace) {
  // A thin wall beside a periodic side shuts the faces of that side for both columns alike, and does not
  // leak.
  const Grid grid{16, 16, 1};
  GridCover cover;
  for (double x : {0.1, 0.3, 0.45, 0.55, 0.9, 0.0, -0.1, -0.45}) {
    std::vector<SolidOutline> copies;
    for (double shift : {0.0, 16.0}) copies.push_back({{box({x + shift, 8}, {0.2, 20}, 0.02)}});
    coverGrid(grid, copies, cover, {true, false});
    for (int j = 0; j < 16; ++j) {
      ASSERT_EQ(cover.openX(0, j), cover.openX(16, j)) << x << ' ' << j;
    }
    // Unrolled, the way from the middle leftwards through column 0 and on to the right end must be shut.
    const auto reached = flood(grid, cover, 8, 8);
    for (int j = 0; j < 16; ++j)
      if (cover.openX(0, j) > 0) {
        ASSERT_FALSE(reached[j * 16] && reached[j * 16 + 15]) << x << ' ' << j;
      }
  }
}

}  // namespace
}  // namespace smokebox
