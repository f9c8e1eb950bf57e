// Many bounces: a ball that comes to rest, cradles, and what bounces without loss.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/rigid_cases.h"
#include "support/rigid_reference.h"
#include "support/rigid_world.h"

namespace smokebox::test {
namespace {

const auto kDisk = bodyShape(CircleShape{0.5});
const auto kBox = bodyShape(BoxShape{{1, 1}});

TEST(RigidBounce, ABallComesToRestInTheTimeOfTheSeries) {
  // Truth: RB4, a drop from 1 m: peak n is e^(2 n) h, rest after sqrt(2 h/g) (1 + e)/(1 - e); in steps of one
  // sub-step of a scene's, so that the moment of rest is seen.
  constexpr double g = 9.81, h = RigidWorld::kStep / 16;
  for (const char* e : {"0.5", "0.8", "0.9"}) {
    const double keep = std::stod(e);
    ThreadPool pool(1);
    RigidMethod method;
    method.subSteps = 1;
    RigidSystem system(closedBox(20, 20, keep), {0, -g}, method, pool);
    BodyDef def = bodyAt(kDisk, {10, 1.5});
    def.bounce = keep;
    const int body = system.add(def);
    // The height that each flight reaches, from its energy: (y + v^2/2g) is the same all along a parabola.
    std::vector<double> peaks;
    double moving = 0;
    for (int k = 1; k < 12 / h; ++k) {
      system.step(h);
      const double v = system.velocity(body).y, height = system.position(body).y - 0.5;
      const double top = height + v * v / (2 * g);
      if (peaks.empty() || std::abs(top - peaks.back()) > 1e-6 * peaks.back()) peaks.push_back(top);
      if (top > 1e-9) moving = k * h;
    }
    ASSERT_GE(peaks.size(), 6u);
    double off = 0;
    for (int n = 0; n < 6; ++n) off = std::max(off, std::abs(peaks[n] / std::pow(keep, 2 * n) - 1));
    expectRow("RB4", "peaks", 1 + off, 1e-5);
    // It comes to rest between this sub-step and the next.
    expectRow("RB4", "total time e " + std::string(e), moving + 0.5 * h);
    EXPECT_LT(std::abs(system.position(body).y - 0.5), 1e-5) << e;
  }
}

/// Speeds after a cradle of equal gaps in which the first runs into the others.
std::vector<double> cradle(const std::shared_ptr<const BodyShape>& shape, const std::vector<double>& masses,
                           double gap, double speed) {
  RigidWorld world;
  std::vector<int> bodies;
  for (std::size_t k = 0; k < masses.size(); ++k) {
    BodyDef def = bodyAt(shape, {45 + k * (1 + gap), 50}, masses[k]);
    if (k == 0) def.position.x -= 0.3, def.velocity.x = speed;
    def.bounce = 1;
    bodies.push_back(world.add(def));
  }
  world.seconds(1.5);
  std::vector<double> speeds;
  for (const int body : bodies) speeds.push_back(world.velocity(body).x);
  return speeds;
}

/// The same by events in one dimension: the earliest impact of neighbours, one after the other.
std::vector<double> oneByOne(const std::vector<double>& masses, double gap, double speed) {
  std::vector<double> v(masses.size(), 0.0), gaps(masses.size() - 1, gap);
  v[0] = speed;
  gaps[0] += 0.3;
  for (;;) {
    std::size_t next = gaps.size();
    double time = 1e300;
    for (std::size_t k = 0; k < gaps.size(); ++k) {
      const double closing = v[k] - v[k + 1];
      if (closing > 1e-9 * speed && std::max(gaps[k], 0.0) / closing < time)
        next = k, time = std::max(gaps[k], 0.0) / closing;
    }
    if (next == gaps.size()) return v;
    for (std::size_t k = 0; k < gaps.size(); ++k) gaps[k] -= time * (v[k] - v[k + 1]);
    const double m = masses[next], n = masses[next + 1], mean = (m * v[next] + n * v[next + 1]) / (m + n);
    v[next] = 2 * mean - v[next];
    v[next + 1] = 2 * mean - v[next + 1];
  }
}

TEST(RigidBounce, TheLastOfACradleLeavesWithAll) {
  // Truth: RB20, five equal bodies, bounce 1: the first four are left at rest; touching, or with gaps.
  double worst = 0;
  for (const auto& shape : {kDisk, kBox})
    for (const double gap : {0.0, 1e-6, 1e-3, 0.02})
      for (const double speed : {0.5, 3.0, 30.0}) {
        const std::vector<double> v = cradle(shape, {1, 1, 1, 1, 1}, gap, speed);
        double others = 0;
        for (int k = 0; k < 4; ++k) others += std::abs(v[k]);
        worst = std::max(worst, others / speed);
        EXPECT_NEAR(v[4], speed, 1e-6 * speed) << gap << " " << speed;
      }
  expectRow("RB20", "momentum of the others", worst, 1e-4);
}

TEST(RigidBounce, ACradleOfUnequalMassesFollowsItsImpactsOneByOne) {
  // Truth: pairs strike one after the other; where they all touch, masses whose order does not matter.
  const std::vector<double> rising{1, 2, 4, 8, 16}, falling{16, 8, 4, 2, 1}, ends{3, 1, 1, 1, 3}, two{1, 10};
  struct Case {
    std::vector<double> masses;
    double gap;
  };
  for (const auto& shape : {kDisk, kBox})
    for (const Case& c : {Case{rising, 0}, Case{falling, 0}, Case{two, 0}, Case{rising, 0.02},
                          Case{falling, 0.02}, Case{ends, 0.02}, Case{ends, 0.1}}) {
      const std::vector<double> want = oneByOne(c.masses, c.gap, 2), got = cradle(shape, c.masses, c.gap, 2);
      for (std::size_t k = 0; k < want.size(); ++k)
        EXPECT_NEAR(got[k], want[k], 2e-6)
            << "first mass " << c.masses[0] << " gap " << c.gap << " body " << k;
    }
}

TEST(RigidBounce, FreePairsKeepEnergyMomentumAndAngularMomentum) {
  // Truth: two bodies that collide with bounce 1 and friction 0 keep all three; concave ones, spinning, at
  // 0.1 to 50 m/s.
  Dice dice(7);
  int collided = 0;
  double worstEnergy = 0, worstMomentum = 0, worstAngular = 0;
  for (int k = 0; k < 100; ++k) {
    RigidWorld world;
    const double speed = 0.1 * std::pow(500, k / 99.0);
    BodyDef one = bodyAt(randomPolygon(dice, k % 2 == 0), {48.5, 50}),
            two = bodyAt(randomPolygon(dice, k % 3 == 0), {50.5, 50 + dice.between(-0.2, 0.2)});
    one.velocity = {speed, dice.between(-0.1, 0.1) * speed};
    two.velocity = {-dice.between(0, 1) * speed, 0};
    one.angleRad = dice.between(-3, 3), two.angleRad = dice.between(-3, 3);
    one.spin = dice.between(-2, 2) * speed, two.spin = dice.between(-2, 2) * speed;
    one.bounce = two.bounce = 1;
    const int a = world.add(one);
    world.add(two);
    const RigidTotals before = world.system.totals();
    const double scale = one.mass * length(one.velocity) + two.mass * length(two.velocity);
    for (double time = 0; time < 5 / speed && time < 20; time += RigidWorld::kStep) world.steps(1);
    world.steps(4);
    const RigidTotals after = world.system.totals();
    collided += length(world.velocity(a) - one.velocity) > 1e-3 * speed;
    worstEnergy = std::max(worstEnergy, std::abs(after.kineticEnergy / before.kineticEnergy - 1));
    worstMomentum = std::max(worstMomentum, length(after.momentum - before.momentum) / scale);
    // About the origin, 70 m away: the scale of what is summed.
    worstAngular =
        std::max(worstAngular, std::abs(after.angularMomentum - before.angularMomentum) / (50 * scale));
  }
  EXPECT_GT(collided, 90);
  EXPECT_LT(worstEnergy, 1e-12);
  EXPECT_LT(worstMomentum, 1e-12);
  EXPECT_LT(worstAngular, 1e-12);
  RecordProperty("energy", std::to_string(worstEnergy * 1e12) + "e-12");
  RecordProperty("angular", std::to_string(worstAngular * 1e12) + "e-12");
}

TEST(RigidBounce, ABoxOfBouncingPolygonsKeepsItsEnergy) {
  // Truth: six polygons, bounce 1 and friction 0, in a closed box: the energy is the same after each step,
  // for 100 collisions.
  Dice dice(3);
  RigidWorld world(closedBox(6, 6, 1));
  for (int k = 0; k < 6; ++k) {
    BodyDef def = bodyAt(randomPolygon(dice, k % 2 == 0), {1.2 + 1.8 * (k % 3), 1.5 + 3 * (k / 3)});
    def.velocity = {dice.between(-4, 4), dice.between(-4, 4)};
    def.spin = dice.between(-3, 3);
    def.bounce = 1;
    world.add(def);
  }
  const double before = world.system.totals().kineticEnergy;
  int collisions = 0, steps = 0;
  for (; collisions < 100 && steps < 3000; ++steps) {
    world.steps(1);
    for (const Touch& touch : world.system.touches()) collisions += touch.approach > 0;
    ASSERT_NEAR(world.system.totals().kineticEnergy / before, 1, 1e-12) << steps;
  }
  EXPECT_GE(collisions, 100);
}

TEST(RigidBounce, VelocitiesAfterABlowAreThoseOfTheStepsEnd) {
  // Truth: a disk that falls on the floor without bounce is at rest after the step in which it lands,
  // whenever in a step that is; until then it has the speed of its fall.
  for (int k = 0; k < 60; ++k) {
    RigidWorld world(closedBox(20, 20), {0, -10});
    const double height = 2 + 0.004 * k;
    const int disk = world.add(bodyAt(bodyShape(CircleShape{0.5}), {10, 0.5 + height}));
    for (int step = 1; step <= 60; ++step) {
      world.steps(1);
      const double time = step * RigidWorld::kStep, left = height - 5 * time * time;
      if (left > 0) {
        EXPECT_NEAR(world.velocity(disk).y, -10 * time, 1e-9) << height << " at " << time;
      }
      if (left < -0.02) {  // one sub-step later
        EXPECT_NEAR(world.velocity(disk).y, 0, 1e-9) << height << " at " << time;
      }
    }
  }
}

}  // namespace
}  // namespace smokebox::test
