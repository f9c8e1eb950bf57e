// Bodies of several pieces: what lies inside pushes nothing, and nothing on the outline is lost.
#include <gtest/gtest.h>

#include "rigid/collide.h"
#include "rigid/collide_bodies.h"
#include "rigid/distance.h"
#include "rigid/pieces.h"
#include "support/rigid_cases.h"

namespace smokebox {
namespace {

using namespace test;

struct Contacts {
  std::vector<Manifold> manifolds;
  double smallestGap = 1e300, smallestUp = 1;
};

double smallestGapOf(const Manifold& manifold) {
  return std::min(manifold.points[0].gap, manifold.points[manifold.count - 1].gap);
}

Contacts contactsOf(const BodyShape& a, const Frame& fa, const BodyShape& b, const Frame& fb, double margin) {
  Contacts contacts;
  std::vector<PiecePair> pairs;
  findPiecePairs(a, fa, b, fb, margin, pairs);
  for (PiecePair pair : pairs) {
    Manifold manifold;
    if (!collide(a.pieces[pair.a], fa, b.pieces[pair.b], fb, margin, manifold)) continue;
    contacts.manifolds.push_back(manifold);
    contacts.smallestUp = std::min(contacts.smallestUp, manifold.normal.y);
    for (int k = 0; k < manifold.count; ++k)
      contacts.smallestGap = std::min(contacts.smallestGap, manifold.points[k].gap);
  }
  return contacts;
}

BodyShape shapeOf(const Shape& shape) {
  Vec2 offset;
  return makeBodyShape({shape, {}}, 1e-3, offset);
}

/// Of the bodies: over all pairs of pieces.
Closest closestOf(const BodyShape& a, const Frame& fa, const BodyShape& b, const Frame& fb) {
  Closest best;
  best.distance = 1e300;
  for (const ConvexPiece& p : a.pieces)
    for (const ConvexPiece& q : b.pieces) {
      const Closest closest = closestPoints(p, fa, q, fb);
      if (closest.distance < best.distance) best = closest;
    }
  return best;
}

TEST(RigidSeams, ABoxSlidesOverTheSeamOfTwoPieces) {
  // Flat ground of two pieces with a seam at x = 0: whatever the overlap and wherever the box is, normals
  // point straight up, and the box is carried over its whole width.
  BodyShape ground;
  const Vec2 up{0, 1}, right{1, 0}, down{0, -1}, left{-1, 0};
  ConvexPiece first = makePiece({{-5, -1}, {0, -1}, {0, 0}, {-5, 0}}, 0);
  first.inner = {0, 1, 0, 0};
  first.cones = {{{left, down}}, {{down, down}}, {{up, up}}, {{up, left}}};
  ConvexPiece second = makePiece({{0, -1}, {5, -1}, {5, 0}, {0, 0}}, 0);
  second.inner = {0, 0, 0, 1};
  second.cones = {{{down, down}}, {{down, right}}, {{right, up}}, {{up, up}}};
  for (ConvexPiece* piece : {&first, &second}) {
    finishPiece(*piece);
    ground.pieces.push_back(*piece);
  }
  ground.tree = PieceTree(ground.pieces);
  for (const Shape& shape :
       {Shape{BoxShape{{0.4, 0.2}}}, Shape{CapsuleShape{0.2, 0.1}}, Shape{CircleShape{0.1}}}) {
    const BodyShape slider = shapeOf(shape);
    const bool round = std::holds_alternative<CircleShape>(shape);
    for (double overlap : {0.02, 2e-3, 5e-4, 1e-6, 0.0, -1e-3})
      for (int k = -4000; k <= 4000; ++k) {
        const double x = k * 1e-4;
        const Contacts contacts = contactsOf(ground, {{0, 0}, {}}, slider, {{x, 0.1 - overlap}, {}}, 5e-3);
        ASSERT_NEAR(contacts.smallestUp, 1, 1e-12) << x << " " << overlap;
        ASSERT_NEAR(contacts.smallestGap, -overlap, 1e-12) << x << " " << overlap;
        double lo = 1e300, hi = -1e300;
        for (const Manifold& m : contacts.manifolds)
          for (int i = 0; i < m.count; ++i) {
            lo = std::min(lo, m.points[i].point.x - x);
            hi = std::max(hi, m.points[i].point.x - x);
          }
        const double half = round ? 0 : std::holds_alternative<BoxShape>(shape) ? 0.2 : 0.1;
        // Within ten overlaps of the seam the second piece may be left out.
        ASSERT_NEAR(lo, -half, 0.1 * std::fabs(overlap) + 1e-9) << x << " " << overlap;
        ASSERT_NEAR(hi, half, 0.1 * std::fabs(overlap) + 1e-9) << x << " " << overlap;
      }
  }
}

TEST(RigidSeams, HillyGroundPushesUpOnly) {
  // A ground of slopes below 0.05 in many pieces: a box, a capsule, a triangle and a disk with small overlaps
  // are pushed along normals within that of vertical.
  Outline hills{{10, -1}, {10, 0}};
  Dice dice(8);
  for (double x = 9.9; x > -10; x -= dice.between(0.05, 0.4))
    hills.push_back({x, hills.back().y + dice.between(-0.01, 0.01) * 0.25});
  hills.insert(hills.end(), {{-10, 0}, {-10, -1}});
  Vec2 offset;
  const BodyShape ground = makeSolidShape({PolygonShape{hills}, {}}, 1e-3);
  EXPECT_GT(ground.pieces.size(), 20u);
  for (const Shape& shape :
       {Shape{BoxShape{{0.4, 0.2}}}, Shape{CapsuleShape{0.2, 0.1}}, Shape{CircleShape{0.1}},
        Shape{PolygonShape{{{-0.3, -0.1}, {0.3, -0.1}, {0, 0.2}}}}}) {
    const BodyShape slider = shapeOf(shape);
    for (int k = 0; k < 500; ++k) {
      Frame frame{{-9 + 18.0 * k / 500, 1}, turnBy(dice.between(-0.02, 0.02))};
      for (int round = 0; round < 40; ++round)
        frame.position.y -= closestOf(ground, {}, slider, frame).distance * 0.99;
      for (double overlap : {1e-4, 1e-3}) {
        Frame pressed = frame;
        pressed.position.y -= overlap;
        const Contacts contacts = contactsOf(ground, {}, slider, pressed, 1e-3);
        ASSERT_FALSE(contacts.manifolds.empty());
        ASSERT_GT(contacts.smallestUp, 0.99) << pressed.position.x << " " << overlap;
        ASSERT_LT(contacts.smallestGap, -0.9 * overlap);
        ASSERT_GT(contacts.smallestGap, -2 * overlap);
      }
    }
  }
}

TEST(RigidSeams, ACornerAtTheBottomOfANotchMeetsBothEdges) {
  // The needle's tip is wherever about the bottom, outside, behind one edge or behind both: outside is what
  // lies in front of both lines, so there is a contact with either, as deep as the tip is behind its line.
  constexpr double kMargin = 5e-3;
  Dice dice(12);
  int behindBoth = 0, beyondAnEnd = 0;
  for (const double slope : {1.2, 0.6, 0.3, 0.1}) {
    const BodyShape block =
        makeSolidShape({PolygonShape{{{-1, -1}, {1, -1}, {1, slope}, {0, 0}, {-1, slope}}}, {}}, 1e-3);
    const BodyShape needle = shapeOf(PolygonShape{{{0, 0}, {0.02, 0.3}, {-0.02, 0.3}}});
    const Vec2 tip{0, -0.2};  // from its centre
    for (int k = 0; k < 4000; ++k) {
      const Turn turn = turnBy(dice.between(-0.1, 0.1));
      const Vec2 at{dice.between(-2e-3, 2e-3), dice.between(-1e-3, 2e-3)};
      const Contacts contacts = contactsOf(block, {}, needle, {at - rotate(turn, tip), turn}, kMargin);
      bool isBehind = true;
      for (const double side : {-1.0, 1.0}) {
        const Vec2 normal = (1 / std::hypot(slope, 1)) * Vec2{-side * slope, 1};
        const double gap = dot(normal, at);
        const bool isMet =
            std::any_of(contacts.manifolds.begin(), contacts.manifolds.end(), [&](const Manifold& m) {
              return length(m.normal - normal) < 1e-9 && std::fabs(smallestGapOf(m) - gap) < 1e-9;
            });
        ASSERT_TRUE(isMet) << "slope " << slope << ", side " << side << ", at " << at.x << " " << at.y;
        isBehind &= gap < 0;
        beyondAnEnd += dot(at, perpendicular(normal)) * side > 0 ? 0 : 1;
      }
      behindBoth += isBehind;
    }
  }
  EXPECT_GT(behindBoth, 500);
  EXPECT_GT(beyondAnEnd, 500);
}

TEST(RigidSeams, WhatSlidesDownOutsideAThinCupMeetsItsSideOnly) {
  // The floor inside ends at a notch 2 cm from there, and the margin is wider: still it bounds nothing
  // outside.
  constexpr double kWall = 0.02;
  for (const double base : {kWall, 1.0}) {
    const BodyShape cup = makeSolidShape({PolygonShape{{{-kWall, -base},
                                                        {3 + kWall, -base},
                                                        {3 + kWall, 1},
                                                        {3, 1},
                                                        {3, 0},
                                                        {0, 0},
                                                        {0, 1},
                                                        {-kWall, 1}}},
                                          {}},
                                         1e-3);
    const BodyShape box = shapeOf(BoxShape{{2, 2}});
    for (const double apart : {5e-3, 1e-4, -1e-4, -2e-3})
      for (int k = -300; k <= 300; ++k) {
        const Frame frame{{-kWall - apart - 1, 1 + k * 1e-3}, {}};
        for (const Manifold& m : contactsOf(cup, {}, box, frame, 0.08).manifolds) {
          ASSERT_NEAR(m.normal.x, -1, 1e-9) << base << " " << apart << " " << k;
          ASSERT_NEAR(smallestGapOf(m), apart, 1e-9) << base << " " << apart << " " << k;
        }
      }
  }
}

TEST(RigidSeams, WhatALongPlateHasSwallowedIsPushedOutOfItsNearestFace) {
  // The way out is at most half the plate's height and the star's reach; a piece of it may ask for twice
  // that, but never for the way to the plate's end.
  const double height = 1, reach = 0.4;
  const BodyShape plate = makeSolidShape({BoxShape{{24, height}}, {}}, 1e-3);
  Dice dice(5);
  for (int k = 0; k < 2000; ++k) {
    const auto star = randomPolygon(dice, true, reach);
    const Frame frame{{dice.between(-8, 8), dice.between(-0.3, 0.3)}, turnBy(dice.between(0, 6))};
    const Contacts contacts = contactsOf(plate, {}, *star, frame, 0.02);
    ASSERT_FALSE(contacts.manifolds.empty()) << k;
    ASSERT_GT(contacts.smallestGap, -2 * (0.5 * height + reach)) << k;
  }
}

Outline randomStar(Dice& dice, int corners, double nearest) {
  Outline outline;
  for (int k = 0; k < corners; ++k) {
    const double turn = 2 * kPi * (k + dice.between(0, 0.9)) / corners, r = dice.between(nearest, 1);
    outline.push_back({r * exact::cos(turn), r * exact::sin(turn)});
  }
  return outline;
}

Shape randomProbe(Dice& dice) {
  switch (dice.below(4)) {
    case 0:
      return CircleShape{0.1};
    case 1:
      return BoxShape{{0.2, 0.1}};
    case 2:
      return CapsuleShape{0.2, 0.05};
    default:
      break;
  }
  Outline star = randomStar(dice, 8, 0.4);
  for (Vec2& p : star) p = 0.3 * p;
  return PolygonShape{star};
}

TEST(RigidSeams, StarsTouchOnTheirOutlinesOnly) {
  // Random stars and probes brought together along a line, a little apart or overlapping: the smallest gap is
  // that of the bodies, no contact is lost, none is deeper than a few times the overlap.
  Dice dice(11);
  int apart = 0, overlapping = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const BodyShape star = shapeOf(PolygonShape{randomStar(dice, 5 + dice.below(20), 0.4)});
    const BodyShape probe = shapeOf(randomProbe(dice));
    const Frame fixed = dice.frame(1);
    const Vec2 away = turnBy(dice.between(0, 7)).c * Vec2{1, 0} + Vec2{0, dice.between(-1, 1)};
    if (length(away) < 0.1) continue;
    const Vec2 out = (1 / length(away)) * away;
    Frame frame{fixed.position + 2.0 * out, turnBy(dice.between(0, 7))};
    Closest closest;
    for (int round = 0; round < 300; ++round) {
      closest = closestOf(star, fixed, probe, frame);
      if (closest.distance < 1e-7) break;
      frame.position = frame.position - closest.distance * out;
    }
    if (std::fabs(closest.distance) > 1e-6) continue;
    for (double gap : {5e-4, 1e-6, -1e-4, -1e-3}) {
      Frame placed = frame;
      placed.position = placed.position + gap * closest.normal;
      const Contacts contacts = contactsOf(star, fixed, probe, placed, 1e-3);
      ASSERT_FALSE(contacts.manifolds.empty()) << trial << " " << gap;
      if (gap > 0) {
        ++apart;
        ASSERT_NEAR(contacts.smallestGap, closestOf(star, fixed, probe, placed).distance, 1e-6) << trial;
      } else {
        ++overlapping;
        ASSERT_GT(contacts.smallestGap, -5e-3) << trial << " " << gap;
        ASSERT_LT(contacts.smallestGap, 0) << trial << " " << gap;
      }
    }
  }
  EXPECT_GT(apart, 4000);
  EXPECT_GT(overlapping, 4000);
}

/// Teeth of four corners each.
Outline gear(int teeth, double inner, double outer) {
  Outline outline;
  for (int k = 0; k < 4 * teeth; ++k) {
    const double r = (k + 1) % 4 < 2 ? inner : outer, turn = 2 * kPi * k / (4 * teeth);
    outline.push_back({r * exact::cos(turn), r * exact::sin(turn)});
  }
  return outline;
}

TEST(RigidSeams, GearsOfAThousandCornersMesh) {
  // Two gears of 250 teeth brought together as deep as they go, at many angles: the smallest gap is the true
  // distance, and with a slight overlap no contact is deeper than that.
  const double tooth = 2 * kPi / 250;
  const BodyShape body = shapeOf(PolygonShape{gear(250, 1 - 0.5 * tooth, 1)});
  EXPECT_LE(body.pieces.size(), 251u);
  std::vector<PiecePair> pairs;
  for (int k = 0; k < 40; ++k) {
    const Frame fixed{{0, 0}, turnBy(0.37)};
    Frame frame{{2 + 2 * tooth, 0}, turnBy(k * tooth / 40)};
    const auto distance = [&] {  // pieces of the far sides left out
      findPiecePairs(body, fixed, body, frame, 3 * tooth, pairs);
      double nearest = 1e300;
      for (PiecePair pair : pairs)
        nearest =
            std::min(nearest, closestPoints(body.pieces[pair.a], fixed, body.pieces[pair.b], frame).distance);
      return nearest;
    };
    for (int round = 0; round < 200; ++round) {
      const double gap = distance();
      if (gap < 1e-9) break;
      frame.position.x -= gap;
    }
    EXPECT_LT(frame.position.x, 2 + 0.05 * tooth);
    frame.position.x += 1e-5;
    EXPECT_NEAR(contactsOf(body, fixed, body, frame, 1e-3 * tooth).smallestGap, distance(), 1e-9) << k;
    frame.position.x -= 2e-5;
    const double overlap = contactsOf(body, fixed, body, frame, 1e-3 * tooth).smallestGap;
    EXPECT_LT(overlap, 0) << k;
    EXPECT_GE(overlap, -1.1e-5) << k;
  }
}

TEST(RigidSeams, APegInAHoleTouchesItsRim) {
  // A disk inside the hole of a ring meets the rim, at the gap between them, and the ring's inside is free.
  Outline hole = outlinesOf({RegularShape{6, 0.5}, {}}, 1)[0];
  const Outline rim = outlinesOf({RegularShape{6, 1}, {}}, 1)[0];
  // A ring is a union of six bars.
  UnionShape bars;
  for (int k = 0; k < 6; ++k)
    bars.parts.push_back({PolygonShape{{rim[k], rim[(k + 1) % 6], hole[(k + 1) % 6], hole[k]}}, {}});
  const BodyShape ring = shapeOf(bars), peg = shapeOf(CircleShape{0.2});
  ASSERT_EQ(ring.outlines.size(), 2u);
  EXPECT_NEAR(ring.mass.area, 1.5 * std::sqrt(3) * 0.75, 1e-6);
  EXPECT_TRUE(contactsOf(ring, {}, peg, {{0, 0}, {}}, 0.1).manifolds.empty());
  const double flat = 0.5 * std::sqrt(3) / 2;
  for (double gap : {0.05, 1e-4, -1e-3}) {
    const Contacts contacts = contactsOf(ring, {}, peg, {{0, flat - 0.2 - gap}, {}}, 0.1);
    ASSERT_FALSE(contacts.manifolds.empty());
    EXPECT_NEAR(contacts.smallestGap, gap, 1e-6);
    for (const Manifold& m : contacts.manifolds) {
      if (m.points[0].gap < gap + 1e-3) {
        EXPECT_NEAR(m.normal.y, -1, 1e-6);
      }
    }
  }
}

/// Tiles of 1 m side by side, of which every second one is higher by `step`.
void layTiles(RigidWorld& world, double step) {
  for (int k = 0; k < 30; ++k)
    world.add(solidAt(solidShape(BoxShape{{1, 1}}), {0.5 + k, 0.5 + (k % 2 == 1 ? step : 0.0)}));
}

TEST(RigidSeams, SolidsThatLieFlushHaveNoSteps) {
  // Truth: without friction it slides on as fast as it came, at its height, not turned; at any step.
  for (const bool isBox : {true, false})
    for (const double speed : {0.5, 1.0, 4.0, 10.0})
      for (const int steps : {30, 60, 240}) {
        RigidWorld world(closedBox(30, 10), {0, -10});
        layTiles(world, 0);
        BodyDef def =
            bodyAt(bodyShape(isBox ? Shape(BoxShape{{0.5, 0.5}}) : Shape(CircleShape{0.25})), {2, 1.25});
        def.velocity = {speed, 0};
        const int body = world.add(def);
        for (int k = 0; k < 2 * steps; ++k) world.system.step(1.0 / steps);
        EXPECT_NEAR(world.at(body).x, 2 + 2 * speed, 1e-6) << isBox << " " << speed << " " << steps;
        EXPECT_NEAR(world.at(body).y, 1.25, 1e-5) << isBox << " " << speed << " " << steps;
        EXPECT_NEAR(world.system.angleRad(body), 0, 1e-6) << isBox << " " << speed << " " << steps;
      }
}

TEST(RigidSeams, ALowStepIsAStep) {
  // Truth: a box of 0.5 m at 1 m/s does not get over a step of 1 cm: the hit below its centre takes its
  // speed.
  RigidWorld world(closedBox(30, 10), {0, -10});
  layTiles(world, 0.01);
  BodyDef def = bodyAt(bodyShape(BoxShape{{0.5, 0.5}}), {2.5, 1.25});
  def.velocity = {1, 0};
  const int body = world.add(def);
  world.seconds(3);
  EXPECT_LT(world.at(body).x, 2.8);
}

}  // namespace
}  // namespace smokebox
