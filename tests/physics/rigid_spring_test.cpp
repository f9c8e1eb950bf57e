// Springs: frequencies, decay, equilibria, and stiffness that no step can follow.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "base/maths.h"
#include "support/links_world.h"

namespace smokebox {
namespace {

using test::LinksWorld;

/// Mean time between the moments at which `value` falls through 0, over `count` of them.
template <class Value>
double measuredPeriod(LinksWorld& world, double dt, int count, Value value) {
  double before = value(), first = 0, last = 0;
  int crossings = 0;
  for (int step = 1; crossings <= count && step < 1000000; ++step) {
    world.step(dt);
    const double now = value();
    if (before > 0 && now <= 0) {
      last = (step - 1) * dt + dt * before / (before - now);
      if (crossings++ == 0) first = last;
    }
    before = now;
  }
  return (last - first) / count;
}

LinksWorld hungMass(double stiffness, double damping, double stretch) {
  LinksWorld world;
  const int mass = world.particle({1 + stretch, 0}, 1);
  world.spring({-1, {0, 0}}, {mass, {}}, 1, stiffness, damping);
  return world;
}

TEST(RigidSpring, SwingsWithItsFrequencyToFourthOrder) {
  // Truth: w = sqrt(k / m); 0.1% at 60 steps a period is asked for, Numerov's method errs by (w h)^4 / 480.
  const double period = 2 * kPi / 10;
  double errors[3];
  for (int k = 0; k < 3; ++k) {
    LinksWorld world = hungMass(100, 0, 0.2);
    errors[k] =
        measuredPeriod(world, period / (30 << k), 20, [&] { return world.bodies.position[0].x - 1; }) /
            period -
        1;
  }
  std::printf("spring: period off by %.1e, %.1e, %.1e at 30, 60, 120 steps\n", errors[0], errors[1],
              errors[2]);
  EXPECT_LT(std::fabs(errors[1]), 1e-6);
  EXPECT_NEAR(std::log2(errors[0] / errors[2]) / 2, 4, 0.2);
}

TEST(RigidSpring, GoesWithEitherOfItsBodies) {
  // Truth: all springs at a body that is removed and no others, those too that came after the last removal.
  LinksWorld world;
  for (int k = 0; k < 4; ++k) world.particle({1.0 * k, 0}, 1);
  const auto join = [&](int a, int b) { world.spring({a, {}}, {b, {}}, 1, 10, 0); };
  join(0, 1), join(1, 2), join(2, 3), join(3, -1), join(0, 2);
  const auto there = [&] {
    std::vector<bool> all;
    for (int k = 0; k < world.springs.count(); ++k) all.push_back(world.springs.isThere(k));
    return all;
  };
  world.springs.removeAt(1);
  EXPECT_EQ(there(), (std::vector<bool>{false, false, true, true, true}));
  join(0, 3);
  world.springs.removeAt(0);
  EXPECT_EQ(there(), (std::vector<bool>{false, false, true, true, false, false}));
  world.springs.removeAt(9);
  EXPECT_EQ(world.springs.removed(), 4);
}

TEST(RigidSpring, DecaysAsItsDampingSays) {
  // Truth: exp(-c t / 2m) cos(w t), w = sqrt(k / m - (c / 2m)^2) = 9.949874 for k = 100, c = 2.
  const double exact = 2 * kPi / std::sqrt(99.0);
  double errors[2], decays[2];
  for (int k = 0; k < 2; ++k) {
    LinksWorld world = hungMass(100, 2, 0.2);
    const double dt = exact / (60 << k);
    errors[k] = measuredPeriod(world, dt, 5, [&] { return world.bodies.position[0].x - 1; }) / exact - 1;
    // Energy of the swing falls by exp(-c / m t); energies of whole periods.
    LinksWorld other = hungMass(100, 2, 0.2);
    auto mean = [&] {
      double sum = 0;
      for (int step = 0; step < 60 << k; ++step) sum += other.energyOfStep(dt);
      return sum;
    };
    const double first = mean();
    mean();
    mean();
    decays[k] = std::log(mean() / first) / (-2 * 3 * exact) - 1;
  }
  std::printf("damped spring: period off by %.1e, decay by %.1e at 60 steps, %.1e, %.1e at 120\n", errors[0],
              decays[0], errors[1], decays[1]);
  EXPECT_LT(std::fabs(errors[0]), 2e-3);
  EXPECT_LT(std::fabs(decays[0]), 2e-3);
  EXPECT_LT(std::fabs(errors[1]), 0.3 * std::fabs(errors[0]));
  EXPECT_LT(std::fabs(decays[1]), 0.3 * std::fabs(decays[0]));
}

TEST(RigidSpring, TwoMassesSwingAboutTheirCentre) {
  // Truth: w = sqrt(k (m1 + m2) / (m1 m2)); the centre of mass stays to rounding, and so do momenta, though
  // they turn about each other.
  LinksWorld world;
  const int a = world.particle({0, 0}, 1, {0, -0.75}), b = world.particle({1.2, 0}, 3, {0, 0.25});
  world.spring({a, {}}, {b, {}}, 1, 50, 0);
  const Vec2 middle{0.9, 0};
  double off = 0;
  const double spin = 1 * cross({0, 0}, {0, -0.75}) + 3 * cross({1.2, 0}, {0, 0.25});
  for (int k = 0; k < 5000; ++k) {
    world.step(1.0 / 120, 4);
    off = std::max(off, length(0.25 * (world.bodies.position[a] + 3 * world.bodies.position[b]) - middle));
  }
  double turns = 0;
  for (const int each : {a, b})
    turns += world.bodies.def[each].mass *
             cross(world.bodies.position[each], world.bodies.velocity[each].linear());
  EXPECT_LT(off, 1e-12);
  EXPECT_NEAR(turns, spin, 1e-11);

  LinksWorld straight;
  const int c = straight.particle({0, 0}, 1), d = straight.particle({1.2, 0}, 3);
  straight.spring({c, {}}, {d, {}}, 1, 50, 0);
  const double exact = 2 * kPi / std::sqrt(50 * 4.0 / 3);
  const double period = measuredPeriod(straight, exact / 60, 20, [&] {
    return straight.bodies.position[d].x - straight.bodies.position[c].x - 1;
  });
  EXPECT_NEAR(period / exact, 1, 1e-6);
}

TEST(RigidSpring, AHeavyStringStretchesUnderItself) {
  // Truth: elongation w L^2 / (2 EA) for a string of weight w per metre; half the last piece's weight is at
  // the end, which makes the sum over pieces the same. Whatever the step.
  for (const double dt : {1.0 / 30, 1.0 / 240}) {
    LinksWorld world;
    world.gravity = {0, -9.81};
    world.drag = 5;
    const int pieces = 40;
    const double piece = 1.0 / pieces, weight = 3, elastic = 20;
    for (int k = 0; k < pieces; ++k) {
      world.particle({0, -(k + 1) * piece}, weight * piece / 9.81 * (k == pieces - 1 ? 0.5 : 1));
      world.spring(k ? Anchor{k - 1, {}} : Anchor{-1, {0, 0}}, {k, {}}, piece, elastic / piece, 0.2);
    }
    for (int k = 0; k < std::lround(15 / dt); ++k) world.step(dt, 16);
    const double stretch = -world.bodies.position[pieces - 1].y - 1, exact = weight / (2 * elastic);
    std::printf("string, steps of 1/%.0f s: elongation off by %.1e, tension at the top by %.1e\n", 1 / dt,
                stretch / exact - 1, world.springs.tension(0) / (weight * (1 - 0.5 * piece)) - 1);
    EXPECT_NEAR(stretch, exact, 1e-5 * exact);
    EXPECT_NEAR(world.springs.tension(0), weight * (1 - 0.5 * piece), 1e-5 * weight);
  }
}

TEST(RigidSpring, IsStableAndStiffBeyondAnyStep) {
  // Truth: with k dt^2 / m of 1e4 to 1e8 a mass on a spring is a pendulum, and on a spring without length it
  // stays at the anchor; the weight hangs at k times the stretch, exactly. Its own energy never grows.
  for (const double ratio : {1e4, 1e6, 1e8}) {
    const double dt = 1.0 / 60, stiffness = ratio / (dt * dt);
    LinksWorld world;
    world.gravity = {0, -9.81};
    const int ball = world.particle({1, 0}, 1);
    world.spring({-1, {0, 0}}, {ball, {}}, 1, stiffness);
    double far = 0, most = -1e9;
    for (int k = 0; k < 600 * 16; ++k) {
      most = std::max(most, world.energyOfStep(dt / 16));
      far = std::max(far, std::fabs(length(world.bodies.position[ball]) - 1));
    }
    LinksWorld held;
    held.gravity = {0, -9.81};
    const int drawn = held.particle({0.5, 0.2}, 1);
    held.spring({-1, {0, 0}}, {drawn, {}}, 0, stiffness);
    for (int k = 0; k < 120; ++k) held.step(dt, 16);
    const double stretch = -held.bodies.position[drawn].y;
    std::printf("k dt^2 / m = %.0e: length off by %.1e, energy at most %+.1e J, stretch at rest by %.1e\n",
                ratio, far, most, stretch * stiffness / 9.81 - 1);
    EXPECT_LT(far, 4 * 9.81 / stiffness + 1e-9);
    EXPECT_LT(most, 1e-3);
    EXPECT_NEAR(stretch * stiffness, 9.81, 1e-5);
    EXPECT_LT(length(held.bodies.velocity[drawn].linear()), 1e-8);
  }
}

TEST(RigidSpring, HoldsATwistedBodyByItsArms) {
  // Truth: a bar on two equal springs at its ends swings about its centre with w^2 = 2 k r^2 / I where they
  // are across it.
  LinksWorld world;
  const int bar = world.rod({0, 0}, 1, 1, kPi / 2 + 0.02);
  world.spring({-1, {0.5, 10}}, {bar, {0, -0.5}}, 10, 30);
  world.spring({-1, {-0.5, 10}}, {bar, {0, 0.5}}, 10, 30);
  const double exact = 2 * kPi / std::sqrt(2 * 30 * 0.25 / (1.0 / 12));
  const double period =
      measuredPeriod(world, exact / 100, 10, [&] { return world.bodies.angleRad[bar] - kPi / 2; });
  EXPECT_NEAR(period / exact, 1, 1e-3);
}

TEST(RigidSpring, FollowsAnEndThatIsCarriedAndTears) {
  // Truth: an end that is moved arrives at the end of the step, evenly; a mass on a damped spring comes after
  // it. A spring that is drawn too far is gone at the step's end, and its mass flies on.
  LinksWorld world;
  const int mass = world.particle({0, 0}, 1);
  const int spring = world.spring({-1, {0, 0}}, {mass, {}}, 0, 1e4, 200);
  for (int k = 1; k <= 60; ++k) {
    world.springs.moveEnd(spring, {0.05 * k, 0});
    world.step(1.0 / 60, 16);
    EXPECT_EQ(world.springs.def(spring).from.at.x, 0.05 * k);
  }
  EXPECT_NEAR(world.bodies.velocity[mass].x, 3, 1e-3);
  EXPECT_NEAR(world.bodies.position[mass].x, 3, 1e-3);

  LinksWorld torn;
  const int ball = torn.particle({1, 0}, 1, {10, 0});
  SpringDef def;
  def.from = {-1, {0, 0}}, def.to = {ball, {}};
  def.length = 1, def.stiffness = 10, def.tear = 0.5;
  const int weak = torn.springs.add(def, torn.bodies);
  while (torn.springs.isThere(weak) && torn.bodies.position[ball].x < 10) torn.step(1.0 / 120, 4);
  EXPECT_GT(torn.bodies.position[ball].x, 1.5);
  EXPECT_LT(torn.bodies.position[ball].x, 1.5 + 10.0 / 120);
  const double speed = torn.bodies.velocity[ball].x;
  EXPECT_NEAR(speed * speed, 100 - 10 * 0.25, 1);
  for (int k = 0; k < 10; ++k) torn.step(1.0 / 120, 4);
  EXPECT_EQ(torn.bodies.velocity[ball].x, speed);
  EXPECT_EQ(torn.springs.tension(weak), 0);
}

}  // namespace
}  // namespace smokebox
