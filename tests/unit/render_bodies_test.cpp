// The geometry behind the pictures of springs, ropes and cloth; needs no OpenGL.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "base/maths.h"
#include "render/batches.h"
#include "render/body_mark.h"
#include "render/cloth_lines.h"
#include "render/link_shapes.h"

namespace smokebox {
namespace {

double lengthOf(const std::vector<Vec2>& line) {
  double sum = 0;
  for (std::size_t k = 1; k < line.size(); ++k) sum += length(line[k] - line[k - 1]);
  return sum;
}

TEST(RenderRope, HangsAtItsLength) {
  // From end to end the drawn rope is as long as the rope, whether its ends are level, one above the other or
  // in the same place; it hangs below both, and its slope changes evenly (a catenary's tangent over its
  // length is a line).
  const Vec2 a{100, 80};
  for (const Vec2 way : {Vec2{120, 0}, Vec2{-80, 30}, Vec2{15, -90}, Vec2{0, 60}, Vec2{0, 0}, Vec2{1, 100}}) {
    for (const double slack : {1.003, 1.2, 3.0}) {
      const double ropeLength = slack * std::max(length(way), 20.0);
      const std::vector<Vec2> line = hangingRope(a, a + way, ropeLength, {0, 1});
      EXPECT_EQ(line.front(), a);
      EXPECT_EQ(line.back(), a + way);
      EXPECT_NEAR(lengthOf(line), ropeLength, 0.03 * ropeLength) << way.x << " " << way.y << " " << slack;
      double lowest = 0;
      for (const Vec2& p : line) lowest = std::max(lowest, p.y);
      EXPECT_GE(lowest, std::max(a.y, a.y + way.y));
    }
  }
  const std::vector<Vec2> line = hangingRope(a, a + Vec2{200, 40}, 300, {0, 1});
  std::vector<double> slopes;
  for (std::size_t k = 1; k < line.size(); ++k)
    slopes.push_back((line[k].y - line[k - 1].y) / (line[k].x - line[k - 1].x));
  const double change = (slopes.back() - slopes.front()) / static_cast<double>(slopes.size() - 1);
  for (std::size_t k = 1; k < slopes.size(); ++k)
    EXPECT_NEAR(slopes[k] - slopes[k - 1], change, 0.12 * -change);
}

TEST(RenderRope, IsStraightWhereItIsTaut) {
  // At its length, or stretched beyond it, it is a straight line.
  EXPECT_EQ(hangingRope({0, 0}, {30, 40}, 50, {0, 1}), (std::vector<Vec2>{{0, 0}, {30, 40}}));
  EXPECT_EQ(hangingRope({0, 0}, {30, 40}, 45, {0, 1}), (std::vector<Vec2>{{0, 0}, {30, 40}}));
}

double wireOf(const Zigzag& shape, double reach) {
  const double coils = (reach - 2 * shape.straight) / shape.period;
  return 4 * coils * std::hypot(0.25 * shape.period, shape.amplitude);
}

TEST(RenderSpring, KeepsItsCoilsAndItsWire) {
  // As a spring stretches it has the same whole number of coils, and within what its wire allows they flatten
  // so that the wire is as long as before; no end sticks out.
  const double rest = 200;
  const Zigzag atRest = zigzag(rest, rest, 1);
  const double coils = (rest - 2 * atRest.straight) / atRest.period;
  EXPECT_NEAR(coils, std::round(coils), 1e-9);
  for (const double reach : {60.0, 120.0, 200.0, 260.0, 700.0}) {
    const Zigzag shape = zigzag(rest, reach, 1);
    EXPECT_NEAR((reach - 2 * shape.straight) / shape.period, coils, 1e-9) << reach;
    EXPECT_LT(2 * shape.straight, reach);
    EXPECT_GT(shape.amplitude, 0);
    if (reach > 110 && reach < 300) {
      EXPECT_NEAR(wireOf(shape, reach), wireOf(atRest, rest), 1e-9 * rest) << reach;
    }
  }
  EXPECT_GT(zigzag(rest, 120, 1).amplitude, atRest.amplitude);
  EXPECT_LT(zigzag(rest, 260, 1).amplitude, atRest.amplitude);
}

TEST(RenderSpring, IsALineWhereItIsSmall) {
  // Springs of a few pixels, and those without a length at rest, have no coils.
  EXPECT_EQ(zigzag(10, 12, 1).period, 0);
  EXPECT_EQ(zigzag(0, 300, 1).period, 0);
  EXPECT_EQ(zigzag(40, 40, 2).period, 0);  // a large picture has wider lines
}

TEST(RenderSpring, ColourTellsTheTension) {
  // Blue if pressed, red where it pulls, the more the stronger; the neutral colour at rest; equally far both
  // ways. Only the share of what is usual matters, so soft and stiff springs of one scene can be compared.
  const Color neutral{0.5f, 0.5f, 0.5f};
  EXPECT_EQ(tensionColor(0, 7, neutral), neutral);
  float before = 0;
  for (const double tension : {0.02, 0.1, 0.4, 2.0, 50.0}) {
    const Color red = tensionColor(tension, 1, neutral), blue = tensionColor(-tension, 1, neutral);
    EXPECT_GT(red.r, red.b);
    EXPECT_GT(blue.b, blue.r);
    EXPECT_GT(red.r - red.b, before);
    EXPECT_NEAR((red.r - neutral.r) / 0.5f, (blue.b - neutral.b) / 0.5f, 1e-6);
    EXPECT_EQ(tensionColor(30 * tension, 30, neutral), red);
    before = red.r - red.b;
  }
}

TEST(RenderSpring, ColourFillsItsRange) {
  // With a range the colour grows evenly from zero to either end and stays there; a range of one sign begins
  // at its end that is nearest to zero.
  const Color neutral{0.5f, 0.5f, 0.5f};
  const std::array<double, 2> range{-2, 8};
  EXPECT_EQ(tensionColor(0, range, neutral), neutral);
  const Color most = tensionColor(8, range, neutral), half = tensionColor(4, range, neutral);
  EXPECT_NEAR(half.g - neutral.g, 0.5 * (most.g - neutral.g), 1e-6);
  EXPECT_EQ(tensionColor(100, range, neutral), most);
  const Color least = tensionColor(-2, range, neutral);
  EXPECT_GT(least.b, least.r);
  EXPECT_EQ(tensionColor(-9, range, neutral), least);
  const std::array<double, 2> pulls{2, 8};
  EXPECT_EQ(tensionColor(2, pulls, neutral), neutral);
  EXPECT_EQ(tensionColor(8, pulls, neutral), most);
}

/// A polygon in its own coordinates, laid into the world.
std::vector<Outline> laid(Outline own, const Pose& pose) { return {transformed(own, pose)}; }

TEST(RenderBodies, MarkIsASpokeAlongTheirAxis) {
  // A box's mark goes from its centre of mass to the middle of its right edge, and turns with it.
  const Outline box{{-0.3, -0.1}, {0.3, -0.1}, {0.3, 0.1}, {-0.3, 0.1}};
  for (const double degree : {0.0, 33.0, 90.0, 200.0}) {
    const Pose pose{{2, 1}, radians(degree)};
    const auto mark = markOf(laid(box, pose), pose);
    ASSERT_TRUE(mark);
    EXPECT_NEAR(length(mark->from - Vec2{2, 1}), 0, 1e-12) << degree;
    EXPECT_NEAR(length(mark->to - transformed(Vec2{0.3, 0}, pose)), 0, 1e-12) << degree;
  }
}

TEST(RenderBodies, MarkOfAHookIsInsideOfIt) {
  // Where the centre of mass is outside of the body, or its part there is thin, the mark is the longest line
  // across it, the same one at each angle.
  const Outline hook{{0, 0}, {1, 0}, {1, 0.2}, {0.2, 0.2}, {0.2, 0.8}, {1, 0.8}, {1, 1}, {0, 1}};
  const Vec2 centre{0.38, 0.5};
  Outline own = hook;
  for (Vec2& p : own) p = p - centre;
  ASSERT_FALSE(contains({own}, {0, 0}));
  const auto first = markOf({own}, Pose{});
  ASSERT_TRUE(first);
  EXPECT_NEAR(first->to.x, 0.62, 1e-12);
  EXPECT_GT(length(first->to - first->from), 0.7);
  for (int k = 0; k < 40; ++k) {
    const Pose pose{{0.1 * k, -0.3}, 0.17 * k};
    const auto mark = markOf(laid(own, pose), pose);
    ASSERT_TRUE(mark);
    EXPECT_NEAR(length(mark->from - transformed(first->from, pose)), 0, 1e-9) << k;
    EXPECT_NEAR(length(mark->to - transformed(first->to, pose)), 0, 1e-9) << k;
    const Vec2 way = mark->to - mark->from;
    EXPECT_TRUE(contains(laid(own, pose), mark->from) && contains(laid(own, pose), mark->from + 0.99 * way));
  }
}

TEST(RenderBodies, NeighboursDifferInColour) {
  // The colours of ten bodies in a row are ten, and far from each other.
  for (int a = 0; a < 10; ++a)
    for (int b = 0; b < a; ++b) {
      const Color p = bodyColor(a), q = bodyColor(b);
      EXPECT_GT(std::hypot(p.r - q.r, p.g - q.g, p.b - q.b), 0.15) << a << " " << b;
    }
  EXPECT_EQ(bodyColor(3), bodyColor(13));
}

TEST(RenderBodies, OutlinesAreSeenOnAnyFill) {
  // Contrast at least 1.35 to 1 on the fill, whatever it is: darker, but on what is nearly black.
  const auto contrast = [](const Color& fill) {
    const double a = luminance(fill) + 0.05, b = luminance(outlineColor(fill)) + 0.05;
    return std::max(a, b) / std::min(a, b);
  };
  for (int r = 0; r <= 10; ++r)
    for (int g = 0; g <= 10; ++g)
      for (int b = 0; b <= 10; ++b) {
        const Color fill{0.1f * r, 0.1f * g, 0.1f * b};
        EXPECT_GE(contrast(fill), 1.35) << r << " " << g << " " << b;
      }
  EXPECT_EQ(outlineColor({1, 1, 1}), (Color{0.5f, 0.5f, 0.5f}));
  EXPECT_EQ(outlineColor({0, 0, 0}), (Color{0.5f, 0.5f, 0.5f}));
  for (int k = 0; k < 10; ++k) EXPECT_LT(luminance(outlineColor(bodyColor(k))), luminance(bodyColor(k)));
}

/// `columns` x `rows` nodes, a metre apart.
ClothPicture sheet(int columns, int rows) {
  ClothPicture cloth;
  cloth.columns = columns;
  cloth.rows = rows;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) cloth.positions.push_back({double(i), double(j)});
  cloth.whole.assign(std::size_t(columns - 1) * (rows - 1), 1);
  return cloth;
}

double areaIn(const ClothPicture& cloth, const std::vector<int>& loop) {
  Outline outline;
  for (const int node : loop) outline.push_back(cloth.positions[node]);
  return signedArea(outline);
}

TEST(RenderCloth, HemGoesAroundTheSheetAndItsHoles) {
  // The areas within the hem's loops, holes negative, add up to the whole cells, whatever is torn.
  ClothPicture cloth = sheet(7, 6);
  ASSERT_EQ(hemOf(cloth).size(), 1u);
  EXPECT_EQ(hemOf(cloth)[0].size(), 22u);
  EXPECT_EQ(areaIn(cloth, hemOf(cloth)[0]), 30);
  cloth.whole[2 * 6 + 2] = 0;  // a hole
  EXPECT_EQ(hemOf(cloth).size(), 2u);
  for (std::uint32_t state = 1, round = 0; round < 60; ++round) {
    double whole = 0;
    for (char& cell : cloth.whole) {
      state = state * 1664525u + 1013904223u;
      cell = (state >> 28) > 5;
      whole += cell;
    }
    double area = 0;
    std::set<std::pair<int, int>> edges;
    for (const std::vector<int>& loop : hemOf(cloth)) {
      area += areaIn(cloth, loop);
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const bool isNew = edges.insert({loop[k], loop[(k + 1) % loop.size()]}).second;
        EXPECT_TRUE(isNew);
      }
    }
    EXPECT_EQ(area, whole);
  }
}

TEST(RenderCloth, WeaveEndsAtHoles) {
  // Lines run between whole cells only, and no line of the weave is one of the hem.
  ClothPicture cloth = sheet(5, 4);
  EXPECT_EQ(weaveOf(cloth, 1).size(), 2u + 3u);
  EXPECT_EQ(weaveOf(cloth, 2).size(), 1u + 1u);
  cloth.whole[1 * 4 + 1] = 0;
  std::size_t pieces = 0;
  for (const std::vector<int>& line : weaveOf(cloth, 1)) pieces += line.size() - 1;
  EXPECT_EQ(pieces, 2u * 4u + 3u * 3u - 4u);
}

TEST(RenderCloth, LooseNodesHaveNoCell) {
  // Nodes whose cells are all torn are told of; of a whole sheet none is.
  ClothPicture cloth = sheet(4, 4);
  EXPECT_TRUE(looseNodes(cloth).empty());
  cloth.whole[0] = 0;
  EXPECT_EQ(looseNodes(cloth), std::vector<int>{0});
  std::fill(cloth.whole.begin(), cloth.whole.end(), 0);
  EXPECT_EQ(looseNodes(cloth).size(), 16u);
}

TEST(RenderCloth, ShadingShowsStretchAndShear) {
  // A sheet at rest is evenly lit; where it is stretched it is lighter; sheared to one side lighter, to the
  // other darker; its back is darker.
  ClothPicture cloth = sheet(6, 6);
  for (const float light : shadingOf(cloth)) EXPECT_EQ(light, 0);
  ClothPicture stretched = cloth;
  for (int j = 0; j < 6; ++j) stretched.positions[j * 6].x -= 0.5;
  EXPECT_GT(shadingOf(stretched)[2 * 6], shadingOf(stretched)[2 * 6 + 4]);
  ClothPicture left = cloth, right = cloth, back = cloth;
  for (Vec2& p : left.positions) p.x -= 0.3 * p.y;
  for (Vec2& p : right.positions) p.x += 0.3 * p.y;
  for (Vec2& p : back.positions) p.x = -p.x;
  EXPECT_LT(shadingOf(left)[14], -0.1f);
  EXPECT_GT(shadingOf(right)[14], 0.1f);
  EXPECT_LT(shadingOf(back)[14], -0.1f);
}

}  // namespace
}  // namespace smokebox
