// Bodies on joints: blows that go through the joints, and joints that no motion can satisfy.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/rigid_world.h"

namespace smokebox {
namespace {

using test::bodyAt;
using test::bodyShape;
using test::closedBox;
using test::RigidWorld;
using test::solidAt;
using test::solidShape;

int pin(RigidWorld& world, int a, Vec2 atA, int b, Vec2 atB) {
  JointDef def;
  def.kind = JointKind::pin;
  def.a = {a, atA};
  def.b = {b, atB};
  return world.system.addJoint(def);
}

int weld(RigidWorld& world, int a, Vec2 atA, int b, Vec2 atB) {
  JointDef def;
  def.kind = JointKind::weld;
  def.a = {a, atA};
  def.b = {b, atB};
  return world.system.addJoint(def);
}

double energyOf(const RigidWorld& world) {
  return world.system.totals().kineticEnergy + world.system.totals().potentialEnergy;
}

BodyDef bouncing(BodyDef def) {
  def.bounce = 1;
  return def;
}

TEST(RigidTied, ABlowMovesAllThatHangsTogether) {
  // Truth: two welded boxes of 1 kg struck off the centre have the impulse as momentum, and its moment.
  RigidWorld world;
  const auto box = bodyShape(BoxShape{{1, 1}});
  const int a = world.add(bodyAt(box, {4, 5}, 1)), b = world.add(bodyAt(box, {5, 5}, 1));
  weld(world, a, {0.5, 0}, b, {-0.5, 0});
  world.steps(10);
  world.system.applyImpulse(b, {9, 5}, {0, 3});
  world.steps(30);
  EXPECT_NEAR(world.velocity(a).y + world.velocity(b).y, 3, 1e-9);
  EXPECT_NEAR(world.spin(a), 3 * 4.5 / (2 * (1.0 / 6 + 0.25)), 0.001 * 16);
}

TEST(RigidTied, ABarGoesOnAboutItsPinAsFastAsItsMomentSays) {
  // Truth: of a spin w about the centre the moment about the pin keeps I w; I_pin = I + m d^2.
  RigidWorld world;
  const int bar = world.add([&] {
    BodyDef def = bodyAt(bodyShape(BoxShape{{4, 0.2}}), {52, 50}, 1);
    def.spin = 4 * kPi;
    return def;
  }());
  pin(world, -1, {50, 50}, bar, {-2, 0});
  world.steps(60);
  const double inertia = (16 + 0.04) / 12;
  EXPECT_NEAR(world.spin(bar), 4 * kPi * inertia / (inertia + 4), 1e-3);
}

TEST(RigidTied, AJointElsewhereChangesNothing) {
  // Truth: a bat strikes a ball the same whether or not something hangs on a pin far away.
  Vec2 left[2];
  for (const bool pinned : {false, true}) {
    RigidWorld world;
    BodyDef bat = bodyAt(bodyShape(BoxShape{{4, 0.2}}), {50, 50}, 10);
    bat.spin = 4 * kPi;
    world.add(bat);
    const int ball = world.add(bodyAt(bodyShape(CircleShape{0.2}), {51.8, 50.35}, 1));
    const int other = world.add(bodyAt(bodyShape(CircleShape{0.1}), {10, 10}, 1));
    if (pinned) pin(world, -1, {10, 10}, other, {});
    world.steps(15);
    left[pinned] = world.velocity(ball);
  }
  EXPECT_GT(left[0].y, 15);
  EXPECT_NEAR(left[1].x, left[0].x, 1e-9);
  EXPECT_NEAR(left[1].y, left[0].y, 1e-9);
}

TEST(RigidTied, APinnedBarBouncesBackAsItCame) {
  // Truth: bounce is on the speed of the point that strikes, whatever the pin does meanwhile.
  for (const double bounce : {1.0, 0.5}) {
    RigidWorld world;
    const int bar = world.add([&] {
      BodyDef def = bodyAt(bodyShape(BoxShape{{1, 0.1}}), {50.5, 50}, 1);
      def.bounce = bounce;
      def.spin = kPi / 2;
      def.velocity = {0, kPi / 4};
      return def;
    }());
    world.add(solidAt(solidShape(CircleShape{0.1}), {50.5, 50.9}));
    pin(world, -1, {50, 50}, bar, {-0.5, 0});
    world.seconds(2);
    EXPECT_NEAR(world.spin(bar), -bounce * kPi / 2, 1e-3) << bounce;
  }
}

TEST(RigidTied, ABallThatHitsAPinnedRodLeavesAsTheirMomentsSay) {
  // Truth: 1 kg at 10 m/s, 0.8 m below the pin of a rod of 1 by 0.1 m: with I about the pin and r = 0.8,
  // it keeps (r^2 - I) / (r^2 + I) of its speed, and the rod turns with 2 r v / (r^2 + I).
  RigidWorld world;
  BodyDef ball = bouncing(bodyAt(bodyShape(CircleShape{0.1}), {48.5, 50.2}, 1));
  ball.velocity = {10, 0};
  const int struck = world.add(ball);
  const int rod = world.add(bouncing(bodyAt(bodyShape(BoxShape{{0.1, 1}}), {50, 50.5}, 1)));
  pin(world, -1, {50, 51}, rod, {0, 0.5});
  world.steps(12);
  const double inertia = (1 + 0.01) / 12 + 0.25, r = 0.8, sum = r * r + inertia;
  EXPECT_NEAR(world.velocity(struck).x, 10 * (r * r - inertia) / sum, 0.01);
  EXPECT_NEAR(world.spin(rod), 2 * r * 10 / sum, 0.02);
}

TEST(RigidTied, WeldedBodiesBounceAsOneWould) {
  // Truth: bounce 1 and no friction keep the energy, through a tilted weld and through a chain of pins.
  RigidWorld world(closedBox(10, 10), {0, -10});
  const auto disk = bodyShape(CircleShape{0.5});
  const int a = world.add(bouncing(bodyAt(disk, {4.6, 3}, 1))),
            b = world.add(bouncing(bodyAt(disk, {5.4, 3.9}, 1)));
  weld(world, a, {0.4, 0.45}, b, {-0.4, -0.45});
  const double before = energyOf(world);
  double worst = 0;
  for (int step = 0; step < 360; ++step) {
    world.steps(1);
    worst = std::max(worst, std::fabs(energyOf(world) - before));
  }
  std::printf("weld of two disks that bounces for 6 s: energy off by %.1e of it\n", worst / before);
  EXPECT_LT(worst, 2e-3 * before);
}

TEST(RigidTied, AChainOfPinsBouncesOnAPost) {
  // Truth: as above; a chain of twelve that folds over a post loses and gains little.
  RigidWorld world(closedBox(10, 10), {0, -10});
  std::vector<int> links;
  for (int k = 0; k < 12; ++k)
    links.push_back(world.add(bouncing(bodyAt(bodyShape(CapsuleShape{0.4, 0.05}), {2.25 + 0.5 * k, 5}))));
  for (int k = 0; k < 11; ++k) pin(world, links[k], {0.25, 0}, links[k + 1], {-0.25, 0});
  world.add(solidAt(solidShape(CircleShape{0.3}), {4.3, 2}));
  const double before = energyOf(world);
  double least = before, most = before;
  for (int step = 0; step < 360; ++step) {
    world.steps(1);
    least = std::min(least, energyOf(world)), most = std::max(most, energyOf(world));
  }
  std::printf("chain on a post: energy between %.4f and %.4f of that at the start\n", least / before,
              most / before);
  EXPECT_GT(least, 0.9 * before);
  EXPECT_LT(most, 1.03 * before);
}

TEST(RigidTied, JointsThatSayTheSameTwiceHoldWithoutStrain) {
  // Truth: a box on two rails that are one and the same goes on along them as fast as before, without a
  // force, though it was thrown across them and spinning; so does what is welded twice.
  RigidWorld world;
  const auto box = bodyShape(BoxShape{{0.4, 0.4}});
  BodyDef thrown = bodyAt(box, {5, 5}, 1);
  thrown.velocity = {1.5, 0.75};
  thrown.spin = -7;
  const int a = world.add(thrown), b = world.add(bodyAt(box, {5, 6}, 1));
  JointDef rail;
  rail.kind = JointKind::slide;
  rail.axis = {1, 0};
  for (const double x : {4.0, 7.0}) {
    rail.a = {-1, {x, 5}};
    rail.b = {a, {x - 5, 0}};
    world.system.addJoint(rail);
  }
  weld(world, a, {0, 0.5}, b, {0, -0.5});
  weld(world, a, {0.3, 0.7}, b, {0.3, -0.3});
  world.steps(120);
  EXPECT_NEAR(world.system.position(a).y, 5, 1e-9);
  EXPECT_NEAR(world.system.position(b).y, 6, 1e-9);
  EXPECT_NEAR(world.spin(a), 0, 1e-9);
  EXPECT_NEAR(world.velocity(a).x, world.velocity(b).x, 1e-9);
}

TEST(RigidTied, WhatJointsHoldAltogetherIsNotStruck) {
  // Truth: a ball bounces off a box that is welded to the world as off a wall; two such boxes that touch and
  // were thrown at each other stay where they are.
  RigidWorld world;
  const auto box = bodyShape(BoxShape{{1, 1}});
  std::vector<int> boxes;
  for (const double side : {1.0, -1.0}) {
    BodyDef def = bouncing(bodyAt(box, {20 - 0.5 * side, 20}, 1));
    def.velocity = {3 * side, 0.1};
    boxes.push_back(world.add(def));
  }
  BodyDef flying = bouncing(bodyAt(bodyShape(CircleShape{0.2}), {15, 20}, 1));
  flying.velocity = {8, 0};
  const int ball = world.add(flying);
  for (const int k : boxes) weld(world, -1, world.system.position(k), k, {});
  world.steps(60);
  EXPECT_NEAR(world.velocity(ball).x, -8, 1e-6);
  EXPECT_NEAR(world.system.position(boxes[0]).x, 19.5, 1e-6);
  EXPECT_NEAR(world.system.position(boxes[1]).x, 20.5, 1e-6);
  for (const int k : boxes) EXPECT_LT(length(world.velocity(k)), 1e-6);
}

TEST(RigidTied, AChainDrawnStraightFlingsNothing) {
  // Truth: what falls on a chain between two nails that has no slack brings all the energy there is.
  for (const int steps : {30, 60, 120, 240}) {
    RigidWorld world(closedBox(10, 10), {0, -10});
    std::vector<int> links;
    for (int k = 0; k < 12; ++k) {
      BodyDef def = bodyAt(bodyShape(BoxShape{{0.5, 0.1}}), {2.25 + 0.5 * k, 5});
      def.ignore = 1;
      links.push_back(world.add(def));
    }
    pin(world, -1, {2, 5}, links[0], {-0.25, 0});
    for (int k = 0; k < 11; ++k) pin(world, links[k], {0.25, 0}, links[k + 1], {-0.25, 0});
    pin(world, links[11], {0.25, 0}, -1, {8, 5});
    world.add(bodyAt(bodyShape(CircleShape{0.3}), {5.1, 7}, 3 * kPi * 0.09));
    const double before = energyOf(world);
    double most = before;
    for (int step = 0; step < 4 * steps; ++step) {
      world.system.step(1.0 / steps);
      most = std::max(most, energyOf(world));
    }
    EXPECT_LT(most, 1.05 * before) << steps;
  }
}

TEST(RigidTied, RopesThatPullAgainstEachOtherHoldStill) {
  // Truth: two ropes of 1 m to nails 3 m away on either side leave it where it is.
  RigidWorld world(closedBox(10, 10), {0, -10});
  const int body = world.add(bodyAt(bodyShape(BoxShape{{0.4, 0.4}}), {5, 5}, 1));
  for (const double x : {2.0, 8.0}) {
    JointDef rope;
    rope.kind = JointKind::rope;
    rope.a = {-1, {x, 5}};
    rope.b = {body, {}};
    rope.length = 1;
    world.system.addJoint(rope);
  }
  double farthest = 0;
  for (int step = 0; step < 300; ++step) {
    world.steps(1);
    farthest = std::max(farthest, length(world.at(body) - Vec2{5, 5}));
  }
  EXPECT_LT(farthest, 0.05);
}

TEST(RigidTied, PeriodicSidesDoNotTearWhatHangsTogether) {
  // Truth: two that drift at 1 m/s go on at 1 m/s, whichever of them has come in again at the other side.
  for (const int kind : {0, 1, 2}) {
    RigidWalls walls = closedBox(10, 10);
    walls.sides[0] = walls.sides[1] = RigidWalls::Kind::periodic;
    RigidWorld world(walls);
    int pair[2];
    for (int k = 0; k < 2; ++k) {
      BodyDef def = bodyAt(bodyShape(CircleShape{0.2}), {8.0 + k, 5}, 1);
      def.velocity = {1, 0};
      pair[k] = world.add(def);
    }
    if (kind == 0) {
      SpringDef spring;
      spring.from.body = pair[0], spring.to.body = pair[1];
      spring.length = 1, spring.stiffness = 100;
      world.system.addSpring(spring);
    } else if (kind == 1) {
      weld(world, pair[0], {0.5, 0}, pair[1], {-0.5, 0});
    } else {
      JointDef rope;
      rope.kind = JointKind::rope;
      rope.a.body = pair[0], rope.b.body = pair[1];
      rope.length = 1;
      world.system.addJoint(rope);
    }
    world.seconds(13);
    for (const int body : pair) EXPECT_NEAR(world.velocity(body).x, 1, 1e-9) << kind;
    EXPECT_NEAR(world.at(pair[0]).x, 1, 1e-9) << kind;
    EXPECT_NEAR(energyOf(world), 1, 1e-9) << kind;
  }
}

TEST(RigidTied, APullGoesToTheImageThatItIsGiven) {
  // Truth: a body that has gone round once is drawn to a point that is 1 m from it, not 9 m or 11 m.
  RigidWalls walls = closedBox(10, 10);
  walls.sides[0] = walls.sides[1] = RigidWalls::Kind::periodic;
  RigidWorld world(walls);
  BodyDef def = bodyAt(bodyShape(CircleShape{0.2}), {8, 5}, 1);
  def.velocity = {4, 0};
  const int body = world.add(def);
  world.seconds(1);
  ASSERT_NEAR(world.at(body).x, 2, 1e-9);
  world.system.setVelocity(body, {});
  SpringDef pull;
  pull.from.body = body;
  pull.to.at = {3, 5};
  pull.stiffness = 10, pull.damping = 6;
  const int spring = world.system.addSpring(pull);
  world.system.moveSpringEnd(spring, {3, 5});
  EXPECT_NEAR(world.system.springTension(spring), 0, 1e-9);
  world.seconds(5);
  EXPECT_NEAR(world.at(body).x, 3, 1e-3);
}

TEST(RigidTied, WhatComesBackHasNotLeft) {
  // Truth: thrown up at 20 m/s through an open top, under 10 m/s^2, it is back after 4 s; what hangs on a
  // rope swings back in; what flies off sideways has left.
  RigidWorld world(test::wallsOf(RigidWalls::Kind::open, 10, 10), {0, -10});
  BodyDef def = bodyAt(bodyShape(CircleShape{0.1}), {5, 5});
  def.velocity = {0, 20};
  const int thrown = world.add(def);
  const int hung = world.add(bodyAt(bodyShape(CircleShape{0.1}), {9.5, 3}));
  world.system.setVelocity(hung, {4, 0});
  JointDef rope;
  rope.kind = JointKind::rope;
  rope.a.at = {9.5, 5};
  rope.b.body = hung;
  rope.length = 2;
  world.system.addJoint(rope);
  def.position = {8, 8}, def.velocity = {20, 0};
  const int lost = world.add(def);
  std::vector<int> gone;
  double farthest = 0;
  for (int step = 0; step < 240; ++step) {
    world.steps(1);
    for (const int body : world.system.takeDeparted()) gone.push_back(body);
    farthest = std::max(farthest, world.at(hung).x);
  }
  EXPECT_EQ(gone, std::vector<int>{lost});
  EXPECT_GT(farthest, 10.5);
  EXPECT_NEAR(world.at(thrown).y, 5, 1e-6);
}

}  // namespace
}  // namespace smokebox
