// Impacts of bodies that slide along what they hit: only what is normal is exchanged, and friction acts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/rigid_reference.h"
#include "support/rigid_world.h"

namespace smokebox::test {
namespace {

const auto kDisk = bodyShape(CircleShape{0.5});

TEST(RigidGlancing, AGlancingImpactOfEqualDisksPartsThemAtRightAngles) {
  // Truth: RB2, a disk at (1, 0) m/s that meets its equal at 45 degrees without friction.
  const RigidReference part = rigidReference("RB2", "target vx and vy; striker vx and -vy"),
                       energy = rigidReference("RB2", "energy");
  double worst = 0, worstEnergy = 0;
  for (int k = 0; k < 16; ++k) {
    RigidWorld world;
    const double off = std::sqrt(0.5);
    BodyDef one = bodyAt(kDisk, {50 - off - 0.4 - RigidWorld::kStep * k / 16, 50 - off}, 1);
    BodyDef two = bodyAt(kDisk, {50, 50}, 1);
    one.velocity.x = 1;
    one.bounce = 1;
    const int a = world.add(one), b = world.add(two);
    world.seconds(1);
    const Vec2 v = world.velocity(a), w = world.velocity(b);
    worst = std::max({worst, std::abs(w.x - part.value), std::abs(w.y - part.value),
                      std::abs(v.x - part.value), std::abs(v.y + part.value)});
    worstEnergy = std::max(worstEnergy, std::abs(world.system.totals().kineticEnergy - energy.value));
  }
  expectRow("RB2", "energy", 0.5 + worstEnergy);
  expectRow("RB2", "target vx and vy; striker vx and -vy", 0.5 + worst);
}

TEST(RigidGlancing, GlancingImpactsExchangeWhatIsNormal) {
  // Truth: along the line of centres Newton's law, across it nothing, for any offset, masses and restitution.
  double worst = 0;
  for (const double offset : {0.1, 0.4, 0.7, 0.95})
    for (const double ratio : {0.1, 1.0, 20.0})
      for (const double e : {0.5, 1.0})
        for (const double speed : {0.7, 5.0, 40.0}) {
          RigidWorld world;
          const Vec2 n{std::sqrt(1 - offset * offset), offset};
          BodyDef one = bodyAt(kDisk, {48.3, 50 - offset}, 1), two = bodyAt(kDisk, {50, 50}, ratio);
          one.velocity.x = speed;
          one.bounce = e;
          const int a = world.add(one), b = world.add(two);
          world.steps(static_cast<int>(1.7 / speed / RigidWorld::kStep) + 6);
          const double impulse = (1 + e) * speed * n.x * ratio / (1 + ratio);
          worst = std::max({worst, length(world.velocity(a) - Vec2{speed, 0} + impulse * n) / speed,
                            length(world.velocity(b) - impulse / ratio * n) / speed});
        }
  EXPECT_LT(worst, 1e-7);
}

struct Bounced {
  Vec2 velocity;
  double rim = 0;  // spin times radius
};

/// A disk that meets the floor (the domain's wall, or a solid under it) at 1 m/s, at moment k/8 of a step.
Bounced offTheFloor(double along, double rim, double e, double mu, int k, bool solid) {
  RigidWorld world(closedBox(100, 100, e, mu));
  const double floor = solid ? 50 : 0;
  if (solid) {
    BodyDef slab = solidAt(solidShape(BoxShape{{40, 1}}), {50, 49.5});
    slab.bounce = e, slab.friction = mu;
    world.add(slab);
  }
  BodyDef disk = bodyAt(kDisk, {50, floor + 0.8 + RigidWorld::kStep * k / 8});
  disk.velocity = {along, -1};
  disk.spin = rim / 0.5;
  disk.bounce = e, disk.friction = mu;
  const int body = world.add(disk);
  world.seconds(0.6);
  return {world.velocity(body), 0.5 * world.spin(body)};
}

TEST(RigidGlancing, FrictionAtAnImpactSlidesOrSticks) {
  // Truth: RB3, the tangential impulse is the smaller of mu (1 + e) m |vn| and m |vt + w R| / 3.
  const RigidReference slid = rigidReference("RB3", "vt sliding");
  const Bounced sliding = offTheFloor(1, 0, 1, 0.1, 0, false);
  expectRow("RB3", "vt sliding", sliding.velocity.x);
  expectRow("RB3", "w R sliding", -sliding.rim);
  EXPECT_NEAR(sliding.velocity.y, 1, 0.1 * slid.tolerance);
  expectRow("RB3", "vt sticking", offTheFloor(1, 0, 1, 0.4, 0, false).velocity.x);
  double worst = 0;
  for (const bool solid : {false, true})
    for (const double along : {-2.0, 0.3, 1.0, 3.0})
      for (const double turn : {-4.0, 0.0, 1.5})
        for (const double e : {0.4, 1.0})
          for (const double mu : {0.05, 0.16, 0.17, 0.5, 2.0})
            for (int k = 0; k < 8; k += 3) {
              const double slip = along + turn;
              const double j = std::copysign(std::min(mu * (1 + e), std::abs(slip) / 3), slip);
              const Bounced got = offTheFloor(along, turn, e, mu, k, solid);
              worst = std::max({worst, std::abs(got.velocity.x - (along - j)),
                                std::abs(got.rim - (turn - 2 * j)), std::abs(got.velocity.y - e)});
            }
  EXPECT_LT(worst, 0.1 * slid.tolerance);
}

}  // namespace
}  // namespace smokebox::test
