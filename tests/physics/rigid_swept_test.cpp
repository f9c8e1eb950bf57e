// Thin solids that a script moves sweep up what they meet: nothing gets to their other side.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/rigid_cases.h"

namespace smokebox::test {
namespace {

const std::vector<std::shared_ptr<const BodyShape>>& shapes() {
  static const std::vector<std::shared_ptr<const BodyShape>> all = {
      bodyShape(CircleShape{0.03}), bodyShape(BoxShape{{0.06, 0.06}}), bodyShape(BoxShape{{0.4, 0.01}}),
      bodyShape(CapsuleShape{0.1, 0.005}),
      bodyShape(PolygonShape{{{-0.05, -0.03}, {0.05, -0.03}, {0.06, 0.02}, {-0.02, 0.04}}})};
  return all;
}

constexpr int kCases = 3000;
const BoxShape kPlate{{0.02, 8}};

TEST(RigidSwept, AThinWallThatMovesLetsNothingThrough) {
  // Truth: a plate of 2 cm that goes at 1 to 50 m/s drives before it what it meets at 0 to 2000 m/s, whatever
  // its shape, angle, spin, bounce and friction.
  for (int k = 0; k < kCases; ++k) {
    Dice dice(k);
    const double speed = std::vector<double>{0, 5, 30, 200, 400, 2000}[k % 6];
    const double ofWall = -std::vector<double>{1, 5, 20, 50}[k / 3 % 4];
    RigidWorld world;
    BodyDef plate = solidAt(solidShape(kPlate), {50, 50});
    plate.friction = k % 2 * 0.5;
    const int wall = world.add(plate);
    BodyDef def = bodyAt(shapes()[k % 5], {49.7 - dice.between(0, 1) * (speed - ofWall) / 60, 50});
    def.position.y += dice.between(-0.5, 0.5);
    def.angleRad = dice.between(-1.6, 1.6);
    def.velocity.x = speed;
    def.spin = k % 4 == 0 ? dice.between(-100, 100) : 0;
    def.bounce = 0.5 * (k % 3);
    def.friction = plate.friction;
    const int body = world.add(def);
    for (int step = 1; step <= 20; ++step) {
      world.system.moveTo(wall, {50 + ofWall * step * RigidWorld::kStep, 50}, 0);
      world.steps(1);
      if (std::abs(world.at(body).y - 50) > 3.5) break;
      ASSERT_LT(world.at(body).x, world.at(wall).x) << "case " << k << ", step " << step;
    }
  }
}

TEST(RigidSwept, AThinPaddleLetsNothingThrough) {
  // Truth: on a bar of 2 cm that turns by up to 50 rad/s (its ends at 200 m/s) a body stays on its side until
  // it is past the end.
  for (int k = 0; k < kCases; ++k) {
    Dice dice(k);
    const double spin = dice.between(-1, 1) * std::vector<double>{3, 12, 50}[k % 3];
    RigidWorld world;
    BodyDef plate = solidAt(solidShape(kPlate), {50, 50});
    plate.friction = 0.5;
    const int paddle = world.add(plate);
    const double side = k % 2 ? 1 : -1;
    BodyDef def =
        bodyAt(shapes()[k % 5], Vec2{50, 50} + Vec2{side * dice.between(0.3, 2), dice.between(-2.5, 2.5)});
    def.angleRad = dice.between(-3, 3);
    def.velocity = {dice.between(-1, 1) * (k % 7 == 0 ? 400 : 20), dice.between(-10, 10)};
    def.bounce = 0.5 * (k / 3 % 3);
    def.friction = 0.5;
    const int body = world.add(def);
    for (int step = 1; step <= 60; ++step) {
      world.system.moveTo(paddle, {50, 50}, spin * step * RigidWorld::kStep);
      world.steps(1);
      const Frame frame{world.at(paddle), turnBy(world.system.angleRad(paddle))};
      const Vec2 there = toLocal(frame, world.at(body));
      if (std::abs(there.y) > 3.6 || length(there) > 8) break;
      ASSERT_GT(there.x * side, 0) << "case " << k << ", step " << step;
    }
  }
}

TEST(RigidSwept, WhatTurnsAboutItsCornerLandsOnItsEdge) {
  // Truth: a box that hangs with one corner over another's, and turns about it, lands on the other one's face
  // with its far end: nothing goes in, though only the two corners were close as the step began.
  constexpr double kTilt = 0.04, kLean = 0.02, kApart = 0.01;
  const Vec2 half{0.5, 0.2};
  for (const double spin : {2.0, 3.0, 4.0, 5.0}) {
    RigidWorld world;
    world.add(solidAt(solidShape(BoxShape{2 * half}), Vec2{50, 50} - half));
    const Vec2 corner = Vec2{50, 50} + kApart * Vec2{std::sin(kLean), std::cos(kLean)};
    const Vec2 arm = rotate(turnBy(-kTilt), {half.x, -half.y});
    BodyDef def = bodyAt(bodyShape(BoxShape{2 * half}), corner - arm);
    def.angleRad = -kTilt;
    def.spin = spin;
    def.velocity = {spin * arm.y, -spin * arm.x};
    const int body = world.add(def);
    for (int step = 0; step < 4; ++step) {
      world.steps(1);
      const Turn turn = turnBy(world.system.angleRad(body));
      for (const double x : {-half.x, half.x})
        EXPECT_GT((world.at(body) + rotate(turn, {x, -half.y})).y, 50 - 1e-3) << "spin " << spin;
    }
  }
}

TEST(RigidSwept, WhatIsStruckWhileItFliesPastIsStoppedAtOnce) {
  // Truth: a block that skims a plate at 60 m/s, a millimetre above it, is struck from above at 20 m/s: it
  // slides on along the plate. By its way alone it would not have met that within the sub-step.
  for (int k = 0; k < 50; ++k) {
    Dice dice(k);
    RigidWorld world;
    world.add(solidAt(solidShape(BoxShape{{80, 0.04}}), {50, 50}));
    const double above = 50.02 + 1e-3;
    BodyDef skims = bodyAt(bodyShape(BoxShape{{0.3, 0.2}}), {30, above + 0.1}, 1);
    skims.velocity = {60, 0};
    const int block = world.add(skims);
    BodyDef strikes = bodyAt(bodyShape(CircleShape{0.1}), {30, above + 0.3 + dice.between(0.01, 0.5)}, 1);
    strikes.velocity = {60, -20};
    world.add(strikes);
    double deepest = 0;
    for (int step = 0; step < 10; ++step) {
      world.steps(1);
      deepest = std::max(deepest, world.system.totals().overlap);
      ASSERT_GT(world.at(block).y, 50.1) << "case " << k << ", step " << step;
    }
    EXPECT_LT(deepest, 1e-3) << "case " << k;
  }
}

TEST(RigidSwept, WhatIsStruckAsItTumblesOverAnEdgeIsStopped) {
  // Truth: a star that tumbles onto the edge of a table, struck from above at 27 m/s, goes into neither: its
  // arms pass the edge's corner by themselves, but not what the blow makes of their way. What is left is the
  // turn of faces at 80 rad/s within a sub-step.
  for (int k = 0; k < 600; ++k) {
    Dice dice(k);
    RigidWorld world;
    world.add(solidAt(solidShape(BoxShape{{2, 2}}), {49, 49}));
    const double angle = dice.between(-0.6, 0.6), spin = dice.between(-40, -20);
    PolygonShape outline;
    const int corners = 2 * (3 + k % 3);
    for (int q = 0; q < corners; ++q)
      outline.points.push_back(rotate(turnBy(2 * kPi * q / corners), {q % 2 ? 0.135 : 0.3, 0}));
    BodyDef star = bodyAt(bodyShape(outline), {50 + dice.between(-0.25, 0.25), 50.35}, 1);
    star.angleRad = angle;
    star.spin = spin;
    star.velocity = {dice.between(-2, 2), -8};
    world.add(star);
    BodyDef strikes = bodyAt(bodyShape(BoxShape{{0.5, 0.5}}),
                             {50 + dice.between(-0.3, 0.3), 50.95 + dice.between(0, 0.5)}, 1);
    strikes.velocity = {0, -35};
    strikes.angleRad = dice.between(-1, 1);
    world.add(strikes);
    for (int step = 0; step < 12; ++step) {
      world.steps(1);
      ASSERT_LT(world.system.totals().overlap, 0.01) << "case " << k << ", step " << step;
    }
  }
}

}  // namespace
}  // namespace smokebox::test
