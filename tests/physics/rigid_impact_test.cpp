// Central impacts, and impacts off the centre of what is hit: Newton's restitution.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/rigid_reference.h"
#include "support/rigid_world.h"

namespace smokebox::test {
namespace {

const auto kDisk = bodyShape(CircleShape{0.5});
const auto kBox = bodyShape(BoxShape{{1, 1}});

struct Central {
  double m1 = 1, m2 = 3, v1 = 2, v2 = 0, e = 1;
  double gap = 0.3;  // between the two at the start: places the impact anywhere within a step
};

/// Worst error of the two velocities of a central impact along x, over the speed of approach; `momentum`: the
/// error of the sum, over the largest part.
double centralError(const Central& c, const std::shared_ptr<const BodyShape>& shape, double& momentum,
                    double gravity = 0) {
  RigidWorld world(noWalls(), {0, -gravity});
  BodyDef one = bodyAt(shape, {49.5 - c.gap, 50}, c.m1), two = bodyAt(shape, {50.5, 50}, c.m2);
  one.velocity.x = c.v1, two.velocity.x = c.v2;
  one.bounce = c.e;  // the larger of the two counts
  const int a = world.add(one), b = world.add(two);
  world.steps(static_cast<int>(c.gap / (c.v1 - c.v2) / RigidWorld::kStep) + 4);
  const double sum = c.m1 + c.m2, mean = (c.m1 * c.v1 + c.m2 * c.v2) / sum, part = c.e * (c.v2 - c.v1) / sum;
  const double w1 = mean + c.m2 * part, w2 = mean - c.m1 * part;
  momentum = std::abs(c.m1 * world.velocity(a).x + c.m2 * world.velocity(b).x - sum * mean) /
             std::max(std::abs(c.m1 * c.v1), std::abs(c.m2 * c.v2));
  return std::max(std::abs(world.velocity(a).x - w1), std::abs(world.velocity(b).x - w2)) / (c.v1 - c.v2);
}

TEST(RigidImpact, CentralImpactsOfTheTableAreExact) {
  // Truth: RB1, masses 1 and 3 at 2 and 0 m/s; the momentum is 2.
  for (const char* e : {"1", "0.5"}) {
    const std::string end = " of m 1 3 v 2 0 e " + std::string(e);
    RigidWorld world;
    BodyDef one = bodyAt(kDisk, {49, 50}, 1), two = bodyAt(kDisk, {51, 50}, 3);
    one.velocity.x = 2;
    one.bounce = std::stod(e);
    const int a = world.add(one), b = world.add(two);
    world.seconds(1);
    expectRow("RB1", "v1" + end, world.velocity(a).x);
    expectRow("RB1", "v2" + end, world.velocity(b).x);
    expectRow("RB1", "momentum", world.system.totals().momentum.x);
  }
}

TEST(RigidImpact, CentralImpactsAreExactAtAnyMomentOfAStep) {
  // Truth: v1' = (m1 v1 + m2 v2 + m2 e (v2 - v1)) / (m1 + m2), for masses from 1:1000 to 1000:1, every
  // restitution, disks and boxes, with and without free fall, wherever within a step they meet.
  double worst = 0, worstMomentum = 0;
  for (const auto& shape : {kDisk, kBox})
    for (const double ratio : {0.001, 0.3, 1.0, 3.0, 1000.0})
      for (const double e : {0.0, 0.3, 0.8, 1.0})
        for (const double speed : {0.5, 7.0, 60.0})
          for (int k = 0; k < 7; ++k) {
            double momentum = 0;
            const double gap = 0.3 + speed * RigidWorld::kStep * k / 7;
            worst =
                std::max(worst, centralError({1, ratio, speed, -0.2, e, gap}, shape, momentum, k % 2 * 10));
            worstMomentum = std::max(worstMomentum, momentum);
          }
  EXPECT_LT(worst, 1e-7);
  EXPECT_LT(worstMomentum, 1e-12);
}

TEST(RigidImpact, ABoxStruckOffItsCentreTakesSpin) {
  // Truth: a disk that strikes a free box off its centre: the impulse along the normal is
  // (1 + e) v / (1/m + 1/M + r^2/I), with r the arm; the box then turns with r J / I.
  double worst = 0;
  for (const double arm : {0.0, 0.2, 0.45})
    for (const double e : {0.5, 1.0})
      for (const double mass : {0.1, 1.0, 10.0})
        for (int k = 0; k < 5; ++k) {
          RigidWorld world;
          BodyDef ball =
              bodyAt(bodyShape(CircleShape{0.1}), {48.9 - 3 * RigidWorld::kStep * k / 5, 50 + arm}, mass);
          BodyDef box = bodyAt(kBox, {50, 50}, 2);
          ball.velocity.x = 3;
          ball.bounce = e;
          const int a = world.add(ball), b = world.add(box);
          world.steps(12);
          const double j = (1 + e) * 3 / (1 / mass + 0.5 + arm * arm / box.inertia);
          worst = std::max({worst, std::abs(world.velocity(a).x - (3 - j / mass)) / 3,
                            std::abs(world.velocity(b).x - j / 2) / 3,
                            std::abs(world.spin(b) + arm * j / box.inertia) / 3});
        }
  EXPECT_LT(worst, 1e-7);
}

}  // namespace
}  // namespace smokebox::test
