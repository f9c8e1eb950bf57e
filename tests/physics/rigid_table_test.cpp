// Pendulums, springs, chains and strings with known answers, through the whole rigid system as a scene has
// it: steps of 16 sub-steps, and velocities as they are told after a step. (Others test the parts alone, at
// any step.)
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/rigid_reference.h"
#include "support/rigid_world.h"

namespace smokebox::test {
namespace {

constexpr double kG = 9.81;
const auto kPoint = bodyShape(CircleShape{1e-3});

/// A rod without width; it lies along its own y.
BodyDef rodAt(Vec2 centre, double size, double mass, double angleRad) {
  BodyDef def = bodyAt(bodyShape(BoxShape{{1e-3 * size, size}}), centre, mass);
  def.inertia = mass * size * size / 12;
  def.angleRad = angleRad;
  return def;
}
/// A mass that never turns.
BodyDef massAt(Vec2 at, double mass) {
  BodyDef def = bodyAt(kPoint, at, mass);
  def.inertia = 0;
  return def;
}
int join(RigidWorld& world, JointKind kind, Anchor a, Anchor b, double length = 0) {
  JointDef def;
  def.kind = kind;
  def.a = a, def.b = b, def.length = length;
  return world.system.addJoint(def);
}
int spring(RigidWorld& world, Anchor a, Anchor b, double length, double stiffness, double damping = 0) {
  SpringDef def;
  def.from = a, def.to = b;
  def.length = length, def.stiffness = stiffness, def.damping = damping;
  return world.system.addSpring(def);
}

/// Mean time between the moments at which `value` changes its sign, over `count` of them, by a straight line.
template <class Value>
double halfPeriod(RigidWorld& world, double dt, int count, Value value) {
  double before = value(), first = 0, last = 0;
  int crossings = 0;
  for (int step = 1; crossings <= count && step < 1000000; ++step) {
    world.system.step(dt);
    const double now = value();
    if (before * now <= 0 && before != 0) {
      last = (step - 1) * dt + dt * before / (before - now);
      if (crossings++ == 0) first = last;
    }
    before = now;
  }
  return (last - first) / count;
}

double energyOf(const RigidWorld& world) {
  const RigidTotals totals = world.system.totals();
  return totals.kineticEnergy + totals.potentialEnergy;
}

constexpr Vec2 kNail{1, 3};

int hangRod(RigidWorld& world, double angleRad) {
  const int rod =
      world.add(rodAt(kNail + 0.5 * Vec2{std::sin(angleRad), -std::cos(angleRad)}, 1, 2, angleRad));
  join(world, JointKind::pin, {-1, kNail}, {rod, {0, 0.5}});
  return rod;
}

TEST(RigidTable, APendulumHasThePeriodOfItsAmplitude) {
  // Truth: RB10, T = T0 (2/pi) K(sin(angle/2)), at 200 steps a period.
  const double small = rigidReference("RB10", "T0 of a rod of 1 m").value;
  auto period = [&](double degrees, double factor) {
    RigidWorld world(noWalls(), {0, -kG});
    const int rod = hangRod(world, radians(degrees));
    return 2 * halfPeriod(world, small * factor / 200, 20, [&] { return world.system.angleRad(rod); });
  };
  expectRow("RB10", "T0 of a rod of 1 m", period(0.01, 1));
  for (const char* degrees : {"5", "30", "60", "90", "120", "150"}) {
    const std::string name = std::string("factor of ") + degrees + " degrees";
    const double factor = rigidReference("RB10", name).value;
    expectRow("RB10", name, period(std::stod(degrees), factor) / small);
  }
}

TEST(RigidTable, APendulumKeepsItsEnergy) {
  // Truth: RB10, kinetic and potential energy of any step of 100 periods, over what there is of it.
  for (const double degrees : {30.0, 90.0, 150.0}) {
    RigidWorld world(noWalls(), {0, -kG});
    hangRod(world, radians(degrees));
    const double start = energyOf(world), scale = 2 * kG * 0.5 * (1 - std::cos(radians(degrees)));
    double off = 0;
    for (int k = 0; k < 100 * 200; ++k) {
      world.system.step(1.637956 / 200);
      off = std::max(off, std::abs(energyOf(world) - start) / scale);
    }
    expectRow("RB10", "energy over 100 periods", off);
  }
}

TEST(RigidTable, ADoublePendulumKeepsItsEnergy) {
  // Truth: RB19, two rods let go from the horizontal, 100 s at 1 ms.
  RigidWorld world(noWalls(), {0, -kG});
  const int upper = world.add(rodAt(kNail + Vec2{0.5, 0}, 1, 1, kPi / 2)),
            lower = world.add(rodAt(kNail + Vec2{1.5, 0}, 1, 1, kPi / 2));
  join(world, JointKind::pin, {-1, kNail}, {upper, {0, 0.5}});
  join(world, JointKind::pin, {upper, {0, -0.5}}, {lower, {0, 0.5}});
  const double start = energyOf(world);
  double off = 0;
  for (int k = 0; k < 100000; ++k) {
    world.system.step(1e-3);
    off = std::max(off, std::abs(energyOf(world) - start) / (2 * kG));
  }
  expectRow("RB19", "energy over 100 s", off);
}

TEST(RigidTable, AMassOnASpringSwingsAndDecays) {
  // Truth: RB11, at 60 steps a period; damped, x = exp(-c t/2m) times a swing: its extremes tell the decay.
  const double period = rigidReference("RB11", "period of k 100 m 1").value;
  auto hung = [&](RigidWorld& world, double damping) {
    const int mass = world.add(massAt(kNail + Vec2{1.2, 0}, 1));
    spring(world, {-1, kNail}, {mass, {}}, 1, 100, damping);
    return mass;
  };
  RigidWorld free;
  const int mass = hung(free, 0);
  expectRow("RB11", "period of k 100 m 1",
            2 * halfPeriod(free, period / 60, 40, [&] { return free.at(mass).x - kNail.x - 1; }));
  RigidWorld damped;
  const int slow = hung(damped, 2);
  const double w = kPi / halfPeriod(damped, period / 60, 10, [&] { return damped.at(slow).x - kNail.x - 1; });
  expectRow("RB11", "w of k 100 m 1 c 2", w);
  // With x, v and w at one moment the amplitude is sqrt(x^2 + ((v + x c/2m)/w)^2).
  auto amplitude = [&] {
    const double x = damped.at(slow).x - kNail.x - 1, v = damped.velocity(slow).x;
    return std::hypot(x, (v + x) / 9.9498743710661994);
  };
  const double before = amplitude();
  for (int k = 0; k < 120; ++k) damped.system.step(period / 60);
  expectRow("RB11", "decay of k 100 m 1 c 2", std::log(before / amplitude()) / (2 * period));
}

TEST(RigidTable, TwoMassesOnASpringLeaveTheirCentreAtRest) {
  // Truth: RB12, w = sqrt(k (m1 + m2)/(m1 m2)); the centre of mass stays where it is.
  RigidWorld world;
  const int a = world.add(massAt(kNail, 1)), b = world.add(massAt(kNail + Vec2{1.2, 0}, 3));
  spring(world, {a, {}}, {b, {}}, 1, 50);
  double off = 0;
  const double half = halfPeriod(world, 0.77 / 60, 40, [&] {
    off = std::max(off, length(0.25 * (world.at(a) + 3 * world.at(b)) - (kNail + Vec2{0.9, 0})));
    return world.at(b).x - world.at(a).x - 1;
  });
  expectRow("RB12", "w of k 50 m 1 3", kPi / half);
  expectRow("RB12", "centre of mass", off);
}

TEST(RigidTable, AHangingChainIsACatenary) {
  // Truth: RB13, fifty uniform links between nails 1 m apart; at rest after 20 s under damping.
  constexpr int kLinks = 50;
  for (const char* span : {"1.05", "1.2", "1.5", "2"}) {
    const double size = std::stod(span), link = size / kLinks, depth = std::sqrt(size * size / 4 - 0.25);
    RigidWorld world(noWalls(), {0, -kG});
    std::vector<int> links, pins;
    for (int k = 0; k < kLinks; ++k) {  // in a V; a rod points down along its own -y
      const bool down = k < kLinks / 2;
      const double along = down ? k + 0.5 : kLinks - k - 0.5;
      const Vec2 way{1 / size, (down ? -2 : 2) * depth / size};
      BodyDef def =
          rodAt(kNail + Vec2{down ? along / kLinks : 1 - along / kLinks, -depth * along / (0.5 * kLinks)},
                link, link / kG, std::atan2(way.x, -way.y));
      def.linearDamping = def.angularDamping = 4;
      def.ignore = 1;
      links.push_back(world.add(def));
      const Anchor before = k ? Anchor{links[k - 1], {0, -link / 2}} : Anchor{-1, kNail};
      pins.push_back(join(world, JointKind::pin, before, {links[k], {0, link / 2}}));
    }
    join(world, JointKind::pin, {links.back(), {0, -link / 2}}, {-1, kNail + Vec2{1, 0}});
    world.seconds(20);
    double lowest = 0, stretch = 0;
    for (int k = 0; k < kLinks; ++k) {
      const Vec2 end = world.system.anchorPoint({links[k], {0, -link / 2}});
      lowest = std::min(lowest, end.y - kNail.y);
      if (k + 1 < kLinks)
        stretch =
            std::max(stretch, length(end - world.system.anchorPoint({links[k + 1], {0, link / 2}})) / link);
    }
    expectRow("RB13", std::string("sag of S ") + span, -lowest);
    EXPECT_LT(stretch, 1e-9);
    // What the first pin holds: the weight of half the chain, and the pull across, from the first link's
    // moments.
    const double tilt = world.system.angleRad(links[0]);
    const double across = (0.5 * size - 0.5 * link) * std::tan(tilt);
    expectRow("RB13", std::string("tension of S ") + span, std::hypot(0.5 * size, across));
  }
}

TEST(RigidTable, RopesBetweenEqualMassesHangInEqualStepsOfSlope) {
  // Truth: RB14, tan(angle) grows from rope to rope by a mass's weight over the horizontal tension.
  constexpr int kRopes = 20;
  const double piece = 1.5 / kRopes, depth = std::sqrt(1.5 * 1.5 / 4 - 0.25);
  RigidWorld world(noWalls(), {0, -kG});
  std::vector<Anchor> ends{{-1, kNail}};
  for (int k = 1; k < kRopes; ++k) {
    const double x = static_cast<double>(k) / kRopes;
    BodyDef def = massAt(kNail + Vec2{x, -2 * depth * std::min(x, 1 - x)}, 0.1);
    def.linearDamping = 4;
    ends.push_back({world.add(def), {}});
  }
  ends.push_back({-1, kNail + Vec2{1, 0}});
  for (int k = 0; k < kRopes; ++k) join(world, JointKind::rope, ends[k], ends[k + 1], piece);
  world.seconds(40);
  std::vector<double> slopes;
  for (int k = 0; k < kRopes; ++k) {
    const Vec2 d = world.system.anchorPoint(ends[k + 1]) - world.system.anchorPoint(ends[k]);
    slopes.push_back(d.y / d.x);
    EXPECT_NEAR(length(d), piece, 1e-9 * piece);
  }
  const double step = (slopes.back() - slopes[0]) / (kRopes - 1);
  double off = 0;
  for (int k = 0; k < kRopes; ++k) off = std::max(off, std::abs((slopes[k] - slopes[0] - k * step) / step));
  expectRow("RB14", "step of slopes", off);
}

TEST(RigidTable, AHeavyStringStretchesUnderItself) {
  // Truth: RB15, w L^2/(2 EA), of forty masses on springs; half a piece's weight at its end.
  constexpr int kPieces = 40;
  const double piece = 1.0 / kPieces, weight = 3, elastic = 20;
  RigidWorld world(noWalls(), {0, -kG});
  Anchor last{-1, kNail};
  for (int k = 0; k < kPieces; ++k) {
    BodyDef def =
        massAt(kNail - Vec2{0, (k + 1) * piece}, weight * piece / kG * (k == kPieces - 1 ? 0.5 : 1));
    def.linearDamping = 5;
    def.ignore = 1;
    const Anchor next{world.add(def), {}};
    spring(world, last, next, piece, elastic / piece, 0.2);
    last = next;
  }
  world.seconds(15);
  expectRow("RB15", "elongation of w 3 L 1 EA 20", kNail.y - world.at(last.body).y - 1);
}

}  // namespace
}  // namespace smokebox::test
