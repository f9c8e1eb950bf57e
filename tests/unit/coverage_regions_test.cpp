// The regions that solids part from each other, in the true geometry.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/maths.h"
#include "geometry/coverage.h"

namespace smokebox {
namespace {

constexpr Grid kGrid{24, 20, 0.5};

Outline rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

// A ring of eight corners around the middle, with or without a gap.
std::vector<SolidOutline> ring(double angle, double radius, double wall, bool gap) {
  auto at = [&](double r, double k) {
    const double a = angle + 2 * kPi * k / 8;
    return Vec2{6.1 + r * std::cos(a), 5.2 + r * std::sin(a)};
  };
  Outline outer, inner;
  for (int k = 0; k < 8; ++k) {
    outer.push_back(at(radius, k));
    inner.push_back(at(radius - wall, -k));
  }
  if (!gap) return {{{outer, inner}}};
  // One outline around both: out along the outer corners, back along the inner ones.
  Outline open{at(radius, 0.1)};
  open.insert(open.end(), outer.begin() + 1, outer.end());
  open.push_back(at(radius - wall, 7));
  for (int k = 6; k > 0; --k) open.push_back(at(radius - wall, k));
  open.push_back(at(radius - wall, 0.1));
  return {{{open}}};
}

GridCover coverOf(const std::vector<SolidOutline>& solids, JoinedSides joined = {}) {
  GridCover cover;
  coverGrid(kGrid, solids, cover, joined);
  return cover;
}

TEST(CoverageRegions, ThinRingPartsInsideFromOutside) {
  // Truth: a closed ring makes two regions however it lies and however thin it is; every open cell is in the
  // one on whose side its centre lies, unless the wall is in the cell.
  for (double wall : {0.02, 0.2, 0.45})
    for (int turn = 0; turn < 40; ++turn) {
      const GridCover cover = coverOf(ring(0.037 * turn, 3.3, wall, false));
      ASSERT_EQ(cover.regions.count, 2) << wall << " " << turn;
      const int outside = cover.regions.at(0, 0), inside = cover.regions.at(12, 10);
      ASSERT_NE(outside, inside);
      for (int j = 0; j < kGrid.ny; ++j)
        for (int i = 0; i < kGrid.nx; ++i) {
          const Vec2 p = kGrid.cellCentre(i, j) - Vec2{6.1, 5.2};
          const double r = std::hypot(p.x, p.y);
          const int region = cover.regions.at(i, j);
          ASSERT_EQ(region >= 0, cover.volume(i, j) > 0);
          if (r > 3.3 + 0.36) {
            EXPECT_EQ(region, outside);
          }
          if (r < (3.3 - wall) * std::cos(kPi / 8) - 0.36) {
            EXPECT_EQ(region, inside);
          }
        }
    }
}

TEST(CoverageRegions, RingWithAGapIsOneRegion) {
  // Truth: what an opening joins is one region, however narrow the cells' faces make it.
  for (int turn = 0; turn < 40; ++turn) {
    const GridCover cover = coverOf(ring(0.037 * turn, 3.3, 0.1, true));
    EXPECT_EQ(cover.regions.at(0, 0), cover.regions.at(12, 10)) << turn;
  }
}

TEST(CoverageRegions, WallAcrossTheGridPartsItUnlessSidesAreJoined) {
  // Truth: a wall from bottom to top parts left from right; joined sides join them again, behind the wall.
  const std::vector<SolidOutline> wall = {{{rectangle(5.1, -1, 5.3, 11)}}};
  EXPECT_EQ(coverOf(wall).regions.count, 2);
  EXPECT_EQ(coverOf(wall, {true, false}).regions.count, 1);
  const std::vector<SolidOutline> shorter = {{{rectangle(5.1, -1, 5.3, 9.9)}}};
  EXPECT_EQ(coverOf(shorter).regions.count, 1);
}

TEST(CoverageRegions, OpenFacesNeverJoinTwoRegions) {
  // Truth: what the grid's open faces join lies in one region.
  for (int turn = 0; turn < 60; ++turn) {
    const GridCover cover = coverOf(ring(0.02 * turn, 2.9 + 0.01 * turn, 0.05, false));
    for (int j = 0; j < kGrid.ny; ++j)
      for (int i = 0; i < kGrid.nx; ++i) {
        if (i > 0 && cover.openX(i, j) > 0 && std::min(cover.volume(i, j), cover.volume(i - 1, j)) > 0) {
          ASSERT_EQ(cover.regions.at(i, j), cover.regions.at(i - 1, j));
        }
        if (j > 0 && cover.openY(i, j) > 0 && std::min(cover.volume(i, j), cover.volume(i, j - 1)) > 0) {
          ASSERT_EQ(cover.regions.at(i, j), cover.regions.at(i, j - 1));
        }
      }
  }
}

}  // namespace
}  // namespace smokebox
