// Outlines of shapes: their area, symmetry and accuracy; mass properties; unions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/maths.h"
#include "geometry/shape.h"

namespace smokebox {
namespace {

double area(const std::vector<Outline>& outlines) {
  double sum = 0;
  for (const Outline& outline : outlines) sum += signedArea(outline);
  return sum;
}

TEST(Shapes, CurvesHaveTheirTrueArea) {
  // The polygons that stand for curves have the curves' area, at any tolerance.
  for (double tolerance : {0.1, 1e-2, 1e-4}) {
    EXPECT_NEAR(area(outlinesOf({CircleShape{0.7}, {}}, tolerance)), kPi * 0.49, 1e-13);
    EXPECT_NEAR(area(outlinesOf({EllipseShape{{0.7, 0.2}}, {}}, tolerance)), kPi * 0.14, 1e-13);
    EXPECT_NEAR(area(outlinesOf({CapsuleShape{1.5, 0.3}, {}}, tolerance)), kPi * 0.09 + 1.5 * 0.6, 1e-13);
  }
  EXPECT_NEAR(area(outlinesOf({BoxShape{{2, 0.5}}, {{3, 4}, 1}}, 1)), 1, 1e-14);
  EXPECT_NEAR(area(outlinesOf({RegularShape{6, 1}, {}}, 1)), 1.5 * std::sqrt(3), 1e-14);
  EXPECT_NEAR(area(outlinesOf({RegularShape{5, 1}, {}}, 1)), 2.5 * std::sin(2 * kPi / 5), 1e-14);
}

TEST(Shapes, CurvesKeepWithinTheTolerance) {
  // No corner and no middle of an edge is farther from the circle than the tolerance.
  for (double tolerance : {1e-2, 1e-3, 1e-5}) {
    const Outline outline = outlinesOf({CircleShape{0.5}, {}}, tolerance)[0];
    EXPECT_EQ(outline.size() % 4, 0u);
    EXPECT_LT(outline.size(), 4 + kPi / std::sqrt(tolerance));  // and no more corners than it takes
    for (std::size_t k = 0; k < outline.size(); ++k) {
      EXPECT_NEAR(length(outline[k]), 0.5, tolerance);
      EXPECT_NEAR(length(0.5 * (outline[k] + outline[(k + 1) % outline.size()])), 0.5, tolerance);
    }
  }
}

TEST(Shapes, SymmetricShapesAreSymmetricToTheBit) {
  // Each corner of a curve, box or even-sided figure has its mirror images among the corners, exactly.
  for (const Shape& shape :
       {Shape{CircleShape{0.3}}, Shape{EllipseShape{{0.3, 0.1}}}, Shape{CapsuleShape{0.4, 0.1}},
        Shape{BoxShape{{0.3, 0.7}}}, Shape{RegularShape{6, 0.3}}, Shape{RegularShape{12, 0.3}}}) {
    const Outline outline = outlinesOf({shape, {}}, 1e-3)[0];
    for (Vec2 p : outline) {
      EXPECT_NE(std::find(outline.begin(), outline.end(), Vec2{-p.x, p.y}), outline.end());
      EXPECT_NE(std::find(outline.begin(), outline.end(), Vec2{p.x, -p.y}), outline.end());
    }
    EXPECT_EQ(polygonFault(outline), "");
    EXPECT_GT(signedArea(outline), 0);
  }
}

TEST(Shapes, PolygonsOfEitherOrientationComeOutCounterclockwise) {
  // A polygon given clockwise is the same polygon.
  const std::vector<Vec2> points = {{0, 0}, {0, 1}, {1, 1}, {0.4, 0.4}};
  EXPECT_LT(signedArea(points), 0);
  EXPECT_DOUBLE_EQ(area(outlinesOf({PolygonShape{points}, {}}, 1)), -signedArea(points));
}

TEST(Shapes, QuarterTurnsAreExact) {
  // A box turned by 90 degrees is the other box, to the bit.
  const Outline turned = outlinesOf({BoxShape{{2, 1}}, {{5, 5}, kPi / 2}}, 1)[0];
  const Outline upright = outlinesOf({BoxShape{{1, 2}}, {{5, 5}, 0}}, 1)[0];
  for (Vec2 p : upright) EXPECT_NE(std::find(turned.begin(), turned.end(), p), turned.end());
}

TEST(Shapes, PosesCombine) {
  // Moving by `inner` and then by `outer` is moving by their combination.
  const Pose outer{{1, 2}, 0.7}, inner{{-3, 0.5}, 1.1};
  const Vec2 p{0.3, 0.9}, twice = transformed(transformed(p, inner), outer),
                          once = transformed(p, combined(outer, inner));
  EXPECT_NEAR(twice.x, once.x, 1e-14);
  EXPECT_NEAR(twice.y, once.y, 1e-14);
}

TEST(MassProperties, MatchTheFormulas) {
  // Box: (a^2 + b^2) / 12; circle: r^2 / 2; a ring is the difference; wherever it lies and however it is
  // turned.
  const auto box = outlinesOf({BoxShape{{3, 2}}, {{100, -50}, 0.3}}, 1);
  MassProperties mass = massProperties(box);
  EXPECT_NEAR(mass.area, 6, 1e-11);
  EXPECT_NEAR(mass.centre.x, 100, 1e-11);
  EXPECT_NEAR(mass.centre.y, -50, 1e-11);
  EXPECT_NEAR(mass.secondMoment, 6 * 13 / 12.0, 1e-10);
  mass = massProperties(outlinesOf({CircleShape{2}, {{1, 1}, 0}}, 1e-6));
  EXPECT_NEAR(mass.secondMoment, kPi * 8, 1e-4);
  std::vector<Outline> ring = outlinesOf({BoxShape{{4, 4}}, {}}, 1);
  Outline hole = outlinesOf({BoxShape{{2, 2}}, {{0.5, 0}, 0}}, 1)[0];
  std::reverse(hole.begin(), hole.end());
  ring.push_back(hole);
  mass = massProperties(ring);
  EXPECT_NEAR(mass.area, 12, 1e-12);
  EXPECT_NEAR(mass.centre.x, -4 * 0.5 / 12, 1e-12);
  const double shift = mass.centre.x;
  EXPECT_NEAR(mass.secondMoment, 16 * 32 / 12.0 - 4 * (8 / 12.0 + 0.25) - 12 * shift * shift, 1e-12);
  EXPECT_TRUE(contains(ring, {-1.5, 0}));
  EXPECT_FALSE(contains(ring, {0.5, 0.5}));
}

TEST(Merged, UnionHasTheUnionsArea) {
  // Overlap is counted once; parts that touch become one outline; a frame of four keeps its hole.
  auto box = [](Vec2 centre, Vec2 size, double angle) {
    return PlacedShape{BoxShape{size}, {centre, angle}};
  };
  auto merge = [](std::vector<PlacedShape> parts) {
    return outlinesOf({UnionShape{std::move(parts)}, {}}, 1e-3);
  };
  auto cross = merge({box({0, 0}, {3, 1}, 0), box({0, 0}, {1, 3}, 0)});
  EXPECT_EQ(cross.size(), 1u);
  EXPECT_NEAR(area(cross), 5, 1e-7);
  auto touching = merge({box({-0.5, 0}, {1, 1}, 0), box({0.5, 0}, {1, 1}, 0)});
  EXPECT_EQ(touching.size(), 1u);
  EXPECT_NEAR(area(touching), 2, 1e-7);
  for (double turn : {0.0, 0.4, 1.0}) {
    UnionShape frame{{box({1, 0}, {0.1, 1.9}, 0), box({-1, 0}, {0.1, 1.9}, 0), box({0, 1}, {2.1, 0.1}, 0),
                      box({0, -1}, {2.1, 0.1}, 0)}};
    auto outlines = outlinesOf({UnionShape{{{frame, {{0.3, 0.2}, turn}}}}, {}}, 1e-3);
    ASSERT_EQ(outlines.size(), 2u) << turn;
    EXPECT_NEAR(area(outlines), 2.1 * 2.1 - 1.9 * 1.9, 1e-7);
    EXPECT_FALSE(contains(outlines, {0.3, 0.2}));
  }
  EXPECT_EQ(merge({box({0, 0}, {1, 1}, 0), box({5, 0}, {1, 1}, 0)}).size(), 2u);
}

}  // namespace
}  // namespace smokebox
