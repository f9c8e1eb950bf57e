// The kinds of joint: limits, motors, slides, contradictions, spins.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "base/maths.h"
#include "support/links_world.h"

namespace smokebox {
namespace {

using test::LinksWorld;

constexpr double kGravity = 9.81;

TEST(RigidJoint, AMotorReachesItsSpeedAndStallsAtItsTorque) {
  // Truth: against inertia alone it accelerates by limit / I up to its speed, to the last sub-step; a
  // pendulum is lifted only to where gravity's moment is the limit: m g d sin(angle) = limit.
  LinksWorld free;
  const int rod = free.rod({0, -0.5}, 1, 1);
  JointDef def;
  def.a = {-1, {0, 0}}, def.b = {rod, {0, 0.5}};
  def.motorSpeed = 5, def.motorLimit = 2;
  free.joints.add(def, free.bodies);
  for (int k = 1; k <= 60; ++k) {
    free.step(1.0 / 60, 16);
    // About the end: I = 1/3. The chord of a turn by w h is shorter than its arc by (w h)^2 / 24.
    EXPECT_NEAR(free.bodies.velocity[rod].turn, std::min(5.0, 6 * k / 60.0), 3e-5);
  }
  LinksWorld lifted;
  lifted.gravity = {0, -kGravity};
  lifted.drag = 1;
  lifted.rod({0, -0.5}, 1, 1);
  lifted.joints.add(def, lifted.bodies);
  for (int k = 0; k < 1200; ++k) lifted.step(1.0 / 60, 16);
  const double stall = std::asin(2 / (kGravity * 0.5));
  EXPECT_NEAR(lifted.bodies.angleRad[0], stall, 1e-4);
  EXPECT_NEAR(lifted.joints.torque(0), 2, 1e-9);
}

TEST(RigidJoint, LimitsHold) {
  // Truth: a rod that falls on its limit stays there; the limit holds m g d cos(angle) and nothing is passed.
  LinksWorld world;
  world.gravity = {0, -kGravity};
  const int rod = world.rod({0.5, 0}, 1, 1, kPi / 2);
  JointDef def;
  def.a = {-1, {0, 0}}, def.b = {rod, {0, 0.5}};
  def.lower = -0.5, def.upper = 0.3;
  const int joint = world.joints.add(def, world.bodies);
  double lowest = 0;
  for (int k = 0; k < 120; ++k) {
    world.step(1.0 / 60, 16);
    lowest = std::min(lowest, world.bodies.angleRad[rod] - kPi / 2);
  }
  EXPECT_NEAR(lowest, -0.5, 1e-12);
  EXPECT_NEAR(world.joints.torque(joint), kGravity * 0.5 * std::cos(0.5), 1e-6);
  // Thrown up it leaves the lower limit and meets the upper one.
  world.bodies.velocity[rod] = {0, 0, 20, 0};
  double highest = -1;
  for (int k = 0; k < 60; ++k) {
    world.step(1.0 / 60, 16);
    highest = std::max(highest, world.bodies.angleRad[rod] - kPi / 2);
  }
  EXPECT_NEAR(highest, 0.3, 1e-4);  // at the ends of steps
  EXPECT_LT(highest, 0.3 + 1e-12);
}

TEST(RigidJoint, ASlideLetsThroughOnlyItsAxis) {
  // Truth: a block on a slope of 30 degrees accelerates by g sin 30, stays on its line and does not turn; at
  // the end of its way it stops, and its motor carries it back at its speed.
  LinksWorld world;
  world.gravity = {0, -kGravity};
  const int block = world.add({0, 0}, 2, 0.1);
  const Vec2 axis{std::cos(kPi / 6), -std::sin(kPi / 6)};
  JointDef def;
  def.kind = JointKind::slide;
  def.a = {-1, {0, 0}}, def.b = {block, {0, 0.1}};
  def.a.at = {0, 0.1};
  def.axis = axis;
  def.upper = 1;
  const int joint = world.joints.add(def, world.bodies);
  const int steps = 30;
  for (int k = 0; k < steps; ++k) world.step(1.0 / 60, 16);
  const double along = dot(world.bodies.position[block], axis), seconds = steps / 60.0;
  EXPECT_NEAR(along, 0.5 * 0.5 * kGravity * seconds * (seconds + 1.0 / 960), 1e-9);
  EXPECT_NEAR(cross(axis, world.bodies.position[block]), 0, 1e-12);
  EXPECT_NEAR(world.bodies.angleRad[block], 0, 1e-12);
  for (int k = 0; k < 60; ++k) world.step(1.0 / 60, 16);
  EXPECT_NEAR(dot(world.bodies.position[block], axis), 1, 1e-11);
  EXPECT_NEAR(world.joints.tension(joint), 2 * kGravity, 1e-6);
  world.joints.setMotor(joint, -0.5, 20);
  for (int k = 0; k < 60; ++k) world.step(1.0 / 60, 16);
  // It takes 0.5 / 5.095 s to get there, at (20 - m g / 2) / m.
  EXPECT_NEAR(dot(world.bodies.position[block], axis), 0.5 + 0.5 * 0.25 / 5.095, 1e-3);
  EXPECT_NEAR(dot(world.bodies.velocity[block].linear(), axis), -0.5, 1e-9);
}

TEST(RigidJoint, ASlideOnABodyTurnsWithIt) {
  // Truth: a bead slides on a bar that spins freely without gravity: its angular momentum and energy stay.
  LinksWorld world;
  const int bar = world.add({0, 0}, 5, 1, {}, 2), bead = world.add({0.2, 0}, 1, 0.01, {0, 0.4}, 2);
  world.joint(JointKind::pin, {-1, {0, 0}}, {bar, {}});
  world.joint(JointKind::slide, {bar, {}}, {bead, {}});
  auto angular = [&] {
    double sum = 0;
    for (const int k : {bar, bead})
      sum += world.bodies.def[k].inertia * world.bodies.velocity[k].turn +
             world.bodies.def[k].mass * cross(world.bodies.position[k], world.bodies.velocity[k].linear());
    return sum;
  };
  world.step(1e-3);
  const double momentum = angular(), energy = world.kinetic();
  for (int k = 0; k < 2000; ++k) world.step(1e-3);
  EXPECT_NEAR(angular(), momentum, 1e-4 * momentum);
  EXPECT_NEAR(world.kinetic(), energy, 1e-3 * energy);
  EXPECT_GT(length(world.bodies.position[bead]), 1);  // it has been thrown outwards
  EXPECT_NEAR(cross(rotate(world.bodies.turn[bar], {1, 0}), world.bodies.position[bead]), 0, 1e-10);
}

TEST(RigidJoint, AFourBarLinkageIsClosedAndKeepsItsEnergy) {
  // Truth: a closed loop of pins stays closed and conserves energy while its crank turns round.
  LinksWorld world;
  const int crank = world.rod({0, 0.25}, 0.5, 1, kPi), coupler = world.rod({0.75, 0.5}, 1.5, 1, kPi / 2);
  const int rocker = world.rod({1.5, 0}, 1, 1, kPi);
  world.joint(JointKind::pin, {-1, {0, 0}}, {crank, {0, 0.25}});
  world.joint(JointKind::pin, {crank, {0, -0.25}}, {coupler, {0, 0.75}});
  world.joint(JointKind::pin, {coupler, {0, -0.75}}, {rocker, {0, -0.5}});
  const int last = world.joint(JointKind::pin, {rocker, {0, 0.5}}, {-1, {1.5, -0.5}});
  world.bodies.velocity[crank] = {-0.25 * 6, 0, 6, 0};
  world.step(1e-3);
  const double energy = world.kinetic(), from = world.bodies.angleRad[crank];
  double off = 0, gap = 0, most = 0;
  for (int k = 0; k < 10000; ++k) {
    world.step(1e-3);
    off = std::max(off, std::fabs(world.kinetic() / energy - 1));
    gap = std::max(gap, world.gap(last));
    most = std::max(most, std::fabs(world.bodies.angleRad[crank] - from));
  }
  std::printf("four bars: energy off by at most %.1e, pins by %.1e m, %.1f turns\n", off, gap,
              most / (2 * kPi));
  EXPECT_LT(off, 2e-3);
  EXPECT_LT(gap, 1e-11);
  EXPECT_GT(most, 2 * kPi);
}

TEST(RigidJoint, ContradictionsDoNotBlowUp) {
  // Truth: a body pinned to two points that are drawn apart cannot obey; it stays between them, and at rest,
  // and goes back to one of them when the other joint is gone.
  LinksWorld world;
  world.gravity = {0, -kGravity};
  const int block = world.add({0, 0}, 1, 0.1);
  const int left = world.joint(JointKind::pin, {-1, {-0.1, 0}}, {block, {}});
  world.joint(JointKind::pin, {-1, {0.1, 0}}, {block, {}});
  for (int k = 0; k < 300; ++k) {
    world.step(1.0 / 60, 16);
    ASSERT_LT(std::fabs(world.bodies.position[block].x), 0.11);
    ASSERT_LT(length(world.bodies.velocity[block].linear()), 200);
  }
  EXPECT_NEAR(world.bodies.position[block].y, 0, 0.01);
  world.joints.remove(left);
  for (int k = 0; k < 60; ++k) world.step(1.0 / 60, 16);
  EXPECT_NEAR(world.bodies.position[block].x, 0.1, 1e-9);
  EXPECT_NEAR(world.bodies.position[block].y, 0, 1e-9);
}

TEST(RigidJoint, NoSpinGainsEnergy) {
  // Truth: a rod that spins about a pin keeps its energy while the sub-step can follow (here a tenth of a
  // radian); at any spin it gains no more than the chord of its first turn has.
  for (const double spin : {96.0, 500.0, 1000.0, 3000.0, 10000.0}) {
    LinksWorld world;
    const int rod = world.rod({0.5, 0}, 1, 1, kPi / 2);
    world.bodies.velocity[rod] = {0, 0.5 * spin, spin, 0};
    const double energy = world.kinetic();
    world.joint(JointKind::pin, {-1, {0, 0}}, {rod, {0, 0.5}});
    double most = 0;
    for (int k = 0; k < 240; ++k) {
      world.step(1.0 / 60, 16);
      most = std::max(most, world.kinetic() / energy);
    }
    std::printf("spin %.0f/s: energy at the end %.4f, at most %.4f\n", spin, world.kinetic() / energy, most);
    EXPECT_LT(most, spin < 100 ? 1.01 : 1.2);
    EXPECT_GT(world.kinetic() / energy, spin < 100 ? 0.99 : 0);
  }
}

TEST(RigidJoint, FollowsBodiesThatAreHeldAndReleased) {
  // Truth: a joint between two held bodies does nothing; released, one hangs on the other.
  LinksWorld world;
  world.gravity = {0, -kGravity};
  const int upper = world.add({0, 0}, 0, 0), ball = world.add({0, -1}, 1, 0.1);
  const InverseMass mass = world.bodies.inverse[ball];
  world.bodies.inverse[ball] = {};
  const int pin = world.joint(JointKind::pin, {upper, {0, 0}}, {ball, {0, 1}});
  for (int k = 0; k < 10; ++k) world.step(1.0 / 60, 16);
  EXPECT_EQ(world.bodies.position[ball].y, -1);
  world.bodies.inverse[ball] = mass;
  for (int k = 0; k < 60; ++k) world.step(1.0 / 60, 16);
  EXPECT_NEAR(world.bodies.position[ball].y, -1, 1e-12);
  EXPECT_NEAR(world.joints.tension(pin), kGravity, 1e-6);
  world.joints.remove(pin);
  for (int k = 0; k < 6; ++k) world.step(1.0 / 60, 16);
  EXPECT_LT(world.bodies.position[ball].y, -1.04);
}

}  // namespace
}  // namespace smokebox
