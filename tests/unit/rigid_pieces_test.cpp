// Shapes as convex pieces: nothing lost, nothing doubled; mass properties; what lies inside is marked.
#include <gtest/gtest.h>

#include "rigid/collide.h"
#include "rigid/collide_bodies.h"
#include "rigid/pieces.h"
#include "support/rigid_cases.h"

namespace smokebox {
namespace {

using namespace test;

double areaOf(const std::vector<ConvexPiece>& pieces) {
  double area = 0;
  for (const ConvexPiece& piece : pieces) area += signedArea(piece.points);
  return area;
}

/// Pieces are convex, cover the outlines' area, and have each outline edge once.
void expectCover(const std::vector<Outline>& outlines, const std::vector<ConvexPiece>& pieces) {
  double area = 0, around = 0, covered = 0;
  for (const Outline& outline : outlines) {
    area += signedArea(outline);
    for (std::size_t k = 0; k < outline.size(); ++k)
      around += length(outline[(k + 1) % outline.size()] - outline[k]);
  }
  for (const ConvexPiece& piece : pieces) {
    const std::size_t n = piece.points.size();
    ASSERT_GE(n, 3u);
    for (std::size_t k = 0; k < n; ++k) {
      const Vec2 a = piece.points[k], b = piece.points[(k + 1) % n], c = piece.points[(k + 2) % n];
      EXPECT_GE(cross(b - a, c - b), -1e-6 * length(b - a) * length(c - b));
      if (!piece.inner[k]) covered += length(b - a);
    }
  }
  EXPECT_NEAR(areaOf(pieces), area, 1e-9 * std::fabs(area));
  EXPECT_NEAR(covered, around, 1e-7 * around);
}

/// Teeth of four corners each.
Outline gear(int teeth, double inner, double outer) {
  Outline outline;
  for (int k = 0; k < 4 * teeth; ++k) {
    const double r = k % 4 < 2 ? inner : outer, turn = 2 * kPi * (k + 0.1 * (k % 2)) / (4 * teeth);
    outline.push_back({r * exact::cos(turn), r * exact::sin(turn)});
  }
  return outline;
}

/// A star-shaped outline with corners at random distances.
Outline randomStar(Dice& dice, int corners) {
  Outline outline;
  for (int k = 0; k < corners; ++k) {
    const double turn = 2 * kPi * (k + dice.between(0, 0.9)) / corners, r = dice.between(0.3, 1);
    outline.push_back({r * exact::cos(turn), r * exact::sin(turn)});
  }
  return outline;
}

TEST(RigidPieces, CoverThePolygonOnce) {
  // L, comb, gears and random stars: pieces have the area and the outline of the polygon.
  expectCover({{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}},
              convexPieces({{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}}));
  Outline comb{{0, -1}, {20, -1}};
  for (int k = 20; k > 0; --k)
    comb.insert(comb.end(), {{double(k), 1.0}, {k - 0.5, 1.0}, {k - 0.5, 0.0}, {k - 1.0, 0.0}});
  expectCover({comb}, convexPieces({comb}));
  expectCover({gear(250, 0.9, 1)}, convexPieces({gear(250, 0.9, 1)}));
  Dice dice(6);
  for (int trial = 0; trial < 300; ++trial) {
    const Outline star = randomStar(dice, 3 + dice.below(60));
    expectCover({star}, convexPieces({star}));
  }
}

TEST(RigidPieces, HolesStayOpen) {
  // A plate with holes: pieces have its area, none covers the middle of a hole, every edge of a hole is
  // outside.
  std::vector<Outline> outlines{{{0, 0}, {10, 0}, {10, 4}, {0, 4}}};
  for (int k = 0; k < 9; ++k) {
    Outline hole = gear(3 + k, 0.2, 0.4);
    std::reverse(hole.begin(), hole.end());
    for (Vec2& p : hole) p = p + Vec2{1.0 + k, k % 3 + 1.0};
    outlines.push_back(hole);
  }
  const std::vector<ConvexPiece> pieces = convexPieces(outlines);
  expectCover(outlines, pieces);
  for (int k = 0; k < 9; ++k)
    for (const ConvexPiece& piece : pieces)
      EXPECT_FALSE(contains({piece.points}, Vec2{1.0 + k, k % 3 + 1.0}));
}

TEST(RigidPieces, CoverUnionsThatTouchThemselves) {
  // Unions of boxes on a grid (which meet in corners and along edges, and close holes), and at random:
  // covered once.
  Dice dice(9);
  int holes = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    UnionShape all;
    const int parts = 2 + dice.below(14);
    for (int k = 0; k < parts; ++k) {
      if (trial % 2 == 0)
        all.parts.push_back({BoxShape{{0.25 * (1 + dice.below(8)), 0.25 * (1 + dice.below(3))}},
                             {{0.25 * dice.below(8), 0.25 * dice.below(8)}, dice.below(4) * kPi / 2}});
      else
        all.parts.push_back({BoxShape{{dice.between(0.1, 2), dice.between(0.05, 0.3)}},
                             {{dice.between(-1, 1), dice.between(-1, 1)}, dice.between(0, 7)}});
    }
    const std::vector<Outline> outlines = outlinesOf({all, {}}, 1e-3);
    for (const Outline& outline : outlines) holes += signedArea(outline) < 0;
    expectCover(outlines, convexPieces(outlines));
    if (HasFailure()) FAIL() << "trial " << trial;
  }
  EXPECT_GT(holes, 300);
}

TEST(RigidPieces, FewPiecesForSimpleShapes) {
  // An L is two pieces, a convex polygon and a box one, a cross three; a tooth of a gear about one.
  Vec2 offset;
  const auto count = [&](const Outline& outline) { return convexPieces({outline}).size(); };
  EXPECT_EQ(count({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}), 2u);
  EXPECT_EQ(
      count({{1, 0}, {2, 0}, {2, 1}, {3, 1}, {3, 2}, {2, 2}, {2, 3}, {1, 3}, {1, 2}, {0, 2}, {0, 1}, {1, 1}}),
      3u);
  EXPECT_LE(count(gear(250, 0.9, 1)), 400u);
  EXPECT_EQ(makeBodyShape({RegularShape{12, 1}, {}}, 1e-3, offset).pieces.size(), 1u);
  EXPECT_EQ(makeBodyShape({BoxShape{{1, 2}}, {}}, 1e-3, offset).pieces.size(), 1u);
}

TEST(RigidPieces, MassIsExactForCurves) {
  // Circles, ellipses and capsules have the moments of the true curves at a coarse tolerance, moved and
  // turned.
  const Pose pose{{3, -2}, 0.7};
  Vec2 offset;
  BodyShape body = makeBodyShape({CircleShape{0.5}, pose}, 0.05, offset);
  EXPECT_NEAR(body.mass.area, kPi / 4, 1e-15);
  EXPECT_NEAR(body.mass.secondMoment, kPi / 32, 1e-15);
  EXPECT_EQ(offset, (Vec2{3, -2}));
  EXPECT_EQ(body.reach, 0.5);
  EXPECT_EQ(body.thinnest, 1);
  body = makeBodyShape({EllipseShape{{0.5, 0.2}}, pose}, 0.05, offset);
  EXPECT_NEAR(body.mass.secondMoment, kPi * 0.1 / 4 * 0.29, 1e-15);
  EXPECT_GE(body.pieces[0].points.size(), 64u);
  body = makeBodyShape({CapsuleShape{1, 0.2}, pose}, 0.05, offset);
  const MassProperties fine = massProperties(outlinesOf({CapsuleShape{1, 0.2}, {}}, 1e-9));
  EXPECT_NEAR(body.mass.secondMoment, fine.secondMoment, 1e-8);
  EXPECT_NEAR(body.reach, 0.7, 1e-15);
  ASSERT_EQ(body.pieces.size(), 1u);
  EXPECT_EQ(body.pieces[0].points.size(), 2u);
}

TEST(RigidPieces, SolidsKeepTheirOwnOrigin) {
  // A solid turns about the (0, 0) that it is given in: its pieces stay where they are, and its centre of
  // mass is told.
  const Outline bent{{1, 0}, {3, 0}, {3, 1}, {2, 1}, {2, 2}, {1, 2}};
  const BodyShape solid = makeSolidShape({PolygonShape{bent}, {}}, 1e-3);
  for (const ConvexPiece& piece : solid.pieces)
    for (Vec2 p : piece.points) EXPECT_NE(std::find(bent.begin(), bent.end(), p), bent.end());
  EXPECT_NEAR(solid.mass.centre.x, (2 * 2 + 1 * 1.5) / 3, 1e-14);
  EXPECT_NEAR(solid.mass.centre.y, (2 * 0.5 + 1 * 1.5) / 3, 1e-14);
  EXPECT_NEAR(solid.reach, std::sqrt(10), 1e-15);
  Vec2 offset;
  const BodyShape body = makeBodyShape({PolygonShape{bent}, {}}, 1e-3, offset);
  EXPECT_EQ(offset, solid.mass.centre);
  EXPECT_NEAR(length(body.mass.centre), 0, 1e-15);
  EXPECT_NEAR(body.mass.secondMoment, solid.mass.secondMoment, 1e-15);
  EXPECT_NEAR(body.thinnest, 1, 1e-12);
}

TEST(RigidPieces, ThinnestIsTheBodysNotThePieces) {
  // Slivers of a thick body do not make it thin; a thin arm, a plate's rim beside a hole or a thin box do.
  Vec2 offset;
  Outline hills{{10, -1}, {10, 0}};
  Dice dice(8);
  for (double x = 9.9; x > -10; x -= 0.1) hills.push_back({x, dice.between(-0.01, 0.01)});
  hills.push_back({-10, -1});
  const auto thinnest = [&](const Shape& shape) { return makeBodyShape({shape, {}}, 1e-3, offset).thinnest; };
  EXPECT_GT(thinnest(PolygonShape{hills}), 0.4);
  EXPECT_NEAR(thinnest(PolygonShape{{{0, 0}, {2, 0}, {2, 0.02}, {1, 0.02}, {1, 2}, {0, 2}}}), 0.02, 1e-12);
  UnionShape frame;
  for (int k = 0; k < 2; ++k) {
    frame.parts.push_back({BoxShape{{2, 0.1}}, {{0, k - 0.5}, 0}});
    frame.parts.push_back({BoxShape{{0.3, 1}}, {{1.7 * (k - 0.5), 0}, 0}});
  }
  EXPECT_NEAR(thinnest(frame), 0.1, 1e-6);
  EXPECT_NEAR(thinnest(BoxShape{{3, 0.01}}), 0.01, 1e-15);
  EXPECT_NEAR(thinnest(RegularShape{3, 1}), 1.5, 1e-12);
  frame.parts.push_back({CapsuleShape{1, 0.02}, {}});
  EXPECT_NEAR(thinnest(frame), 0.04, 1e-12);
}

TEST(RigidPieces, SpiralsOfManyCornersAreCovered) {
  // A spiral of 8,000 corners, the slowest kind, is covered by few pieces.
  const auto spiral = [](int corners) {
    Outline outline;
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < corners / 2; ++i) {
        const int k = side == 0 ? i : corners / 2 - 1 - i;
        const double turn = 0.05 * k + 3, r = 0.01 * turn + 0.03 * (1 - side);
        outline.push_back({r * exact::cos(turn), r * exact::sin(turn)});
      }
    return outline;
  };
  EXPECT_GT(signedArea(spiral(8000)), 0);
  const std::vector<ConvexPiece> pieces = convexPieces({spiral(8000)});
  expectCover({spiral(8000)}, pieces);
  EXPECT_LT(pieces.size(), 4100u);
}

TEST(RigidPieces, UnionsKeepRoundPartsAndTheirMass) {
  // A dumbbell of two disks apart is exact; with a bar between them the overlap counts once.
  Vec2 offset;
  const PlacedShape left{CircleShape{0.3}, {{-1, 0}, 0}}, right{CircleShape{0.3}, {{1, 0}, 0}};
  BodyShape body = makeBodyShape({UnionShape{{left, right}}, {{5, 5}, 0}}, 0.01, offset);
  EXPECT_EQ(offset, (Vec2{5, 5}));
  EXPECT_NEAR(body.mass.area, 2 * kPi * 0.09, 1e-15);
  EXPECT_NEAR(body.mass.secondMoment, 2 * (kPi / 2 * 0.0081 + kPi * 0.09), 1e-14);
  body = makeBodyShape({UnionShape{{left, right, {BoxShape{{2, 0.2}}, {}}}}, {}}, 0.001, offset);
  EXPECT_EQ(body.pieces.size(), 3u);
  const double half =
      0.3 * 0.3 * (std::asin(1.0 / 3) + 1.0 / 3 * std::sqrt(8.0 / 9));  // of a disk, within the bar
  EXPECT_NEAR(body.mass.area, 2 * kPi * 0.09 + 0.4 - 2 * half, 1e-5);
}

TEST(RigidPieces, PairsAreThoseWhoseBoxesMeet) {
  // The two trees find all pairs of pieces that come within the margin, in ascending order.
  Dice dice(7);
  std::vector<PiecePair> pairs;
  int found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Vec2 offset;
    const BodyShape a = makeBodyShape({PolygonShape{randomStar(dice, 40)}, {}}, 1e-3, offset);
    const BodyShape b = makeBodyShape({PolygonShape{randomStar(dice, 25)}, {}}, 1e-3, offset);
    const Frame fa = dice.frame(1), fb = dice.frame(1);
    findPiecePairs(a, fa, b, fb, 0.05, pairs);
    for (std::size_t k = 0; k + 1 < pairs.size(); ++k)
      ASSERT_TRUE(pairs[k].a < pairs[k + 1].a ||
                  (pairs[k].a == pairs[k + 1].a && pairs[k].b < pairs[k + 1].b));
    for (int i = 0; i < static_cast<int>(a.pieces.size()); ++i)
      for (int j = 0; j < static_cast<int>(b.pieces.size()); ++j) {
        if (a.pieces[i].buried || b.pieces[j].buried) continue;
        if (slowDistance(a.pieces[i], fa, b.pieces[j], fb) > 0.05) continue;
        ++found;
        ASSERT_NE(std::find(pairs.begin(), pairs.end(), PiecePair{i, j}), pairs.end());
      }
  }
  EXPECT_GT(found, 1000);
}

}  // namespace
}  // namespace smokebox
