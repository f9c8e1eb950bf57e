// Friction of bodies that slide, roll and stay, against textbook answers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/rigid_reference.h"
#include "support/rigid_world.h"

namespace smokebox::test {
namespace {

const auto kDisk = bodyShape(CircleShape{0.5});
const auto kBox = bodyShape(BoxShape{{1, 1}});
constexpr double kG = 9.81;

/// A body in contact with a slope: the domain's floor with gravity turned, or a solid that is turned.
struct Slope {
  Slope(const std::shared_ptr<const BodyShape>& shape, double angle, double mu, bool solid)
      : along(solid ? Vec2{std::cos(angle), -std::sin(angle)} : Vec2{1, 0}),
        world(closedBox(200, 100, 0, mu),
              solid ? Vec2{0, -kG} : Vec2{kG * std::sin(angle), -kG * std::cos(angle)}) {
    BodyDef def = bodyAt(shape, {20, 0.5});
    def.friction = mu;
    if (solid) {
      BodyDef plane = solidAt(solidShape(BoxShape{{120, 2}}), {100, 50}, -angle);
      plane.friction = mu;
      world.add(plane);
      def.position = Vec2{100, 50} - 40 * along + 1.5 * Vec2{-along.y, along.x};
      def.angleRad = -angle;
    }
    body = world.add(def);
    start = def.position;
  }
  double way() const { return dot(world.at(body) - start, along); }
  /// From rest, over the second half of `time`: what is lost at the start does not count.
  double acceleration(double time) {
    world.seconds(0.5 * time);
    const double before = dot(world.velocity(body), along);
    world.seconds(0.5 * time);
    return (dot(world.velocity(body), along) - before) / (0.5 * time);
  }
  Vec2 along;
  RigidWorld world;
  Vec2 start;
  int body = -1;
};

TEST(RigidFriction, ABlockOnASlopeStaysBelowTheAngleOfFriction) {
  // Truth: RB5, nothing moves while tan(angle) <= mu: at 0.99 of it too, for 10 s.
  for (const bool solid : {false, true})
    for (const double mu : {0.3, 0.6, 1.0})
      for (const double share : {0.5, 0.99}) {
        Slope slope(kBox, std::atan(share * mu), mu, solid);
        slope.world.seconds(10);
        SCOPED_TRACE(testing::Message() << solid << " mu " << mu << " share " << share);
        expectRow("RB5", "creep", length(slope.world.at(slope.body) - slope.start));
      }
}

TEST(RigidFriction, ABlockOnASteepSlopeSlides) {
  // Truth: RB5, a = g (sin - mu cos).
  for (const bool solid : {false, true}) {
    expectRow("RB5", "a of 30 degrees mu 0.3", Slope(kBox, radians(30), 0.3, solid).acceleration(2));
    expectRow("RB5", "a of 45 degrees mu 0.5", Slope(kBox, radians(45), 0.5, solid).acceleration(2));
    EXPECT_GT(Slope(kBox, std::atan(0.303), 0.3, solid).acceleration(2), 0);
  }
}

TEST(RigidFriction, ADiskRollsDownASlopeOrSlips) {
  // Truth: RB6, a = (2/3) g sin if mu >= tan/3, else a = g (sin - mu cos) and the spin grows by 2 mu g cos /
  // R.
  const RigidReference roll = rigidReference("RB6", "a of 30 degrees rolling"),
                       least = rigidReference("RB6", "least mu of 30 degrees");
  const double angle = radians(30);
  for (const bool solid : {false, true}) {
    for (const double mu : {1.02 * least.value, 0.5, 2.0}) {
      Slope slope(kDisk, angle, mu, solid);
      SCOPED_TRACE(mu);
      expectRow("RB6", "a of 30 degrees rolling", slope.acceleration(2));
      EXPECT_NEAR(-0.5 * slope.world.spin(slope.body), dot(slope.world.velocity(slope.body), slope.along),
                  1e-3 * roll.value);
    }
    for (const double mu : {0.05, 0.15}) {
      Slope slope(kDisk, angle, mu, solid);
      const double a = kG * (std::sin(angle) - mu * std::cos(angle));
      EXPECT_NEAR(slope.acceleration(2), a, 0.1 * roll.tolerance * a) << mu;
      EXPECT_NEAR(-slope.world.spin(slope.body), 2 * 2 * mu * kG * std::cos(angle) / 0.5,
                  0.1 * roll.tolerance * 8 * mu * kG);
    }
  }
}

TEST(RigidFriction, ASlidingDiskComesToRoll) {
  // Truth: RB7, v = 2 v0/3 after v0/(3 mu g) seconds and 5 v0^2/(18 mu g) metres; it then keeps rolling.
  const RigidReference speed = rigidReference("RB7", "rolling speed");
  RigidWorld world(closedBox(100, 50, 0, 0.2), {0, -kG});
  BodyDef def = bodyAt(kDisk, {20, 0.5});
  def.friction = 0.2;
  def.velocity.x = 1;
  const int body = world.add(def);
  world.steps(20);
  // From the place in steady rolling back to where and when it began: x = s + v (t - T).
  const double v = world.velocity(body).x, x = world.at(body).x - 20, t = 20 * RigidWorld::kStep;
  expectRow("RB7", "rolling speed", v);
  EXPECT_NEAR(-0.5 * world.spin(body), v, 0.1 * speed.tolerance);
  // With v(t) known at the end, the way tells the time: x = s + v (t - T) and s = (v0 + v)/2 T.
  const double began = (v * t - x) / (v - 0.5 * (1 + v));
  expectRow("RB7", "time to rolling", began);
  expectRow("RB7", "way to rolling", 0.5 * (1 + v) * began);
  world.seconds(10);
  EXPECT_NEAR(world.velocity(body).x, speed.value, 0.1 * speed.tolerance * speed.value);
}

TEST(RigidFriction, ABlockSlidesToRest) {
  // Truth: RB8, it stops after v0^2/(2 mu g) metres and v0/(mu g) seconds, and stays.
  RigidWorld world(closedBox(100, 50, 0, 0.2), {0, -kG});
  BodyDef def = bodyAt(kBox, {20, 0.5});
  def.friction = 0.2;
  def.velocity.x = 1;
  const int body = world.add(def);
  world.steps(15);
  const double v = world.velocity(body).x, a = (1 - v) / (15 * RigidWorld::kStep);
  expectRow("RB8", "time to rest", 1 / a);
  world.steps(25);
  expectRow("RB8", "way to rest", world.at(body).x - 20);
  EXPECT_LT(std::abs(world.velocity(body).x), 1e-9);
  const double rest = world.at(body).x;
  world.seconds(10);
  EXPECT_LT(std::abs(world.at(body).x - rest), 1e-9);
}

}  // namespace
}  // namespace smokebox::test
