// Distances of convex pieces and times of impact.
#include <gtest/gtest.h>

#include "rigid/collide.h"
#include "rigid/distance.h"
#include "support/rigid_cases.h"

namespace smokebox {
namespace {

using namespace test;

TEST(RigidDistance, RandomPairsAgreeWithAllEdgesAgainstAll) {
  // The distance is the slow one's, the points lie that far apart along the normal.
  Dice dice(4);
  int apart = 0;
  for (int trial = 0; trial < 40000; ++trial) {
    const ConvexPiece a = randomPiece(dice, 1 + dice.below(trial % 50 == 0 ? 60 : 9), 0.02);
    const ConvexPiece b = randomPiece(dice, 1 + dice.below(9), 0.01);
    const Frame fa = dice.frame(2), fb = dice.frame(2);
    const double cores = slowDistance(a, fa, b, fb);
    const Closest closest = closestPoints(a, fa, b, fb);
    if (cores > 1e-9) {
      ++apart;
      ASSERT_NEAR(closest.distance, cores - 0.03, 1e-10) << trial;
      ASSERT_NEAR(length(closest.b - closest.a - closest.distance * closest.normal), 0, 1e-9) << trial;
    } else {
      ASSERT_LE(closest.distance, -0.03 + 1e-9) << trial;
    }
  }
  EXPECT_GT(apart, 10000);
}

TEST(RigidDistance, SizesAndNeedlesDoNotMatter) {
  // From 0.1 mm to 1 km, as flat as 1 to 10,000, far from the origin, with gaps down to a billionth: the
  // error stays at rounding, and a contact is found whenever the gap is within the margin.
  Dice dice(12);
  int near = 0;
  for (int trial = 0; trial < 30000; ++trial) {
    const double size = exact::power(10, dice.below(8) - 4), flat = 1 / exact::power(10, dice.below(5));
    const auto piece = [&] {
      const int corners = 1 + dice.below(10);
      ConvexPiece made = randomPiece(dice, corners, corners < 3 ? dice.between(0.001, 0.1) : 0);
      const double height = dice.below(2) ? flat : 1;
      for (Vec2& p : made.points) p = {size * p.x, size * height * p.y};
      return makePiece(made.points, size * height * made.radius);
    };
    const ConvexPiece a = piece(), b = piece();
    Frame fa = dice.frame(1.5 * size), fb = dice.frame(1.5 * size);
    const Vec2 far{size * dice.between(-100, 100), size * dice.between(-100, 100)};
    const Closest first = closestPoints(a, fa, b, fb);
    const double wanted = size / exact::power(10, dice.below(9)) + a.radius + b.radius;
    fb.position = fb.position + (wanted - first.distance) * first.normal + far;
    fa.position = fa.position + far;
    const double cores = slowDistance(a, fa, b, fb);
    if (cores < 1e-10 * size) continue;
    ++near;
    ASSERT_NEAR(closestPoints(a, fa, b, fb).distance, cores - a.radius - b.radius, 1e-12 * size) << trial;
    Manifold manifold;
    ASSERT_EQ(collide(a, fa, b, fb, 0.15 * size, manifold), cores - a.radius - b.radius <= 0.15 * size)
        << trial;
  }
  EXPECT_GT(near, 15000);
}

TEST(RigidDistance, FastRodsNeverPassAPost) {
  // A rod of 1 mm that turns 100 times in the sweep is stopped before a post of 1 mm, at any place along its
  // half.
  const ConvexPiece rod = makePiece({{-0.5, -0.0005}, {0.5, -0.0005}, {0.5, 0.0005}, {-0.5, 0.0005}}, 0);
  const ConvexPiece post = makePiece({{0, 0}}, 0.0005);
  for (double place : {0.05, 0.2, 0.45, 0.499}) {
    const Sweep turning{{{0, 0}, {}}, {0, 0}, 200 * kPi}, still{{{0, place}, {}}, {}, 0};
    const std::optional<double> hit = timeOfImpact(rod, turning, post, still, 1e-4);
    ASSERT_TRUE(hit.has_value()) << place;
    EXPECT_LT(*hit, 0.25 / 100);
    const double distance = closestPoints(rod, frameAt(turning, *hit), post, still.start).distance;
    EXPECT_GE(distance, 1e-4);
    EXPECT_LE(distance, 1.01e-4);
  }
  const Sweep turning{{{0, 0}, {}}, {0, 0}, 200 * kPi}, far{{{0, 0.502}, {}}, {}, 0};
  EXPECT_FALSE(timeOfImpact(rod, turning, post, far, 1e-4).has_value());
}

TEST(RigidDistance, StraightHitsAreExact) {
  // Two disks head on meet when their gap is used up; sliding past at the target's distance is none.
  const ConvexPiece disk = makePiece({{0, 0}}, 0.5);
  const std::optional<double> hit =
      timeOfImpact(disk, {{{0, 0}, {}}, {6, 0}, 0}, disk, {{{5, 0}, {}}, {-2, 0}, 0}, 0.01);
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(*hit, 3.99 / 8, 1e-5);
  EXPECT_FALSE(
      timeOfImpact(disk, {{{0, 0}, {}}, {6, 0}, 0}, disk, {{{3, 1.02}, {}}, {}, 0}, 0.01).has_value());
  EXPECT_TRUE(
      timeOfImpact(disk, {{{0, 0}, {}}, {6, 0}, 0}, disk, {{{3, 1.005}, {}}, {}, 0}, 0.01).has_value());
}

TEST(RigidDistance, RandomSweepsStopBeforeTheFirstHit) {
  // Fine sampling finds no distance below the target before the returned share, and one at it.
  Dice dice(5);
  int hits = 0, misses = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const ConvexPiece a = randomPiece(dice, 1 + dice.below(6), 0.02),
                      b = randomPiece(dice, 1 + dice.below(6), 0.01);
    const Sweep sa{dice.frame(3), {dice.between(-4, 4), dice.between(-4, 4)}, dice.between(-20, 20)};
    const Sweep sb{dice.frame(3), {dice.between(-4, 4), dice.between(-4, 4)}, dice.between(-3, 3)};
    const double target = 0.005;
    if (closestPoints(a, sa.start, b, sb.start).distance <= target) continue;
    const std::optional<double> hit = timeOfImpact(a, sa, b, sb, target);
    (hit ? hits : misses) += 1;
    const double end = hit.value_or(1);
    for (int k = 0; k <= 400; ++k) {
      const double s = end * k / 400;
      ASSERT_GT(closestPoints(a, frameAt(sa, s), b, frameAt(sb, s)).distance, target - 1e-9) << trial;
    }
    if (hit) {
      ASSERT_LT(closestPoints(a, frameAt(sa, *hit), b, frameAt(sb, *hit)).distance, target * 1.002) << trial;
    }
  }
  EXPECT_GT(hits, 200);
  EXPECT_GT(misses, 300);
}

}  // namespace
}  // namespace smokebox
