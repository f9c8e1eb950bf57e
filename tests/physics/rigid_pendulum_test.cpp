// Pendulums: joints neither gain nor lose energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "base/maths.h"
#include "support/links_world.h"

namespace smokebox {
namespace {

using test::LinksWorld;

constexpr double kGravity = 9.81;

/// Complete elliptic integral of the first kind, by the arithmetic-geometric mean.
double completeElliptic(double modulus) {
  double a = 1, b = std::sqrt(1 - modulus * modulus);
  for (int k = 0; k < 40; ++k) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return kPi / (2 * a);
}

/// Of a uniform rod of 1 m hung at its end.
double exactPeriod(double startRad) {
  return 4 * std::sqrt((1.0 / 3) / (kGravity * 0.5)) * completeElliptic(std::sin(startRad / 2));
}

LinksWorld hungRod(double startRad) {
  LinksWorld world;
  world.gravity = {0, -kGravity};
  const Vec2 pivot{0.3, 2};
  const int rod =
      world.rod(pivot + Vec2{0.5 * std::sin(startRad), -0.5 * std::cos(startRad)}, 1, 2, startRad);
  world.joint(JointKind::pin, {-1, pivot}, {rod, {0, 0.5}});
  return world;
}

/// From the moments at which it hangs straight down.
double measuredPeriod(double startRad, double dt, int periods, int subSteps = 1) {
  LinksWorld world = hungRod(startRad);
  double before = startRad, first = 0, last = 0;
  int crossings = 0;
  for (int step = 1; crossings < 2 * periods + 1 && step < 100000; ++step) {
    world.step(dt, subSteps);
    const double angle = world.bodies.angleRad[0];
    if (before * angle <= 0) {
      last = (step - 1) * dt + dt * before / (before - angle);
      if (crossings++ == 0) first = last;
    }
    before = angle;
  }
  return 2 * (last - first) / (crossings - 1);
}

TEST(RigidPendulum, HasThePeriodOfTheEllipticIntegral) {
  // Truth: T = 4 sqrt(I / (m g d)) K(sin(angle / 2)), within 0.1% at 200 steps a period, from 5 to 150
  // degrees.
  EXPECT_NEAR(exactPeriod(radians(90)) / exactPeriod(0), 1.18034060, 1e-8);
  for (const double degrees : {5.0, 30.0, 60.0, 90.0, 120.0, 150.0}) {
    const double exact = exactPeriod(radians(degrees));
    const double error = measuredPeriod(radians(degrees), exact / 200, 10) / exact - 1;
    const double coarse = measuredPeriod(radians(degrees), exact / 100, 10) / exact - 1;
    const double order = std::log2(coarse / error);
    std::printf("pendulum from %.0f degrees: period off by %.1e at T/200, order %.2f\n", degrees, error,
                order);
    EXPECT_LT(std::fabs(error), 3e-4);
    EXPECT_NEAR(order, 2, 0.1);
  }
}

TEST(RigidPendulum, InSubStepsIsExactToAMillionth) {
  // Truth: the same at 200 steps a period of 16 sub-steps each, as scenes have them: 256 times nearer.
  for (const double degrees : {5.0, 90.0, 150.0}) {
    const double exact = exactPeriod(radians(degrees));
    const double error = measuredPeriod(radians(degrees), exact / 200, 10, 16) / exact - 1;
    std::printf("pendulum from %.0f degrees in 16 sub-steps: period off by %.1e\n", degrees, error);
    EXPECT_LT(std::fabs(error), 4e-6);
  }
}

TEST(RigidPendulum, KeepsItsEnergyOverAHundredPeriods) {
  // Truth: no drift; what swings within a period is the scheme's, of second order in the step.
  const double start = radians(150), dt = exactPeriod(start) / 200;
  LinksWorld world = hungRod(start);
  const double scale = 2 * kGravity * 0.5 * (1 - std::cos(start));
  auto meanOverAPeriod = [&] {
    double sum = 0;
    for (int k = 0; k < 200; ++k) sum += world.energyOfStep(dt) / 200;
    return sum;
  };
  const double first = meanOverAPeriod();
  double drift = 0;
  for (int period = 1; period < 100; ++period)
    drift = std::max(drift, std::fabs(meanOverAPeriod() - first) / scale);
  std::printf("pendulum, 100 periods: energy of a period drifts by %.1e\n", drift);
  EXPECT_LT(drift, 1e-4);
  EXPECT_LT(world.gap(0), 1e-12);
}

TEST(RigidPendulum, ADoubleOneKeepsItsEnergyThoughItIsChaotic) {
  // Truth: E is constant; 100 s at 1 ms from the horizontal, E counted from the lowest state: within 1e-3 in
  // single steps, and 1e-4 in steps of four sub-steps.
  for (const int subSteps : {1, 4}) {
    LinksWorld world;
    world.gravity = {0, -kGravity};
    const int upper = world.rod({0.5, 0}, 1, 1, kPi / 2), lower = world.rod({1.5, 0}, 1, 1, kPi / 2);
    world.joint(JointKind::pin, {-1, {0, 0}}, {upper, {0, 0.5}});
    world.joint(JointKind::pin, {upper, {0, -0.5}}, {lower, {0, 0.5}});
    const double h = 1e-3 / subSteps;
    const double lowest = -kGravity * (0.5 + 1.5), start = world.energyOfStep(h);
    double off = 0, gap = 0;
    for (int k = 1; k < 100000 * subSteps; ++k) {
      off = std::max(off, std::fabs(world.energyOfStep(h) - start) / (start - lowest));
      gap = std::max(gap, std::max(world.gap(0), world.gap(1)));
    }
    std::printf("double pendulum, 100 s, sub-steps of %.2f ms: energy off by at most %.1e, pins by %.1e m\n",
                1e3 * h, off, gap);
    EXPECT_LT(off, subSteps == 1 ? 5e-4 : 1e-4);
    EXPECT_LT(gap, 1e-12);
  }
}

TEST(RigidPendulum, ARopeSwingsOnlyDownwardsInEnergy) {
  // Truth: a slack rope leaves a parabola alone, takes the speed along it when it gets taut, and then neither
  // gains nor loses: released at half the rope's length to the side, the ball falls to sqrt(3)/2 below.
  LinksWorld world;
  world.gravity = {0, -kGravity};
  const int ball = world.particle({0.5, 0}, 1);
  JointDef def;
  def.kind = JointKind::rope;
  def.a = {-1, {0, 0}}, def.b = {ball, {}};
  def.length = 1;
  const int rope = world.joints.add(def, world.bodies);
  const double dt = 1e-3;
  double taut = 0, far = 0, most = -1e9, least = 1e9;
  for (int k = 0; k < 20000; ++k) {
    const double energy = world.energyOfStep(dt);
    far = std::max(far, length(world.bodies.position[ball]));
    if (taut == 0 && world.joints.tension(rope) > 0) taut = (k + 1) * dt;
    if (taut == 0) {
      EXPECT_NEAR(energy, 0, 1e-4);
    } else if (k * dt > taut + 0.01) {
      most = std::max(most, energy), least = std::min(least, energy);
    }
  }
  const double fall = std::sqrt(0.75), speed = std::sqrt(2 * kGravity * fall);
  const double radial = speed * fall;  // the rope's direction is (1/2, -sqrt(3)/2)
  const double left = -0.5 * radial * radial;
  std::printf("rope: taut at %.4f s, energy after %.5f to %.5f J (exact %.5f), %.1e m too long\n", taut,
              least, most, left, far - 1);
  EXPECT_NEAR(taut, std::sqrt(2 * fall / kGravity), 2 * dt);
  EXPECT_NEAR(most, left, 1e-3);
  EXPECT_LT(most - least, 1e-4);
  EXPECT_LT(far - 1, 1e-9);
}

}  // namespace
}  // namespace smokebox
