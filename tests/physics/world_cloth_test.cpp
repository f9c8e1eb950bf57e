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

World sheetWorld(const std::string& more) {
  return World(
      SceneDocument::parse("domain: {size: [4, 4], resolution: 32}\n"
                           "time: {step: 1/120, duration: 4}\n"
                           "cloth: [{name: s, corner: [1, 2], size: [1, 1], cells: [4, 4], mass: 2.5, "
                           "stiffness: 400" +
                               more + "view: {layers: [cloth]}\n",
                           "test.yaml"),
      {.figures = true});
}

TEST(WorldCloth, EventsReachItsParticles) {
  // Truth: an impulse on one of them is the cloth's momentum; one that is held stays where it is and the
  // others hang from it until it is released.
  World world = sheetWorld(
      ", pinned: none}]\n"
      "events:\n- {at: 0.1, impulse: {body: s.1.2, value: [2, -1]}}\n"
      "- {at: 0.2, hold: s.2.4}\n- {at: 0.2, set: {gravity: [0, -10]}}\n"
      "- {at: 2, release: s.2.4}\n");
  const auto run = [&](double until) {
    while (world.stepCount() < std::lround(until * 120)) world.step();
    Snapshot snapshot;
    world.capture(snapshot);
    return snapshot.cloths.at(0);
  };
  run(0.2);
  EXPECT_NEAR(world.figures().momentum.x, 2, 1e-9);
  EXPECT_NEAR(world.figures().momentum.y, -1, 1e-9);
  const Vec2 held = run(0.21).positions[22];
  const ClothPicture hanging = run(2);
  EXPECT_EQ(hanging.positions[22], held);
  for (int k = 0; k < 20; ++k) EXPECT_LT(hanging.positions[k].y, held.y);
  EXPECT_LT(run(2.25).positions[22].y, held.y - 0.1);
}

TEST(WorldCloth, AParticleThatIsRemovedLeavesAHole) {
  // Truth: the four cells around it are gone, with shear springs and without, and no thread leads to it.
  for (const char* shear : {"", ", shear: 0"}) {
    World world = sheetWorld(std::string(shear) + "}]\nevents: [{at: 0.1, remove: s.2.2}]\n");
    while (world.stepCount() < 60) world.step();
    Snapshot snapshot;
    world.capture(snapshot);
    const ClothPicture& cloth = snapshot.cloths.at(0);
    std::vector<char> whole(16, 1);
    for (const int cell : {5, 6, 9, 10}) whole[cell] = 0;
    EXPECT_EQ(cloth.whole, whole) << shear;
    for (const auto& thread : cloth.threads) EXPECT_TRUE(thread[0] != 12 && thread[1] != 12) << shear;
  }
}

}  // namespace
}  // namespace smokebox
