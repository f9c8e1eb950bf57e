// What figures and pictures say of collisions and springs, in cases whose numbers are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "world/world.h"

namespace smokebox {
namespace {

const std::string kRoom = "domain: {size: [4, 4], resolution: 32}\ntime: {step: 1/120, duration: 4}\n";
const std::string kGravity = "gravity: [0, -10]\n";

World worldOf(const std::string& yaml) {
  return World(SceneDocument::parse(kRoom + yaml, "test.yaml"), {.threads = 1, .figures = true});
}

TEST(WorldMarks, FiguresOfACollision) {
  // Truth: disks of 1 and 3 kg meet head on at 2 and 0 m/s with bounce 0.5. Their momentum stays 2 kg m/s and
  // their angular momentum about the origin -4; the energy falls from 2 J by mu v^2 (1 - e^2) / 2 = 1.125 J;
  // v1 = (m1 - e m2) v / M = -0.25, v2 = m1 (1 + e) v / M = 0.75 m/s. The one step in which they touch, and
  // part, says so.
  World world = worldOf(
      "bodies:\n- {name: a, shape: {circle: {radius: 0.2}}, position: [1, 2], velocity: [2, 0], mass: 1, "
      "bounce: 0.5}\n- {name: b, shape: {circle: {radius: 0.1}}, position: [2, 2], mass: 3}\n");
  int touched = 0;
  double before = 2;
  for (int k = 0; k < 120; ++k) {
    world.step();
    const StepFigures& f = world.figures();
    EXPECT_NEAR(f.momentum.x, 2, 1e-12);
    EXPECT_NEAR(f.momentum.y, 0, 1e-12);
    EXPECT_NEAR(f.angularMomentum, -4, 1e-12);
    EXPECT_EQ(f.contacts > 0, std::fabs(f.energyBodies - before) > 1e-9) << k;
    EXPECT_LE(f.overlap, 1e-6);
    touched += f.contacts;
    before = f.energyBodies;
  }
  EXPECT_EQ(touched, 1);
  EXPECT_NEAR(before, 2 - 1.125, 1e-9);
  const auto& bodies = world.figures().bodies;
  EXPECT_NEAR(bodies.at(0).velocity.x, -0.25, 1e-9);
  EXPECT_NEAR(bodies.at(1).velocity.x, 0.75, 1e-9);
}

TEST(WorldMarks, APairThatRattlesHasOneMark) {
  // Truth: a ball that is dropped from a millimetre bounces some thirty times in a second. Its first mark
  // stays for a quarter of a second, and the next one comes when it has faded: never two at once. A blow that
  // is much stronger is marked at once.
  World world = worldOf(kGravity +
                        "bodies: [{name: ball, shape: {circle: {radius: 0.1}}, position: [1, 0.101], bounce: "
                        "0.98}]\nevents: [{at: 1, impulse: {body: ball, value: [0, -0.1]}}]\n"
                        "view: {layers: [collisions]}\n");
  Snapshot snapshot;
  const auto marks = [&] {
    world.capture(snapshot);
    return std::count_if(snapshot.touches.begin(), snapshot.touches.end(),
                         [](const TouchPicture& touch) { return touch.approach > 0; });
  };
  int marked = 0;
  double age = 1;
  while (world.stepCount() < 119) {
    world.step();
    ASSERT_LE(marks(), 1) << world.stepCount();
    if (marks() == 0) continue;
    const double now = snapshot.touches[0].age;
    marked += now < age;
    age = now;
  }
  EXPECT_GE(marked, 3);
  EXPECT_LE(marked, 4);
  for (int k = 0; k < 12; ++k) world.step();
  marks();
  const auto strongest =
      std::max_element(snapshot.touches.begin(), snapshot.touches.end(),
                       [](const TouchPicture& p, const TouchPicture& q) { return p.approach < q.approach; });
  ASSERT_NE(strongest, snapshot.touches.end());
  EXPECT_GT(strongest->approach, 2);
  EXPECT_LT(strongest->age, 0.1);
}

TEST(WorldMarks, SpringsAreComparedWithTheLargestLoad) {
  // Truth: the weights on two springs are 10 and 30 N, and a third is stretched by 0.5 m at 20 N/m: 30 N is
  // the most. The tension of the spring that hangs at rest is its weight, however soft it is.
  World world = worldOf(kGravity +
                        "bodies:\n- {name: a, shape: {circle: {radius: 0.1}}, position: [1, 2], mass: 1}\n"
                        "- {name: b, shape: {circle: {radius: 0.1}}, position: [2, 2], mass: 3}\n"
                        "springs:\n- {from: {body: a}, to: {point: [1, 3.5]}, length: 1.4, stiffness: 100}\n"
                        "- {from: {body: b}, to: {point: [2, 3.5]}, stiffness: 50, damping: 40}\n"
                        "- {from: {point: [3, 1]}, to: {body: a, at: [0, 0]}, length: 1.736, stiffness: 20}\n"
                        "view: {layers: [springs]}\n");
  Snapshot snapshot;
  world.capture(snapshot);
  EXPECT_NEAR(snapshot.usualTension, 30, 1e-9);
  while (world.stepCount() < 480) world.step();
  world.capture(snapshot);
  EXPECT_NEAR(snapshot.springs.at(1).tension, 30, 0.3);
}

}  // namespace
}  // namespace smokebox
