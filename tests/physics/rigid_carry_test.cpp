// What walls and solids that move do to bodies, periodic and open sides, and what is changed between steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/rigid_cases.h"
#include "support/rigid_world.h"

namespace smokebox::test {
namespace {

const auto kDisk = bodyShape(CircleShape{0.5});
const auto kBox = bodyShape(BoxShape{{1, 1}});
constexpr double kG = 10;

BodyDef rough(const std::shared_ptr<const BodyShape>& shape, Vec2 position, double mu = 0.5) {
  BodyDef def = bodyAt(shape, position);
  def.friction = mu;
  return def;
}

TEST(RigidCarry, AMovingWallTakesABlockAlong) {
  // Truth: a block put on a floor that runs at 2 m/s speeds up by mu g until it goes with it, after 0.4 s and
  // 0.4 m; then it stays with it.
  RigidWalls walls = closedBox(100, 20, 0, 0.5);
  walls.speeds[2] = 2;
  RigidWorld world(walls, {0, -kG});
  const int body = world.add(rough(kBox, {20, 0.5}));
  world.steps(12);
  EXPECT_NEAR(world.velocity(body).x, 0.5 * kG * 12 * RigidWorld::kStep, 1e-3);
  world.steps(48);
  EXPECT_NEAR(world.velocity(body).x, 2, 1e-9);
  EXPECT_NEAR(world.at(body).x, 20 + 2 * 1 - 0.4, 2e-3);
  EXPECT_NEAR(world.at(body).y, 0.5, 1e-5);
}

TEST(RigidCarry, AScriptedSolidTakesABlockAlong) {
  // Truth: a slab that sets off at 1 m/s^2 (less than mu g) carries the block on it; at 8 m/s^2 the block
  // slips and has mu g t.
  for (const double a : {1.0, 8.0}) {
    RigidWorld world(noWalls(), {0, -kG});
    BodyDef slab = solidAt(solidShape(BoxShape{{30, 1}}), {30, 49.5});
    slab.friction = 0.5;
    const int plate = world.add(slab), body = world.add(rough(kBox, {30, 50.5}));
    world.steps(10);
    const double before = world.at(body).x;
    for (int k = 1; k <= 60; ++k) {
      const double t = k * RigidWorld::kStep;
      world.system.moveTo(plate, {30 + 0.5 * a * t * t, 49.5}, 0);
      world.steps(1);
    }
    const double want = std::min(a, 0.5 * kG);
    // The slab moves in steps of constant velocity: half a step of it is the difference.
    EXPECT_NEAR(world.velocity(body).x, want, 0.6 * a * RigidWorld::kStep + 1e-3) << a;
    EXPECT_NEAR(world.at(body).x - before, 0.5 * want, 0.02 * want) << a;
    EXPECT_NEAR(world.at(body).y, 50.5, 1e-4) << a;
  }
}

TEST(RigidCarry, ALiftCarriesWhatStandsOnIt) {
  // Truth: a platform that goes up at 3 m/s and stops lets the block fly on 0.45 m; it stays with it on the
  // way down at 0.5 m/s.
  RigidWorld world(noWalls(), {0, -kG});
  const int plate = world.add(solidAt(solidShape(BoxShape{{4, 1}}), {50, 49.5}));
  const int body = world.add(rough(kBox, {50, 50.5}));
  double y = 49.5, top = 0;
  for (int k = 0; k < 60; ++k)
    world.system.moveTo(plate, {50, y += 3 * RigidWorld::kStep}, 0), world.steps(1);
  EXPECT_NEAR(world.velocity(body).y, 3, 1e-6);
  EXPECT_NEAR(world.at(body).y - y, 1, 1e-4);
  for (int k = 0; k < 60; ++k) world.steps(1), top = std::max(top, world.at(body).y - y - 1);
  EXPECT_NEAR(top, 0.45, 3 * RigidWorld::kStep * RigidWorld::kStep * kG);
  for (int k = 0; k < 60; ++k)
    world.system.moveTo(plate, {50, y -= 0.5 * RigidWorld::kStep}, 0), world.steps(1);
  EXPECT_NEAR(world.velocity(body).y, -0.5, 1e-6);
  EXPECT_NEAR(world.at(body).y - y, 1, 1e-4);
}

TEST(RigidCarry, ATurningWheelSpinsADiskThatRestsOnIt) {
  // Truth: a held wheel of radius 1 that turns at w brings the disk of radius 0.5 on it, kept above it by two
  // smooth posts, to roll on it: spin -2 w.
  RigidWorld world(noWalls(), {0, -kG});
  BodyDef wheel = solidAt(solidShape(CircleShape{1}), {50, 50});
  wheel.friction = 0.5;
  const int turning = world.add(wheel);
  for (const double side : {-1.0, 1.0})
    world.add(solidAt(solidShape(BoxShape{{0.1, 1}}), {50 + side * 0.551, 51.6}));
  const int body = world.add(rough(kDisk, {50, 51.5}));
  for (int k = 1; k <= 180; ++k) {
    world.system.moveTo(turning, {50, 50}, 3 * k * RigidWorld::kStep);
    world.steps(1);
  }
  EXPECT_NEAR(world.spin(body), -6, 0.01);
}

TEST(RigidCarry, ADiskDroppedOnATurningDiskTakesItsShareOfSpin) {
  // Truth: two free disks whose rims meet head-on, one turning, grip: sticking, the slip w R stops, and each
  // gets J = w R / (1/m + 1/M + R^2/I + R^2/I') across.
  for (const double mass : {0.5, 1.0, 4.0}) {
    RigidWorld world;
    BodyDef one = rough(kDisk, {49, 50}, 5), two = bodyAt(kDisk, {50.2, 50}, mass);
    one.velocity.x = 3, one.spin = 2, one.bounce = 0.5;
    two.friction = 5;
    const int a = world.add(one), b = world.add(two);
    world.steps(12);
    const double j = 1 / ((1 / one.mass + 1 / mass) * 3);  // R^2/I = 2/m; slip 1 m/s
    EXPECT_NEAR(std::abs(world.velocity(b).y), j / mass, 1e-6) << mass;
    EXPECT_NEAR(std::abs(world.velocity(a).y), j / one.mass, 1e-6) << mass;
    EXPECT_NEAR(world.spin(a), 2 - j * 0.5 / one.inertia, 1e-6) << mass;
    EXPECT_NEAR(world.spin(b), -j * 0.5 / two.inertia, 1e-6) << mass;
  }
}

TEST(RigidCarry, APairThatMeetsAcrossTheSeamMovesAsInTheMiddle) {
  // Truth: with periodic sides nothing depends on where they are: shifted by half the width, and by a whole
  // number of widths back, two polygons move the same.
  Dice dice(11);
  for (int k = 0; k < 20; ++k) {
    const auto first = randomPolygon(dice, k % 2 == 0), second = randomPolygon(dice, k % 3 == 0);
    Vec2 at[2][2], v[2][2];
    double w[2][2];
    for (const int half : {0, 1}) {
      RigidWorld world(wallsOf(RigidWalls::Kind::periodic, 16, 16));
      BodyDef one = bodyAt(first, {7 + 8.0 * half, 8 + 8.0 * half}),
              two = bodyAt(second, {9 + 8.0 * half, 8 + 8.0 * half});
      one.velocity = {3, 0.5}, two.velocity = {-3, 0.25};
      one.spin = 2, two.spin = -1;
      one.bounce = k % 4 * 0.25, one.friction = two.friction = 0.3;
      const int a = world.add(one), b = world.add(two);
      world.steps(90);
      const int bodies[2] = {a, b};
      for (int q = 0; q < 2; ++q) {
        at[half][q] = world.at(bodies[q]) - 8.0 * half * Vec2{1, 1};
        v[half][q] = world.velocity(bodies[q]);
        w[half][q] = world.spin(bodies[q]);
      }
    }
    for (int q = 0; q < 2; ++q) {
      const Vec2 by = at[1][q] - at[0][q];
      EXPECT_LT(std::abs(by.x - 16 * std::round(by.x / 16)), 1e-9) << k;
      EXPECT_LT(std::abs(by.y - 16 * std::round(by.y / 16)), 1e-9) << k;
      EXPECT_LT(length(v[1][q] - v[0][q]), 1e-9) << k;
      EXPECT_LT(std::abs(w[1][q] - w[0][q]), 1e-9) << k;
      EXPECT_GT(length(v[0][q] - Vec2{q == 0 ? 3.0 : -3.0, q == 0 ? 0.5 : 0.25}), 0.1) << k;
    }
  }
}

TEST(RigidCarry, AnOpenSideReportsADepartureOnce) {
  // Truth: each body that leaves is named once, when its last part is outside.
  RigidWorld world(wallsOf(RigidWalls::Kind::open, 10, 10), {0, -kG});
  const int a = world.add(bodyAt(kDisk, {5, 3})), b = world.add(bodyAt(kBox, {8, 6}));
  std::vector<int> order;
  for (int k = 0; k < 240; ++k) {
    world.steps(1);
    for (const int body : world.system.takeDeparted()) {
      order.push_back(body);
      EXPECT_LT(world.at(body).y, -0.5);
      EXPECT_GT(world.at(body).y, -0.5 - 0.25 - RigidWorld::kStep * 15);
    }
  }
  EXPECT_EQ(order, (std::vector<int>{a, b}));
}

TEST(RigidCarry, WhatStoodOnARemovedBodyFalls) {
  // Truth: with the lowest of five boxes gone the four above fall by its height and stand again.
  RigidWorld world(closedBox(20, 20, 0, 0.5), {0, -kG});
  std::vector<int> boxes;
  for (int k = 0; k < 5; ++k) boxes.push_back(world.add(rough(kBox, {10, 0.5 + k})));
  world.seconds(1);
  world.system.remove(boxes[0]);
  EXPECT_FALSE(world.system.isThere(boxes[0]));
  world.steps(12);  // 0.2 s
  EXPECT_NEAR(world.velocity(boxes[1]).y, -2, 0.02);
  world.seconds(3);
  for (int k = 1; k < 5; ++k) EXPECT_NEAR(world.at(boxes[k]).y, k - 0.5, 1e-3) << k;
  EXPECT_LT(world.system.totals().kineticEnergy, 1e-6);
}

TEST(RigidCarry, AHeldBodyStaysUntilItIsReleased) {
  // Truth: held, it moves by nothing, not even under what falls on it; released, it goes on with its
  // velocity.
  RigidWorld world(closedBox(40, 40), {0, -kG});
  BodyDef def = bodyAt(kBox, {10, 10});
  def.held = true;
  def.velocity = {1.5, 0};
  const int body = world.add(def), other = world.add(rough(kBox, {10, 12}));
  world.seconds(2);
  EXPECT_EQ(world.at(body), (Vec2{10, 10}));
  EXPECT_NEAR(world.at(other).y, 11, 1e-3);
  world.system.remove(other);
  world.system.release(body);
  world.steps(30);
  EXPECT_NEAR(world.at(body).x, 10 + 0.75, 1e-9);
  EXPECT_NEAR(world.at(body).y, 10 - 0.5 * kG * 0.25, 1e-9);
  world.system.hold(body);
  const Vec2 there = world.at(body);
  world.seconds(1);
  EXPECT_EQ(world.at(body), there);
}

TEST(RigidCarry, BodiesOfOneGroupPassThroughEachOther) {
  // Truth: with a bit in common they fly on untouched, at any speed; without, they do not.
  for (const bool common : {true, false})
    for (const double speed : {3.0, 300.0}) {
      RigidWorld world;
      BodyDef one = bodyAt(kBox, {48, 50}), two = bodyAt(kBox, {50, 50});
      one.velocity.x = speed;
      one.ignore = 6, two.ignore = common ? 4 : 8;
      const int a = world.add(one), b = world.add(two);
      world.steps(60);
      EXPECT_EQ(world.velocity(b).x == 0, common) << speed;
      EXPECT_EQ(world.velocity(a).x == speed, common) << speed;
      EXPECT_EQ(world.at(a).x > world.at(b).x, common) << speed;
    }
}

}  // namespace
}  // namespace smokebox::test
