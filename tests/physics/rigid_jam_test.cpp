// What cannot be satisfied: bodies wedged, crushed, stuck into each other. It always ends, and gently.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "support/rigid_cases.h"
#include "support/rigid_world.h"

namespace smokebox::test {
namespace {

const auto kBox = bodyShape(BoxShape{{1, 1}});
constexpr double kG = 10;

BodyDef rough(const std::shared_ptr<const BodyShape>& shape, Vec2 position, double mass = 0) {
  BodyDef def = bodyAt(shape, position, mass);
  def.friction = 0.5;
  return def;
}

/// How many bodies have their centre outside of the domain.
int outside(const RigidWorld& world, double width, double height) {
  int count = 0;
  for (int b = 4; b < world.system.bodyCount(); ++b) {
    const Vec2 at = world.at(b);
    if (world.system.def(b).mass > 0) count += !(at.x > 0 && at.x < width && at.y > 0 && at.y < height);
  }
  return count;
}

double fastest(const RigidWorld& world) {
  double speed = 0;
  for (int b = 4; b < world.system.bodyCount(); ++b)
    if (world.system.isThere(b) && world.system.def(b).mass > 0)
      speed = std::max(speed, length(world.velocity(b)));
  return speed;
}

/// What each step takes this thread, ms: the least of several runs of the same steps.
class StepTimes {
 public:
  void begin() { at_ = 0; }
  void step(RigidWorld& world) {
    const double start = now();
    world.steps(1);
    const double took = now() - start;
    if (at_ == times_.size()) times_.push_back(took);
    times_[at_] = std::min(times_[at_], took);
    ++at_;
  }
  double worst() const { return *std::max_element(times_.begin(), times_.end()); }
  double median() const {
    std::vector<double> sorted = times_;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<long>(sorted.size() / 2), sorted.end());
    return sorted[sorted.size() / 2];
  }

 private:
  static double now() {
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
  }
  std::vector<double> times_;
  std::size_t at_ = 0;
};

TEST(RigidJam, BodiesThatOverlapAtTheStartPartGently) {
  // Truth: without gravity, bodies that are put into each other part without ever moving by their velocity;
  // with it, none gets faster than gravity makes it, bounce or not.
  for (const double g : {0.0, kG})
    for (const double e : {0.0, 0.8})
      for (const double overlap : {0.05, 0.5, 0.95}) {
        RigidWorld world(closedBox(20, 20, e, 0.5), {0, -g});
        std::vector<int> boxes;
        for (int k = 0; k < 5; ++k) {
          BodyDef def = rough(kBox, {10 + 0.01 * k, 0.5 + k * (1 - overlap)});
          def.bounce = e;
          boxes.push_back(world.add(def));
        }
        double speed = 0;
        for (int k = 0; k < 180; ++k) {
          world.steps(1);
          // From rest, what gravity gives in the time, and over the height that they are lifted to.
          speed = std::max(speed, fastest(world) - g * (k + 1) * RigidWorld::kStep);
        }
        EXPECT_LT(speed, 1e-6) << "g " << g << " bounce " << e << " overlap " << overlap;
        EXPECT_LT(world.system.totals().kineticEnergy, 5 * kG * 5) << overlap;
        world.seconds(5);
        EXPECT_LT(world.system.totals().overlap, 0.01)
            << "g " << g << " bounce " << e << " overlap " << overlap;
      }
}

TEST(RigidJam, ABodyInsideAnotherComesOut) {
  // Truth: a disk put right into the middle of a big block leaves it, and nothing flies off.
  RigidWorld world(closedBox(40, 40, 0, 0.5), {0, -kG});
  world.add(rough(bodyShape(BoxShape{{4, 4}}), {20, 2}));
  const int disk = world.add(rough(bodyShape(CircleShape{0.3}), {20.1, 2.2}));
  double speed = 0;
  for (int k = 0; k < 300; ++k) world.steps(1), speed = std::max(speed, fastest(world));
  EXPECT_LT(speed, std::sqrt(2 * kG * 5));
  EXPECT_LT(world.system.totals().overlap, 0.01);
  EXPECT_GT(length(world.at(disk) - Vec2{20, 2}), 1);
}

TEST(RigidJam, ClosingWallsCrushWhatIsBetweenThem) {
  // Truth: two walls that close on bodies until these overlap by half: each step ends, all stays finite, and
  // when the walls open again nothing has been shot off. What slips out of a press, and how, hangs on the
  // last digit: eleven presses, of which the median tells.
  std::vector<double> speeds;
  for (unsigned seed = 1; seed <= 11; ++seed) {
    RigidWorld world(closedBox(40, 20, 0, 0.5), {0, -kG});
    const auto wall = solidShape(BoxShape{{1, 16}});
    const int left = world.add(solidAt(wall, {5, 8})), right = world.add(solidAt(wall, {35, 8}));
    Dice dice(seed);
    for (int k = 0; k < 12; ++k)
      world.add(rough(k % 2 ? kBox : randomPolygon(dice, k % 4 == 0), {12 + 1.4 * k, 1}));
    double speed = 0;
    for (int k = 0; k < 300; ++k) {
      const double x = 5 + 13 * std::min(1.0, k / 150.0);  // down to 3 m for twelve metres of bodies
      world.system.moveTo(left, {x, 8}, 0);
      world.system.moveTo(right, {40 - x, 8}, 0);
      world.steps(1);
      speed = std::max(speed, fastest(world));
    }
    speeds.push_back(speed);
    EXPECT_EQ(outside(world, 40, 20), 0);
    for (int k = 0; k < 60; ++k) {
      world.system.moveTo(left, {18 - 13 * k / 60.0, 8}, 0);
      world.system.moveTo(right, {22 + 13 * k / 60.0, 8}, 0);
      world.steps(1);
    }
    world.seconds(10);  // what came to lie on a wall slips off in six
    EXPECT_LT(fastest(world), 1);
    EXPECT_LT(world.system.totals().overlap, 0.02);
  }
  std::sort(speeds.begin(), speeds.end());
  // The walls come at 5.2 m/s each: a wedge slips out like a melon seed.
  EXPECT_LT(speeds[speeds.size() / 2], 60);
  EXPECT_LT(speeds.back(), 300);
}

TEST(RigidJam, WedgedBodiesStay) {
  // Truth: a heavy block in a V of solids, and light ones pressed between it and the floor of the V, come to
  // rest without sinking in. In one heap of twelve or so a light one still slips after eight seconds.
  constexpr int kHeaps = 12;
  int still = 0;
  for (int heap = 1; heap <= kHeaps; ++heap) {
    RigidWorld world(closedBox(40, 40, 0, 0.5), {0, -kG});
    for (const double side : {-1.0, 1.0}) {
      BodyDef plank = solidAt(solidShape(BoxShape{{10, 0.5}}), {20 + side * 3, 6}, side * 1.1);
      plank.friction = 0.5;
      world.add(plank);
    }
    Dice dice(heap);
    for (int k = 0; k < 12; ++k)
      world.add(rough(randomPolygon(dice, k % 3 == 0), {20 + dice.between(-0.5, 0.5), 5 + 1.4 * k}));
    const int heavy = world.add(rough(kBox, {20, 24}, 500));
    world.seconds(8);
    const double y = world.at(heavy).y;
    world.seconds(2);
    still += std::abs(world.at(heavy).y - y) < 5e-3 && fastest(world) < 0.1;
    EXPECT_LT(world.system.totals().overlap, 0.02) << "heap " << heap;
  }
  EXPECT_GE(still, kHeaps - 2);
}

/// Polygons in a pocket, so many to a row, that a lid presses to 60% of their area at 10 m/s: none gets out,
/// none is shot off, and no step takes more than ten times the usual one.
void closePocket(int count, int columns) {
  const double width = columns, lidAt = 1.1 * count / columns + 7.5;
  StepTimes times;
  for (int run = 0; run < 2; ++run) {
    RigidWorld world(closedBox(width, lidAt + 16, 0.2, 0.5), {0, -kG});
    Dice dice(8);
    double area = 0;
    for (int k = 0; k < count; ++k) {
      BodyDef def =
          rough(randomPolygon(dice, k % 4 == 0, 0.4), {0.8 + k % columns * 0.92, 0.6 + k / columns * 0.95});
      def.bounce = k % 2 * 0.2;
      area += def.mass;
      world.add(def);
    }
    const int lid = world.add(solidAt(solidShape(BoxShape{{width - 0.1, 1}}), {width / 2, lidAt}));
    const double low = 0.6 * area / width + 0.5;
    const int closed = static_cast<int>((lidAt - low) / 10 / RigidWorld::kStep);
    double speed = 0;
    times.begin();
    for (int k = 0; k < closed + 100; ++k) {
      world.system.moveTo(lid, {width / 2, std::max(low, lidAt - 10 * k * RigidWorld::kStep)}, 0);
      times.step(world);
      speed = std::max(speed, fastest(world));
      ASSERT_EQ(outside(world, width, lidAt + 16), 0) << k;
    }
    EXPECT_LT(speed, 50);  // 16 to 38 over twenty pockets of 120: it hangs on the last digit
    EXPECT_LT(world.system.totals().overlap, 2);
  }
  EXPECT_LT(times.worst(), 10 * times.median() + 1);
}

TEST(RigidJam, APocketOfAHundredThatCloses) { closePocket(120, 8); }

TEST(RigidJam, APocketOfThousandsThatCloses) { closePocket(1500, 20); }

TEST(RigidJam, APaddleSpinsInAFullBin) {
  // Truth: a scripted paddle that turns 2 times a second in a full bin, its tips at 25 m/s: the bodies stay
  // in it, and no step takes more than ten times the usual one.
  StepTimes times;
  for (int run = 0; run < 2; ++run) {
    RigidWorld world(closedBox(7, 16, 0.2, 0.5), {0, -kG});
    Dice dice(6);
    const int paddle = world.add(solidAt(solidShape(BoxShape{{4, 0.3}}), {3.5, 2.8}));
    for (int k = 0; k < 70; ++k)
      (world.add(rough(randomPolygon(dice, k % 4 == 0, 0.4), {0.8 + k % 7 * 0.92, 5 + k / 7 * 0.95})));
    double speed = 0;
    times.begin();
    for (int k = 1; k <= 240; ++k) {
      world.system.moveTo(paddle, {3.5, 2.8}, 4 * kPi * k * RigidWorld::kStep);
      times.step(world);
      speed = std::max(speed, fastest(world));
      ASSERT_EQ(outside(world, 7, 16), 0) << k;
    }
    EXPECT_LT(speed, 200);
  }
  EXPECT_LT(times.worst(), 10 * times.median() + 1);
}

}  // namespace
}  // namespace smokebox::test
