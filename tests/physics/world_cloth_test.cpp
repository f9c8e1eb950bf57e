// Cloth in a world: a curtain seen from the front.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "world/world.h"

namespace smokebox {
namespace {

struct Curtain {
  double lowest = 1e9, highest = -1e9, smallest = 1e9;  // heights, m; area of a cell, of that when flat
  int turned = 0;                                       // cells seen from behind
};

Curtain look(const World& world) {
  Snapshot snapshot;
  world.capture(snapshot);
  const ClothPicture& cloth = snapshot.cloths.at(0);
  Curtain seen;
  for (const Vec2& p : cloth.positions) {
    seen.lowest = std::min(seen.lowest, p.y);
    seen.highest = std::max(seen.highest, p.y);
  }
  for (int j = 0; j + 1 < cloth.rows; ++j)
    for (int i = 0; i + 1 < cloth.columns; ++i) {
      const auto at = [&](int di, int dj) { return cloth.positions[i + di + (j + dj) * cloth.columns]; };
      const double area = 0.5 * cross(at(1, 1) - at(0, 0), at(0, 1) - at(1, 0));
      seen.turned += area < 0;
      seen.smallest = std::min(seen.smallest, area * (cloth.columns - 1) * (cloth.rows - 1));
    }
  return seen;
}

TEST(WorldCloth, WhatIsBlownOverItsRailHangsAgain) {
  // Truth: a curtain that a gale has blown up over the rail falls down again and hangs as it did before,
  // however stiff: no cell stays seen from behind, though its springs would have their lengths that way.
  for (const int stiffness : {100, 1000}) {
    World world(SceneDocument::parse(
                    "domain: {size: [4, 4], resolution: 32}\n"
                    "time: {step: 1/120, duration: 10}\n"
                    "gravity: [0, -10]\n"
                    "cloth: [{corner: [1.5, 1], size: [1, 1], cells: [12, 12], mass: 0.1, pinned: top, "
                    "linear_damping: 2, stiffness: " +
                        std::to_string(stiffness) +
                        "}]\n"
                        "events: [{at: 2, set: {gravity: [0, " +
                        std::to_string(8 * stiffness) +
                        "]}}, {at: 3, set: {gravity: [0, -10]}}]\n"
                        "view: {layers: [cloth]}\n",
                    "test.yaml"),
                {});
    auto run = [&](double until) {
      while (world.stepCount() < std::lround(until * 120)) world.step();
      return look(world);
    };
    const Curtain before = run(2), over = run(3), after = run(10);
    std::printf("curtain of %d N/m: %d cells blown over; hangs to %.4f, %.4f before; smallest cell %.3f\n",
                stiffness, over.turned, after.lowest, before.lowest, after.smallest);
    EXPECT_EQ(before.turned, 0);
    EXPECT_GT(over.turned, 100);
    EXPECT_GT(over.highest, 2.5);
    EXPECT_EQ(after.turned, 0);
    EXPECT_GT(after.smallest, 0.9);
    EXPECT_LT(after.highest, 2 + 1e-3);
    EXPECT_NEAR(after.lowest, before.lowest, 5e-3);
  }
}

}  // namespace
}  // namespace smokebox
