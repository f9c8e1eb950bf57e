// Strings and ropes that hang between two nails, against the catenary.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "support/links_world.h"
#include "support/rigid_reference.h"

namespace smokebox {
namespace {

using test::LinksWorld;
using test::RigidReference;
using test::rigidReference;

constexpr double kGravity = 9.81;
constexpr int kPieces = 50;

/// Masses of 1 N for every metre along a V of length `size` between nails at (0, 0) and (1, 0); body k is at
/// the end of piece k.
LinksWorld hungMasses(double size) {
  LinksWorld world;
  world.gravity = {0, -kGravity};
  world.drag = 4;
  const double depth = std::sqrt(size * size / 4 - 0.25);
  for (int k = 1; k < kPieces; ++k) {
    const double x = static_cast<double>(k) / kPieces;
    world.particle({x, -2 * depth * std::min(x, 1 - x)}, size / kPieces / kGravity);
  }
  return world;
}

Anchor endOf(int piece) {
  if (piece < 0) return {-1, {0, 0}};
  if (piece == kPieces - 1) return {-1, {1, 0}};
  return {piece, {}};
}

TEST(RigidString, OfStiffSpringsHangsAsACatenary) {
  // Truth: RB13; fifty springs, too stiff to stretch by more than 0.2%: sag within 0.5%, tension at the nails
  // within 1%.
  for (const char* size : {"1.05", "1.2", "1.5", "2"}) {
    const double length = std::stod(size), piece = length / kPieces;
    LinksWorld world = hungMasses(length);
    for (int k = 0; k < kPieces; ++k) world.spring(endOf(k - 1), endOf(k), piece, 2e4 / piece, 1);
    for (int step = 0; step < 1200; ++step) world.step(1.0 / 60, 16);
    double lowest = 0, longest = 0;
    for (int k = 0; k < kPieces; ++k) {
      const Vec2 a = world.point(endOf(k - 1)), b = world.point(endOf(k));
      lowest = std::min(lowest, b.y);
      longest = std::max(longest, smokebox::length(b - a) / piece - 1);
    }
    const RigidReference sag = rigidReference("RB13", std::string("sag of S ") + size),
                         tension = rigidReference("RB13", std::string("tension of S ") + size);
    // Half a piece's weight hangs on the nail itself.
    const Vec2 first = world.point(endOf(0));
    const Vec2 held = world.springs.tension(0) / smokebox::length(first) * first - Vec2{0, 0.5 * piece};
    const double pull = smokebox::length(held);
    std::printf(
        "string of %s m: sag off by %.1e, tension by %.1e, stretched by %.1e, still moves by %.1e J\n", size,
        -lowest / sag.value - 1, pull / tension.value - 1, longest, world.kinetic());
    EXPECT_NEAR(-lowest, sag.value, sag.tolerance * sag.value);
    EXPECT_NEAR(pull, tension.value, tension.tolerance * tension.value);
    EXPECT_LT(longest, 2e-3);
    EXPECT_LT(world.kinetic(), 1e-12);
  }
}

TEST(RigidString, OfRopesHangsInStepsOfItsWeight) {
  // Truth: RB14; links without mass between equal masses: tan(angle) grows from link to link by a mass's
  // weight over the horizontal tension, which is the same in all of them.
  const RigidReference even = rigidReference("RB14", "step of slopes");
  for (const double length : {1.05, 1.5, 2.0}) {
    const double piece = length / kPieces;
    LinksWorld world = hungMasses(length);
    for (int k = 0; k < kPieces; ++k) {
      JointDef def;
      def.kind = JointKind::rope;
      def.a = endOf(k - 1), def.b = endOf(k);
      def.length = piece;
      world.joints.add(def, world.bodies);
    }
    for (int step = 0; step < 1800; ++step) world.step(1.0 / 60, 16);
    double worst = 0, across = 0, before = 0;
    for (int k = 0; k < kPieces; ++k) {
      const Vec2 d = world.point(endOf(k)) - world.point(endOf(k - 1));
      const double slope = d.y / d.x, pull = world.joints.tension(k) * d.x / smokebox::length(d);
      if (k == 0)
        across = pull;
      else
        worst =
            std::max({worst, std::fabs((slope - before) * across / piece - 1), std::fabs(pull / across - 1)});
      before = slope;
      EXPECT_NEAR(smokebox::length(d), piece, 1e-9 * piece);
    }
    std::printf("ropes of %.2f m: steps of slope and pull off by %.1e\n", length, worst);
    EXPECT_LT(worst, even.tolerance);
  }
}

}  // namespace
}  // namespace smokebox
