// What flies freely: the answers are exact, and so are the steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/rigid_reference.h"
#include "support/rigid_world.h"

namespace smokebox::test {
namespace {

std::shared_ptr<const BodyShape> hook() {
  return bodyShape(PolygonShape{{{-0.6, -0.4}, {0.5, -0.5}, {0.7, 0.1}, {0.1, 0.05}, {-0.3, 0.6}}});
}

TEST(RigidFree, ASpinningBodyKeepsItsSpinForAThousandTurns) {
  // Truth: RB9, angle = w t to 1e-9 after 1000 turns, energy and angular momentum constant, no translation;
  // whatever the shape, the spin and the way it turns.
  for (const auto& shape : {bodyShape(CircleShape{0.5}), bodyShape(BoxShape{{1, 0.1}}), hook()})
    for (const double turnsPerSecond : {0.5, -7.0, 400.0}) {
      RigidWorld world;
      BodyDef def = bodyAt(shape, {50.3, 49.7}, 2);
      const double w = def.spin = 2 * kPi * turnsPerSecond;
      const int body = world.add(def);
      const double energy = world.system.totals().kineticEnergy,
                   momentum = world.system.totals().angularMomentum;
      const int steps = static_cast<int>(std::lround(1000 / std::abs(turnsPerSecond) / RigidWorld::kStep));
      world.steps(steps);
      const double angle = w * steps * RigidWorld::kStep;
      expectRow("RB9", "angle and energy of 1000 turns", world.system.angleRad(body) / angle - 1);
      EXPECT_EQ(world.spin(body), w);
      EXPECT_EQ(world.at(body), def.position);
      EXPECT_EQ(world.system.totals().kineticEnergy, energy);
      EXPECT_EQ(world.system.totals().angularMomentum, momentum);
    }
}

TEST(RigidFree, ARodStruckAtItsEndTurnsAboutItsCentreOfPercussion) {
  // Truth: RB16, an impulse J across the end of a free rod: v = J / m, w = 6 J / (m L); the point 2 L / 3
  // from the struck end is at rest at this moment, and the centre then goes on straight at J / m.
  double worst = 0;
  for (const double angle : {0.0, 0.7, -2.0})
    for (const double length : {0.3, 2.0})
      for (const double impulse : {1e-3, 5.0, 4e3}) {
        RigidWorld world;
        BodyDef def = bodyAt(bodyShape(BoxShape{{length, 1e-6 * length}}), {50, 50}, 3);
        def.inertia = def.mass * length * length / 12;  // of a rod without width
        def.angleRad = angle;
        const int rod = world.add(def);
        const Vec2 along{std::cos(angle), std::sin(angle)}, across = perpendicular(along);
        world.system.applyImpulse(rod, def.position + 0.5 * length * along, impulse * across);
        const double v = impulse / 3, w = 6 * impulse / (3 * length);
        auto check = [&](double time) {
          worst =
              std::max({worst, std::abs(dot(world.velocity(rod), across) / v - 1),
                        std::abs(dot(world.velocity(rod), along) / v), std::abs(world.spin(rod) / w - 1)});
          EXPECT_NEAR(dot(world.at(rod) - def.position, across) - v * time, 0, 1e-13 * (50 + v * time));
        };
        check(0);
        const Vec2 still = world.velocity(rod) - world.spin(rod) * length / 6 * across;
        EXPECT_NEAR(std::max(std::abs(still.x), std::abs(still.y)) / v, 0, 1e-13);
        world.steps(30);
        check(0.5);
      }
  expectRow("RB16", "v and w of a rod struck at its end", worst);
}

/// A body's place and velocity on a parabola from `from` at `at`.
struct Flight {
  Vec2 from, velocity, gravity;
  double since = 0;
  Vec2 place(double t) const {
    return from + (t - since) * velocity + 0.5 * (t - since) * (t - since) * gravity;
  }
  Vec2 speed(double t) const { return velocity + (t - since) * gravity; }
};

/// The largest error of place and velocity over so many steps, relative to the way and the speed so far.
double flightError(RigidWorld& world, int body, const Flight& flight, int first, int last) {
  double worst = 0;
  for (int k = first + 1; k <= last; ++k) {
    world.steps(1);
    const double t = k * RigidWorld::kStep;
    worst = std::max({worst, length(world.at(body) - flight.place(t)) / (1 + length(flight.place(t))),
                      length(world.velocity(body) - flight.speed(t)) / (1 + length(flight.speed(t)))});
  }
  return worst;
}

TEST(RigidFree, AProjectileFliesAParabola) {
  // Truth: RB18, place and velocity are those of the parabola after each step (1e-6 is asked for), from its
  // start, and from wherever it gets a new velocity or an impulse.
  for (const double g : {10.0, -9.81, 1000.0})
    for (const Vec2 start : {Vec2{0, 0}, Vec2{3, 12}, Vec2{-200, 40}}) {
      RigidWorld world(wallsOf(RigidWalls::Kind::open, 1e6, 1e6), {0, -g});
      BodyDef def = bodyAt(hook(), {5e5, 5e5}, 4);
      def.position = {20, 30};
      def.velocity = start;
      def.spin = 3;
      const int body = world.add(def);
      Flight flight{def.position, start, {0, -g}};
      EXPECT_LT(flightError(world, body, flight, 0, 120), 1e-12) << g;
      flight = {world.at(body), {7, 1}, flight.gravity, 2};
      world.system.setVelocity(body, flight.velocity);
      EXPECT_EQ(world.velocity(body), flight.velocity);
      EXPECT_LT(flightError(world, body, flight, 120, 180), 1e-12) << g;
      flight = {world.at(body), world.velocity(body) + 0.25 * Vec2{2, -6}, flight.gravity, 3};
      world.system.applyImpulse(body, world.at(body), {2, -6});
      EXPECT_LT(length(world.velocity(body) - flight.velocity), 1e-12 * (1 + length(flight.velocity)));
      const double off = flightError(world, body, flight, 180, 240);
      expectRow("RB18", "place on a parabola", off, 1e-6);
    }
}

TEST(RigidFree, GravityThatChangesBendsTheParabolaAtThatMoment) {
  // Truth: with another gravity, or share of it, the flight goes on from where it is, at the velocity that it
  // has.
  for (const bool whole : {true, false}) {
    RigidWorld world(wallsOf(RigidWalls::Kind::open, 1e6, 1e6), {1, -10});
    const int body = world.add(bodyAt(hook(), {20, 30}, 4));
    Flight flight{{20, 30}, {0, 0}, {1, -10}};
    EXPECT_LT(flightError(world, body, flight, 0, 60), 1e-12);
    flight = {world.at(body), world.velocity(body), {-2, 20}, 1};
    if (whole)
      world.system.setGravity(flight.gravity);
    else
      world.system.setGravityScale(body, -2);
    EXPECT_LT(length(world.velocity(body) - flight.velocity), 1e-12);
    EXPECT_LT(flightError(world, body, flight, 60, 120), 1e-12);
  }
}

TEST(RigidFree, DampingDecaysExponentially) {
  // Truth: v' = g - c v: v = g/c + (v0 - g/c) exp(-c t), and the spin exp(-c t) of what it was; to the second
  // order of a sub-step in the place.
  for (const double c : {0.1, 2.0, 30.0}) {
    RigidWorld world(wallsOf(RigidWalls::Kind::open, 1e6, 1e6), {0, -10});
    BodyDef def = bodyAt(hook(), {20, 30}, 4);
    def.velocity = {5, 2};
    def.spin = 8;
    def.linearDamping = def.angularDamping = c;
    const int body = world.add(def);
    const Vec2 end{0, -10 / c};
    for (int k = 1; k <= 90; ++k) {
      world.steps(1);
      const double t = k * RigidWorld::kStep, left = std::exp(-c * t);
      const Vec2 v = end + left * (def.velocity - end),
                 x = def.position + t * end + (1 - left) / c * (def.velocity - end);
      EXPECT_LT(length(world.velocity(body) - v), 1e-12 * length(def.velocity)) << c << " at " << t;
      const double h = RigidWorld::kStep / 16, change = c * length(x - def.position) + 10 * t;
      EXPECT_LT(length(world.at(body) - x), c * h * h / 20 * change) << c << " at " << t;
      EXPECT_NEAR(world.spin(body), 8 * left, 1e-11) << c << " at " << t;
    }
  }
}

TEST(RigidFree, ASpringPullsFromTheMomentThatItIsThereToThatOfItsEnd) {
  // Truth: x = cos(w t) from a stretch of 1 m at rest, w = 3; from the moment at which it is cut straight on;
  // and hung on again, at a new velocity, x cos(w t) + v/w sin(w t).
  RigidWorld world;
  const int body = world.add(bodyAt(bodyShape(CircleShape{0.1}), {51, 50}, 2));
  SpringDef def;
  def.from = {body, {}}, def.to = {-1, {50, 50}};
  def.stiffness = 18;
  const int spring = world.system.addSpring(def);
  for (int k = 1; k <= 60; ++k) {
    world.steps(1);
    EXPECT_NEAR(world.at(body).x, 50 + std::cos(3 * k * RigidWorld::kStep), 1e-6) << k;
  }
  world.system.removeSpring(spring);
  const double x = world.at(body).x, v = world.velocity(body).x;
  EXPECT_NEAR(v, -3 * std::sin(3.0), 1e-4);
  world.seconds(1);
  EXPECT_NEAR(world.at(body).x, x + v, 1e-12);
  EXPECT_NEAR(world.velocity(body).x, v, 1e-12);
  const double from = world.at(body).x - 50;
  world.system.addSpring(def);
  world.system.setVelocity(body, {2, 0});
  for (int k = 1; k <= 60; ++k) {
    world.steps(1);
    const double phase = 3 * k * RigidWorld::kStep;
    EXPECT_NEAR(world.at(body).x, 50 + from * std::cos(phase) + 2.0 / 3 * std::sin(phase), 1e-5) << k;
  }
}

}  // namespace
}  // namespace smokebox::test
