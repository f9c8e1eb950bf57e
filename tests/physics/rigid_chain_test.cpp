// Chains, loads and welds: joints are as stiff as they say, at any step and ratio of masses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "base/maths.h"
#include "support/links_world.h"

namespace smokebox {
namespace {

using test::LinksWorld;

constexpr double kGravity = 9.81;

TEST(RigidChain, HangsAsACatenary) {
  // Truth: y = a cosh(x / a) with 2 a sinh(1 / (2 a)) = S between ends 1 m apart at the same height; sag
  // a (cosh(1 / (2 a)) - 1), tension at the ends w a cosh(1 / (2 a)). Fifty uniform rods; within 0.5%, 1%.
  // The tangents of rigid links grow linearly along it: a discrete catenary, exact.
  for (const double size : {1.05, 1.2, 1.5, 2.0}) {
    double a = 0.2;
    for (int k = 0; k < 100; ++k) {
      const double f = 2 * a * std::sinh(0.5 / a) - size;
      a -= f / (2 * std::sinh(0.5 / a) - std::cosh(0.5 / a) / a);
    }
    const double sag = a * (std::cosh(0.5 / a) - 1), tension = a * std::cosh(0.5 / a);  // of weight 1 N/m

    LinksWorld world;
    world.gravity = {0, -kGravity};
    world.drag = 4;
    const int links = 50;
    const double link = size / links, depth = std::sqrt(size * size / 4 - 0.25);
    const double mass = link / kGravity;
    std::vector<int> joints;
    for (int k = 0; k < links; ++k) {  // in a V
      const bool down = k < links / 2;
      const double along = down ? k + 0.5 : links - k - 0.5;
      const Vec2 centre{down ? along / links : 1 - along / links, -depth * along / (0.5 * links)};
      // A rod points down along its own -y.
      const Vec2 way = 1 / size * Vec2{1, down ? -2 * depth : 2 * depth};
      world.rod(centre, link, mass, std::atan2(way.x, -way.y));
      joints.push_back(world.joint(JointKind::pin, k ? Anchor{k - 1, {0, -link / 2}} : Anchor{-1, {0, 0}},
                                   {k, {0, link / 2}}));
    }
    joints.push_back(world.joint(JointKind::pin, {links - 1, {0, -link / 2}}, {-1, {1, 0}}));
    for (int k = 0; k < 1200; ++k) world.step(1.0 / 60, 16);

    double stretch = 0, uneven = 0, lowest = 0;
    for (const int joint : joints) stretch = std::max(stretch, world.gap(joint) / link);
    auto slope = [&](int k) {
      const double angle = world.bodies.angleRad[k];
      return -std::cos(angle) / std::sin(angle);
    };
    const double step = (slope(links - 1) - slope(0)) / (links - 1);
    for (int k = 0; k < links; ++k) {
      uneven = std::max(uneven, std::fabs(slope(k) - slope(0) - k * step));
      lowest = std::min(lowest, world.point({k, {0, -link / 2}}).y);
    }
    std::printf("chain of %.2f m: sag off by %.1e, tension by %.1e, links by %.1e, tangents by %.1e\n", size,
                -lowest / sag - 1, world.joints.tension(joints[0]) / tension - 1, stretch, uneven);
    EXPECT_NEAR(-lowest, sag, 5e-4 * sag);
    EXPECT_NEAR(world.joints.tension(joints[0]), tension, 2e-3 * tension);
    EXPECT_LT(stretch, 1e-9);
    EXPECT_LT(uneven, 1e-6 * std::fabs(slope(0)));
  }
}

TEST(RigidChain, CarriesAThousandTimesALinksMass) {
  // Truth: the pins of a light chain stay closed, to 1e-4 of a link, under a load of a thousand links' mass
  // that falls from the horizontal, at large and small steps; nothing gains energy.
  for (const double dt : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
    LinksWorld world;
    world.gravity = {0, -kGravity};
    std::vector<int> joints;
    for (int k = 0; k < 10; ++k) {
      world.rod({0.1 * k + 0.05, 0}, 0.1, 0.001, kPi / 2);
      joints.push_back(
          world.joint(JointKind::pin, k ? Anchor{k - 1, {0, -0.05}} : Anchor{-1, {0, 0}}, {k, {0, 0.05}}));
    }
    const int load = world.add({1.1, 0}, 1, 0.005);
    joints.push_back(world.joint(JointKind::pin, {9, {0, -0.05}}, {load, {-0.1, 0}}));
    const double start = world.potential();
    double gap = 0, gain = -1e9;
    for (int k = 0; k < std::lround(10 / dt); ++k) {
      world.step(dt, 16);
      for (const int joint : joints) gap = std::max(gap, world.gap(joint) / 0.1);
      gain = std::max(gain, world.kinetic() + world.potential() - start);
    }
    std::printf(
        "load of 1000 links, steps of 1/%.0f s: pins open by %.1e of a link, energy at most %+.1e J\n",
        1 / dt, gap, gain);
    EXPECT_LT(gap, 1e-4);
    EXPECT_LT(gain, 0.02 * kGravity);  // 2% of what the fall has
  }
}

TEST(RigidChain, ALoadAtRestPullsWithItsWeight) {
  // Truth: at rest every pin of a light hanging chain carries what hangs below it, exactly.
  LinksWorld world;
  world.gravity = {0, -kGravity};
  std::vector<int> joints;
  for (int k = 0; k < 20; ++k) {
    world.rod({0, -0.05 * k - 0.025}, 0.05, 0.001);
    joints.push_back(
        world.joint(JointKind::pin, k ? Anchor{k - 1, {0, -0.025}} : Anchor{-1, {0, 0}}, {k, {0, 0.025}}));
  }
  const int load = world.add({0, -1.1}, 10, 0.05);
  joints.push_back(world.joint(JointKind::pin, {19, {0, -0.025}}, {load, {0, 0.1}}));
  for (int k = 0; k < 60; ++k) world.step(1.0 / 60, 16);
  for (int k = 0; k <= 20; ++k)
    EXPECT_NEAR(world.joints.tension(joints[k]), kGravity * (10 + 0.001 * (20 - k)), 1e-7);
  EXPECT_NEAR(world.bodies.position[load].y, -1.1, 1e-12);
}

TEST(RigidChain, AWeldedCantileverDoesNotDroop) {
  // Truth: ten boxes welded in a row to a wall are one rigid beam; its root holds m g L / 2. Welded twice
  // over, and at its far end too, nothing changes.
  LinksWorld world;
  world.gravity = {0, -kGravity};
  for (int k = 0; k < 10; ++k) {
    world.add({0.1 + 0.2 * k, 0}, 1, 0.04 * 2 / 12);
    world.joint(JointKind::weld, k ? Anchor{k - 1, {0.1, 0}} : Anchor{-1, {0, 0}}, {k, {-0.1, 0}});
  }
  auto droop = [&] {
    double most = 0;
    for (int k = 0; k < 300; ++k) {
      world.step(1.0 / 60, 16);
      most = std::max({most, std::fabs(world.bodies.angleRad[9]), std::fabs(world.bodies.position[9].y)});
    }
    return most;
  };
  const double alone = droop();
  EXPECT_NEAR(std::fabs(world.joints.torque(0)), 10 * kGravity * 1, 1e-6);
  world.joint(JointKind::weld, {3, {0.1, 0}}, {4, {-0.1, 0}});
  world.joint(JointKind::weld, {-1, {2, 0}}, {9, {0.1, 0}});
  const double twice = droop();
  std::printf("cantilever of 10 boxes: droops by %.1e; welded twice %.1e\n", alone, twice);
  EXPECT_LT(alone, 1e-10);
  EXPECT_LT(twice, 1e-8);
}

}  // namespace
}  // namespace smokebox
