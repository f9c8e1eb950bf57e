// Shares of faces and cells: against areas and crossings worked out by hand or from the polygons alone.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/maths.h"
#include "geometry/coverage.h"

namespace smokebox {
namespace {

Outline box(Vec2 centre, Vec2 size, double angleRad = 0) {
  return outlinesOf({BoxShape{size}, {centre, angleRad}}, 0)[0];
}

double openArea(const Grid& grid, const GridCover& cover) {
  double sum = 0;
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) sum += cover.volume(i, j);
  return sum * grid.h * grid.h;
}

/// A polygon around a centre that is concave here and there, never self-crossing.
Outline randomStar(std::mt19937& random, Vec2 centre, double radius, int corners) {
  std::uniform_real_distribution<double> stretch(0.4, 1);
  Outline star;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * kPi * k / corners, r = radius * stretch(random);
    star.push_back(centre + Vec2{r * std::cos(angle), r * std::sin(angle)});
  }
  return star;
}

TEST(CoverageCells, NothingIsCoveredWithoutSolids) {
  // An empty grid is open everywhere, and its margin is not.
  const Grid grid{20, 10, 0.1};
  GridCover cover;
  coverGrid(grid, {}, cover);
  EXPECT_DOUBLE_EQ(openArea(grid, cover), 200 * 0.1 * 0.1);
  EXPECT_EQ(cover.openX(20, 9), 1);
  EXPECT_EQ(cover.openY(19, 10), 1);
  EXPECT_EQ(cover.openX(-1, 0), 0);
  EXPECT_EQ(cover.openX(21, 0), 0);
}

TEST(CoverageCells, BoxAlongGridLinesShutsItsOwnFacesOnAllSides) {
  // A box whose sides are grid lines covers whole cells; its four sides are alike.
  const Grid grid{10, 10, 0.1};
  GridCover cover;
  coverGrid(grid, {{{{{0.2, 0.3}, {0.5, 0.3}, {0.5, 0.6}, {0.2, 0.6}}}}}, cover);
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 10; ++i) {
      const bool inside = i >= 2 && i < 5 && j >= 3 && j < 6;
      EXPECT_EQ(cover.volume(i, j), inside ? 0 : 1) << i << ' ' << j;
      EXPECT_EQ(cover.openX(i, j), i >= 2 && i <= 5 && j >= 3 && j < 6 ? 0 : 1) << i << ' ' << j;
      EXPECT_EQ(cover.openY(i, j), i >= 2 && i < 5 && j >= 3 && j <= 6 ? 0 : 1) << i << ' ' << j;
    }
}

TEST(CoverageCells, SharesOfATurnedSquareAreTheAnalyticOnes) {
  // A square on its corner at the middle of the grid: |x| + |y| < r.
  const Grid grid{8, 8, 1};
  GridCover cover;
  const double r = 2.7;
  coverGrid(grid, {{{{{4 + r, 4}, {4, 4 + r}, {4 - r, 4}, {4, 4 - r}}}}}, cover);
  auto covered = [r](double x, double lo, double hi) {  // length of [lo, hi] on the line at x from the centre
    const double half = r - std::fabs(x);
    return half <= 0 ? 0.0 : std::max(0.0, std::min(hi, half) - std::max(lo, -half));
  };
  for (int k = 0; k <= 8; ++k)
    for (int m = 0; m < 8; ++m) {
      EXPECT_NEAR(cover.openX(k, m), 1 - covered(k - 4, m - 4, m - 3), 3e-6) << k << ' ' << m;
      EXPECT_NEAR(cover.openY(m, k), 1 - covered(k - 4, m - 4, m - 3), 3e-6) << k << ' ' << m;
    }
  EXPECT_NEAR(cover.volume(5, 5), 1 - 0.7 * 0.7 / 2, 3e-6);
  EXPECT_NEAR(cover.volume(4, 6), 1 - 0.7 * 0.7 / 2, 3e-6);
  EXPECT_EQ(cover.volume(4, 4), 0);
}

TEST(CoverageCells, OpenAreaIsTheDomainsLessThePolygons) {
  // What random polygons leave of the domain is exact to single precision, as long as they cut no cell in
  // two; what a cut cell gives up is less than half of it.
  const Grid grid{64, 48, 1.0 / 64};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x(0.35, 0.65), y(0.3, 0.45);
  GridCover cover;
  int uncut = 0;
  for (int round = 0; round < 60; ++round) {
    const Outline star = randomStar(random, {x(random), y(random)}, 0.28, 5 + round / 6);
    coverGrid(grid, {{{star}}}, cover);
    const double missing = grid.width() * grid.height() - signedArea(star) - openArea(grid, cover);
    if (cover.shut.empty()) {
      ++uncut;
      ASSERT_NEAR(missing, 0, 1e-6) << round;
    } else {
      ASSERT_GT(missing, -1e-6) << round;
      ASSERT_LT(missing, 0.5 * static_cast<double>(cover.shut.size()) * grid.h * grid.h) << round;
    }
  }
  EXPECT_GT(uncut, 20);
}

TEST(CoverageCells, CircleHasItsArea) {
  // The polygon that stands for a circle has the circle's area, and so has what it covers.
  const Grid grid{128, 128, 1.0 / 128};
  GridCover cover;
  for (double tolerance : {1e-2, 1e-3, 1e-5}) {
    coverGrid(grid, {{outlinesOf({CircleShape{0.3}, {{0.5, 0.5}, 0}}, tolerance)}}, cover);
    EXPECT_NEAR(openArea(grid, cover), 1 - kPi * 0.09, 1e-6) << tolerance;
  }
}

TEST(CoverageCells, OverlapIsCountedOnce) {
  // Two boxes that overlap cover the area of their union; two that only touch, the sum.
  const Grid grid{50, 50, 0.02};
  GridCover cover;
  coverGrid(grid, {{{box({0.4, 0.5}, {0.3, 0.3})}}, {{box({0.5, 0.55}, {0.2, 0.4}, 0)}}}, cover);
  EXPECT_NEAR(openArea(grid, cover), 1 - (0.09 + 0.08 - 0.15 * 0.3), 1e-6);
  coverGrid(grid, {{{box({0.3, 0.5}, {0.2, 0.313})}}, {{box({0.5, 0.5}, {0.2, 0.313})}}}, cover);
  EXPECT_NEAR(openArea(grid, cover), 1 - 2 * 0.2 * 0.313, 1e-6);
}

TEST(CoverageCells, HolesStayOpen) {
  // A ring covers its area only; the hole is fluid.
  const Grid grid{40, 40, 0.025};
  Outline hole = box({0.5, 0.5}, {0.4, 0.4}, 0.3);
  std::reverse(hole.begin(), hole.end());
  GridCover cover;
  coverGrid(grid, {{{box({0.5, 0.5}, {0.7, 0.7}, 0.3), hole}}}, cover);
  EXPECT_NEAR(openArea(grid, cover), 1 - 0.49 + 0.16, 1e-6);
  EXPECT_EQ(cover.volume(20, 20), 1);
}

TEST(CoverageCells, SolidsSmallerThanACellCount) {
  // Islands inside one cell take away their area and shut nothing.
  const Grid grid{4, 4, 1};
  GridCover cover;
  coverGrid(grid,
            {{{box({1.5, 1.5}, {0.5, 0.2}, 0.4)}},
             {{box({2.3, 2.3}, {0.1, 0.1})}},
             {{box({2.7, 2.7}, {0.2, 0.2})}}},
            cover);
  EXPECT_NEAR(cover.volume(1, 1), 0.9, 3e-6);
  EXPECT_NEAR(cover.volume(2, 2), 0.95, 3e-6);
  EXPECT_EQ(cover.openX(1, 1), 1);
  EXPECT_EQ(cover.openY(1, 2), 1);
}

TEST(CoverageCells, MirroredSolidsGiveMirroredShares) {
  // Symmetric outlines on a symmetric grid give the same shares on both sides, on grid lines too.
  const Grid grid{32, 32, 1.0 / 32};
  const std::vector<std::vector<Outline>> cases = {
      outlinesOf({CircleShape{0.3}, {{0.5, 0.5}, 0}}, 1e-3),
      {box({0.5, 0.5}, {0.5, 0.25})},
      {box({0.5, 0.5}, {0.01, 0.4})},
      outlinesOf({CapsuleShape{0.3, 0.1}, {{0.5, 0.5}, 0}}, 1e-3),
      outlinesOf({RegularShape{6, 0.3}, {{0.5, 0.5}, 0}}, 1e-3)};
  GridCover cover;
  for (std::size_t c = 0; c < cases.size(); ++c) {
    coverGrid(grid, {{cases[c]}}, cover);
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i < 32; ++i) {
        if (c != 2) {  // that wall cuts cells in two halves alike, of which one has to stay
          ASSERT_NEAR(cover.volume(i, j), cover.volume(31 - i, j), 1e-6) << c << ' ' << i << ' ' << j;
          ASSERT_NEAR(cover.openX(i, j), cover.openX(32 - i, j), 1e-6) << c << ' ' << i << ' ' << j;
          ASSERT_NEAR(cover.openY(i, j), cover.openY(31 - i, j), 1e-6) << c << ' ' << i << ' ' << j;
        }
        ASSERT_NEAR(cover.volume(i, j), cover.volume(i, 31 - j), 1e-6) << c << ' ' << i << ' ' << j;
        ASSERT_NEAR(cover.openX(i, j), cover.openX(i, 31 - j), 1e-6) << c << ' ' << i << ' ' << j;
        ASSERT_NEAR(cover.openY(i, j), cover.openY(i, 32 - j), 1e-6) << c << ' ' << i << ' ' << j;
      }
  }
}

TEST(CoverageCells, IntervalsOfHalfLinesAreTheChords) {
  // A circle covers its chord on every line, named after the solid.
  const Grid grid{40, 40, 0.025};
  GridCover cover;
  const double r = 0.3;
  coverGrid(grid, {{{}}, {outlinesOf({CircleShape{r}, {{0.5, 0.5}, 0}}, 1e-7)}}, cover);
  for (int k = 0; k <= 80; ++k) {
    const double d = k * 0.0125 - 0.5;
    for (const LineCover& line : {cover.alongX[k], cover.alongY[k]}) {
      if (std::fabs(d) > r + 1e-4) {
        EXPECT_TRUE(line.empty());
      }
      if (std::fabs(d) > r - 1e-4) continue;
      const double half = std::sqrt(r * r - d * d);
      ASSERT_EQ(line.size(), 1u);
      EXPECT_NEAR(line[0].lo, 0.5 - half, 2e-5);
      EXPECT_NEAR(line[0].hi, 0.5 + half, 2e-5);
      EXPECT_EQ(line[0].solidLo, 1);
      EXPECT_EQ(line[0].solidHi, 1);
    }
  }
}

TEST(CoverageShare, SumsToTheAreaInsideTheGrid) {
  // The shares of random polygons add up to their area; what lies outside the grid is left out.
  const Grid grid{32, 32, 1.0 / 32};
  std::mt19937 random(11);
  Field share;
  for (int round = 0; round < 20; ++round) {
    const Outline star = randomStar(random, {0.5, 0.5}, 0.45, 7 + round);
    coverShare(grid, {star}, share);
    double sum = 0;
    for (int j = 0; j < 32; ++j)
      for (int i = 0; i < 32; ++i) sum += share(i, j);
    ASSERT_NEAR(sum * grid.h * grid.h, signedArea(star), 1e-6);
  }
  coverShare(grid, {box({0, 0.5}, {0.5, 0.5})}, share);
  double sum = 0;
  for (int j = 0; j < 32; ++j)
    for (int i = 0; i < 32; ++i) sum += share(i, j);
  EXPECT_NEAR(sum * grid.h * grid.h, 0.125, 1e-6);
  EXPECT_EQ(share(0, 16), 1);
  EXPECT_EQ(share(8, 16), 0);
}

}  // namespace
}  // namespace smokebox
