// Stacks, pyramids and walls of one-metre boxes: they stand, and hardly move.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "support/rigid_cases.h"
#include "support/rigid_reference.h"
#include "support/rigid_world.h"

namespace smokebox::test {
namespace {

const auto kBox = bodyShape(BoxShape{{1, 1}});

BodyDef boxAt(Vec2 position, double mass = 1) {
  BodyDef def = bodyAt(kBox, position, mass);
  def.friction = 0.6;
  return def;
}

struct Sag {
  double down = 0, moved = 0, turned = 0, overlap = 0, gained = 0;  // worst of any box; metres, rad, J
};

/// A stack of `count` boxes, the top of mass `top`, after so many seconds.
Sag stack(int count, double top, double time) {
  RigidWorld world(closedBox(20, 2 * count + 20, 0, 0.6), {0, -10});
  std::vector<int> boxes;
  for (int k = 0; k < count; ++k) boxes.push_back(world.add(boxAt({10, 0.5 + k}, k == count - 1 ? top : 1)));
  auto energy = [&] {
    const RigidTotals totals = world.system.totals();
    return totals.kineticEnergy + totals.potentialEnergy;
  };
  const double before = energy();
  Sag sag;
  for (int second = 0; second < time; ++second) {
    world.seconds(1);
    sag.overlap = std::max(sag.overlap, world.system.totals().overlap);
    sag.gained = std::max(sag.gained, (energy() - before) / before);
    for (int k = 0; k < count; ++k) {
      const Vec2 by = world.at(boxes[k]) - Vec2{10, 0.5 + k};
      sag.down = std::max(sag.down, -by.y);
      sag.moved = std::max(sag.moved, length(by));
      sag.turned = std::max(sag.turned, std::abs(world.system.angleRad(boxes[k])));
    }
  }
  return sag;
}

TEST(RigidStack, TenBoxesStandStill) {
  // Truth: RB17, after 10 s no drift, no overlap and no energy gained.
  const Sag sag = stack(10, 1, 10);
  expectRow("RB17", "overlap", sag.overlap);
  expectRow("RB17", "drift", sag.moved);
  EXPECT_LT(sag.gained, 1e-9);
}

TEST(RigidStack, TallStacksStandForAMinute) {
  // Truth: 10, 20 and 40 boxes stay as they were put; none sinks by a millimetre in 60 s.
  for (const int count : {10, 20, 40}) {
    const Sag sag = stack(count, 1, 60);
    EXPECT_LT(sag.down, 1e-3) << count;
    EXPECT_LT(sag.moved, 1e-3) << count;
    EXPECT_LT(sag.turned, 1e-3) << count;
  }
}

TEST(RigidStack, LightBoxesCarryHeavyOnes) {
  // Truth: ten boxes whose top weighs 100 times as much, two with 1000 times: none sinks by a millimetre.
  const Sag ten = stack(10, 100, 60), two = stack(2, 1000, 60);
  EXPECT_LT(ten.down, 1e-3);
  EXPECT_LT(ten.moved, 1e-3);
  EXPECT_LT(two.down, 1e-3);
  EXPECT_LT(two.moved, 1e-3);
}

enum class Order { up, down, shuffled };

struct Drift {
  double settled = 0, after = 0;  // worst box: from its place to the fifth second; from there to the tenth, m
};

Drift driftOf(const std::vector<Vec2>& places, double width, double height) {
  RigidWorld world(closedBox(width, height, 0, 0.6), {0, -10});
  std::vector<int> boxes;
  for (const Vec2 place : places) boxes.push_back(world.add(boxAt(place)));
  world.seconds(5);
  Drift drift;
  std::vector<Vec2> then;
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    then.push_back(world.at(boxes[k]));
    drift.settled = std::max(drift.settled, length(then[k] - places[k]));
  }
  world.seconds(5);
  for (std::size_t k = 0; k < boxes.size(); ++k)
    drift.after = std::max(drift.after, length(world.at(boxes[k]) - then[k]));
  return drift;
}

Drift pyramid(int base, Order order, double gap) {
  std::vector<Vec2> places;
  for (int row = 0; row < base; ++row)
    for (int k = 0; k < base - row; ++k)
      places.push_back({5 + k * (1 + gap) + row * 0.5 * (1 + gap), 0.5 + row});
  if (order == Order::down) std::reverse(places.begin(), places.end());
  if (order == Order::shuffled) {
    Dice dice(5);
    for (std::size_t k = places.size() - 1; k > 0; --k)
      std::swap(places[k], places[static_cast<std::size_t>(dice.between(0, static_cast<double>(k) + 1))]);
  }
  return driftOf(places, 3 * base + 20, 2 * base + 20);
}

/// Courses of boxes, every other one `shift` to the right.
Drift wall(int columns, int courses, double spacing, double shift) {
  std::vector<Vec2> places;
  for (int row = 0; row < courses; ++row)
    for (int k = 0; k < columns; ++k) places.push_back({5 + k * spacing + row % 2 * shift, 0.5 + row});
  return driftOf(places, columns * spacing + 20, 2 * courses + 20);
}

TEST(RigidStack, WallsStand) {
  // Truth: no box of a wall goes 1 mm between the fifth and the tenth second, with gaps between the boxes of
  // a course or hardly any.
  for (const double gap : {0.001, 0.1}) {
    const Drift drift = wall(20, 20, 1 + gap, 0.3);
    EXPECT_LT(drift.settled, 1e-3) << "gap " << gap;
    EXPECT_LT(drift.after, 1e-3) << "gap " << gap;
  }
}

TEST(RigidStack, StacksStandInRows) {
  // Truth: 120 stacks of ten stand as one does.
  const Drift drift = wall(120, 10, 1.5, 0);
  EXPECT_LT(drift.settled, 1e-3);
  EXPECT_LT(drift.after, 1e-3);
}

TEST(RigidStack, APyramidOf40DoesNotDrift) {
  // Truth: no box goes 1 mm between the fifth and the tenth second, in whatever order they were put, with
  // gaps between the boxes of a row or none.
  for (const Order order : {Order::up, Order::down, Order::shuffled})
    for (const double gap : {0.0, 0.02, 0.1}) {
      const Drift drift = pyramid(40, order, gap);
      EXPECT_LT(drift.settled, 0.02) << "order " << static_cast<int>(order) << " gap " << gap;
      EXPECT_LT(drift.after, 1e-3) << "order " << static_cast<int>(order) << " gap " << gap;
    }
}

TEST(RigidStackSlow, APyramidOf100DoesNotDrift) {
  // Truth: the same for 5,050 boxes, within 15 mm.
  for (const Order order : {Order::up, Order::down, Order::shuffled})
    EXPECT_LT(pyramid(100, order, 0.1).after, 15e-3) << "order " << static_cast<int>(order);
}

TEST(RigidStackSlow, AWallOf1600BoxesStands) {
  // Truth: none goes 5 mm between the fifth and the tenth second.
  for (const double gap : {0.001, 0.1}) {
    const Drift drift = wall(40, 40, 1 + gap, 0.3);
    EXPECT_LT(drift.settled, 1e-2) << "gap " << gap;
    EXPECT_LT(drift.after, 5e-3) << "gap " << gap;
  }
}

}  // namespace
}  // namespace smokebox::test
