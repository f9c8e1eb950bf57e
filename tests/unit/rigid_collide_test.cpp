// Contacts of convex pieces: known answers, and random pairs against the slow way.
#include <gtest/gtest.h>

#include "rigid/collide.h"
#include "support/rigid_cases.h"

namespace smokebox {
namespace {

using namespace test;

ConvexPiece box(double width, double height) {
  const double x = width / 2, y = height / 2;
  return makePiece({{-x, -y}, {x, -y}, {x, y}, {-x, y}}, 0);
}

double smallestGap(const Manifold& manifold) {
  double gap = 1e300;
  for (int k = 0; k < manifold.count; ++k) gap = std::min(gap, manifold.points[k].gap);
  return gap;
}

TEST(RigidCollide, BoxOnBoxTouchesAtTwoCorners) {
  // A box on a wide slab, overlapping by 1 mm: both lower corners, normal up, points in the middle of the
  // overlap.
  Manifold m;
  ASSERT_TRUE(collide(box(4, 1), {{0, 0}, {}}, box(1, 1), {{0.3, 0.999}, {}}, 0.01, m));
  ASSERT_EQ(m.count, 2);
  EXPECT_NEAR(m.normal.x, 0, 1e-15);
  EXPECT_NEAR(m.normal.y, 1, 1e-15);
  for (const ManifoldPoint& point : m.points) {
    EXPECT_NEAR(point.gap, -0.001, 1e-15);
    EXPECT_NEAR(point.point.y, 0.4995, 1e-15);
    EXPECT_NEAR(std::fabs(point.point.x - 0.3), 0.5, 1e-15);
  }
  EXPECT_NE(m.points[0].feature, m.points[1].feature);
}

TEST(RigidCollide, EqualBoxesStackedFlushTouchAtTwoCorners) {
  // Equal boxes exactly above each other, apart, touching or overlapping: two points with the width between
  // them.
  for (double gap : {-1e-3, 0.0, 1e-9, 1e-3}) {
    for (double shift : {0.0, 1e-12, -1e-12, 1e-6}) {
      Manifold m;
      ASSERT_TRUE(collide(box(1, 1), {{0, 0}, {}}, box(1, 1), {{shift, 1 + gap}, {}}, 0.01, m));
      ASSERT_EQ(m.count, 2) << gap << " " << shift;
      EXPECT_NEAR(m.normal.y, 1, 1e-14);
      EXPECT_NEAR(std::fabs(m.points[0].point.x - m.points[1].point.x), 1, 1e-5);
      EXPECT_NEAR(m.points[0].gap, gap, 1e-14);
      EXPECT_NEAR(m.points[1].gap, gap, 1e-14);
    }
  }
}

TEST(RigidCollide, CornersThatAreClosestSeeTheEdgesBesideThem) {
  // Two boxes corner over corner, 0.02 apart along a normal that leans by b, the upper one tilted by a: their
  // edges open like a wedge to the left, to 0.02 + sin(a - b) + cos(a - b) tan(b) at the end of the upper
  // one.
  constexpr double a = 0.1, b = 0.04, apart = 0.02;
  const double opening = apart + std::sin(a - b) + std::cos(a - b) * std::tan(b);
  const Turn tilt = turnBy(-a);
  const Vec2 corner = Vec2{0.5, 0.5} + apart * Vec2{std::sin(b), std::cos(b)};
  const Frame lower{{0, 0}, {}}, upper{corner - rotate(tilt, {0.5, -0.5}), tilt};
  for (const bool swapped : {false, true}) {
    for (const double margin : {0.2, 0.11}) {
      Manifold m;
      ASSERT_TRUE(collide(box(1, 1), swapped ? upper : lower, box(1, 1), swapped ? lower : upper, margin, m));
      EXPECT_NEAR((swapped ? -1 : 1) * m.normal.x, std::sin(b), 1e-13);
      EXPECT_NEAR(m.points[0].gap, apart, 1e-13);
      ASSERT_EQ(m.count, margin > opening ? 2 : 1);
      if (m.count < 2) continue;
      EXPECT_NEAR(m.points[1].gap, opening, 1e-13);
      const Vec2 end = toWorld(upper, {-0.5, -0.5}) - 0.5 * opening * Vec2{std::sin(b), std::cos(b)};
      EXPECT_NEAR(length(m.points[1].point - end), 0, 1e-13);
      EXPECT_NE(m.points[0].feature, m.points[1].feature);
    }
  }
}

TEST(RigidCollide, RoundPiecesAreExact) {
  // Disks and capsules: gap and normal are those of their centres and middle lines.
  Manifold m;
  const ConvexPiece disk = makePiece({{0, 0}}, 0.5), capsule = makePiece({{-1, 0}, {1, 0}}, 0.25);
  ASSERT_TRUE(collide(disk, {{0, 0}, {}}, disk, {{0.6, 0.8}, {}}, 0.1, m));
  EXPECT_NEAR(m.normal.x, 0.6, 1e-15);
  EXPECT_NEAR(m.points[0].gap, 0, 1e-15);
  EXPECT_NEAR(m.points[0].point.y, 0.4, 1e-15);
  ASSERT_TRUE(collide(capsule, {{0, 0}, {}}, disk, {{1.6, 0.8}, {}}, 0.3, m));  // at the cap
  EXPECT_NEAR(m.points[0].gap, 0.25, 1e-15);
  EXPECT_NEAR(m.normal.y, 0.8, 1e-15);
  ASSERT_TRUE(collide(disk, {{0.2, -0.7}, {}}, capsule, {{0, 0}, {}}, 0, m));  // at the side
  EXPECT_NEAR(m.points[0].gap, -0.05, 1e-15);
  EXPECT_NEAR(m.normal.y, 1, 1e-15);
  ASSERT_TRUE(collide(capsule, {{0, 0}, {}}, capsule, {{0.5, 0.49}, {}}, 0.1, m));  // side by side
  EXPECT_EQ(m.count, 2);
  EXPECT_NEAR(smallestGap(m), -0.01, 1e-15);
  ASSERT_TRUE(collide(capsule, {{0, 0}, {}}, capsule, {{2.45, 0}, {}}, 0.1, m));  // end to end
  EXPECT_EQ(m.count, 1);
  EXPECT_NEAR(m.points[0].gap, -0.05, 1e-15);
  EXPECT_NEAR(m.normal.x, 1, 1e-15);
  EXPECT_FALSE(collide(capsule, {{0, 0}, {}}, capsule, {{2.7, 0}, {}}, 0.1, m));
}

TEST(RigidCollide, CrossingCapsulesOverlap) {
  // Long thin capsules that cross far from their ends, or close to two of them, overlap by at least their
  // radii.
  const ConvexPiece capsule = makePiece({{-1, 0}, {1, 0}}, 0.01);
  for (double turn : {0.01, 0.1, 1.0, 1.5, 3.0})
    for (double at : {0.0, 0.5, 0.99}) {
      const Turn q = turnBy(turn);
      const Frame crossing{Vec2{at, 0} - rotate(q, {at, 0}), q};  // both pass through (at, 0)
      Manifold m;
      ASSERT_TRUE(collide(capsule, {}, capsule, crossing, 1e-3, m)) << turn << " " << at;
      EXPECT_LT(smallestGap(m), -0.02 + 1e-9) << turn << " " << at;
    }
}

TEST(RigidCollide, RandomPairsHaveTheTrueGapAndNormal) {
  // The smallest gap is the true distance, or the least overlap of all edges' normals, and moving B along the
  // normal by the gap's negative makes them touch.
  Dice dice(1);
  int apart = 0, overlapping = 0, none = 0;
  for (int trial = 0; trial < 40000; ++trial) {
    const int na = 1 + dice.below(9), nb = 1 + dice.below(trial % 50 == 0 ? 40 : 9);
    const ConvexPiece a =
        randomPiece(dice, na, na < 3 || dice.below(2) ? dice.between(0.001, 0.3) * dice.between(0, 1) : 0);
    const ConvexPiece b =
        randomPiece(dice, nb, nb < 3 || dice.below(2) ? dice.between(0.001, 0.3) * dice.between(0, 1) : 0);
    const Frame fa = dice.frame(1.5), fb = dice.frame(1.5);
    const double wide = dice.between(0, 1), margin = wide * wide * wide, cores = slowDistance(a, fa, b, fb),
                 radii = a.radius + b.radius;
    Manifold m;
    const bool touching = collide(a, fa, b, fb, margin, m);
    ASSERT_EQ(touching, cores - radii <= margin) << trial;
    if (!touching) {
      ++none;
      continue;
    }
    ASSERT_NEAR(length(m.normal), 1, 1e-12);
    if (cores > 1e-6) {
      ++apart;
      ASSERT_NEAR(smallestGap(m), cores - radii, 1e-5 * cores) << trial;
    } else if (na > 1 || nb > 1) {
      ++overlapping;
      const double overlap = slowOverlap(a, fa, b, fb);
      ASSERT_NEAR(smallestGap(m), overlap - radii, 1e-3) << trial;  // A's face is preferred a little
    }
  }
  EXPECT_GT(apart, 4000);
  EXPECT_GT(overlapping, 5000);
  EXPECT_GT(none, 5000);
}

TEST(RigidCollide, SwappedPairsGiveTheSameContact) {
  // Exchanging A and B turns the normal round and keeps the points (unless both faces are equally good).
  Dice dice(2);
  int compared = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const ConvexPiece a = randomPiece(dice, 1 + dice.below(8), 0.1),
                      b = randomPiece(dice, 1 + dice.below(8), 0.05);
    const Frame fa = dice.frame(1), fb = dice.frame(1);
    Manifold m, swapped;
    const bool touching = collide(a, fa, b, fb, 0.3, m);
    ASSERT_EQ(collide(b, fb, a, fa, 0.3, swapped), touching);
    if (!touching || length(m.normal + swapped.normal) > 1e-6) continue;
    ++compared;
    ASSERT_EQ(m.count, swapped.count);
    ASSERT_NEAR(smallestGap(m), smallestGap(swapped), 1e-9);
  }
  EXPECT_GT(compared, 8000);
}

TEST(RigidCollide, MirroredPairsGiveTheMirroredContact) {
  // The mirror image of two pieces touches in the mirror image of their contact.
  Dice dice(10);
  const auto mirrored = [](const ConvexPiece& piece) {
    std::vector<Vec2> points;
    for (auto p = piece.points.rbegin(); p != piece.points.rend(); ++p) points.push_back({-p->x, p->y});
    return makePiece(points, piece.radius);
  };
  const auto image = [](const Frame& f) {
    return Frame{{-f.position.x, f.position.y}, {f.turn.c, -f.turn.s}};
  };
  int compared = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const ConvexPiece a = randomPiece(dice, 1 + dice.below(8), 0.1),
                      b = randomPiece(dice, 1 + dice.below(8), 0.05);
    const Frame fa = dice.frame(1), fb = dice.frame(1);
    Manifold m, other;
    const bool touching = collide(a, fa, b, fb, 0.3, m);
    ASSERT_EQ(collide(mirrored(a), image(fa), mirrored(b), image(fb), 0.3, other), touching);
    if (!touching) continue;
    ++compared;
    ASSERT_EQ(m.count, other.count) << trial;
    ASSERT_NEAR(length(m.normal - Vec2{-other.normal.x, other.normal.y}), 0, 1e-6);
    ASSERT_NEAR(smallestGap(m), smallestGap(other), 1e-9);
  }
  EXPECT_GT(compared, 8000);
}

TEST(RigidCollide, MovedPairsGiveTheMovedContact) {
  // Turning and moving the whole scene turns and moves the contact, and nothing else.
  Dice dice(3);
  for (int trial = 0; trial < 20000; ++trial) {
    const ConvexPiece a = randomPiece(dice, 1 + dice.below(8), 0.1),
                      b = randomPiece(dice, 1 + dice.below(8), 0.05);
    const Frame fa = dice.frame(1), fb = dice.frame(1), by = dice.frame(10);
    const auto moved = [&](const Frame& f) {
      return Frame{
          toWorld(by, f.position),
          {by.turn.c * f.turn.c - by.turn.s * f.turn.s, by.turn.s * f.turn.c + by.turn.c * f.turn.s}};
    };
    Manifold m, other;
    const bool touching = collide(a, fa, b, fb, 0.3, m);
    ASSERT_EQ(collide(a, moved(fa), b, moved(fb), 0.3, other), touching);
    if (!touching) continue;
    ASSERT_EQ(m.count, other.count) << trial;
    ASSERT_NEAR(length(rotate(by.turn, m.normal) - other.normal), 0, 1e-6);
    for (int k = 0; k < m.count; ++k) {
      ASSERT_NEAR(m.points[k].gap, other.points[k].gap, 1e-9);
      ASSERT_EQ(m.points[k].feature, other.points[k].feature);
      ASSERT_NEAR(length(toWorld(by, m.points[k].point) - other.points[k].point), 0, 1e-6);
    }
  }
}

}  // namespace
}  // namespace smokebox
