// What events may do to a running world, and motions that go wrong: scenes whose outcome is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "world/ranges.h"
#include "world/world.h"

namespace smokebox {
namespace {

const std::string kBox = "domain: {size: [1, 1], resolution: 32}\ntime: {step: 1/60, duration: 1}\n";
const std::string kSource =
    "smoke: {sources: [{shape: {box: {size: [0.25, 0.25]}, position: [0.25, 0.25]}, rate: 4, color: red}]}\n";

World worldOf(const std::string& yaml) {
  return World(SceneDocument::parse(kBox + yaml, "test.yaml"), {.threads = 1, .figures = true});
}

void run(World& world, long steps) {
  while (world.stepCount() < steps) world.step();
}

double massOf(const Field& value, const Grid& grid, Vec2 from, Vec2 to) {
  double sum = 0;
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      const Vec2 at{(i + 0.5) * grid.h, (j + 0.5) * grid.h};
      if (at.x > from.x && at.x < to.x && at.y > from.y && at.y < to.y) sum += value(i, j) * grid.h * grid.h;
    }
  return sum;
}

TEST(WorldEvents, SourcesCanBeTakenAway) {
  // Truth: half a second of 4 per second over 1/16 m^2, and nothing after that.
  World world = worldOf(kSource + "events: [{at: 0.5, set: {smoke.sources: []}}]\n");
  run(world, 60);
  EXPECT_NEAR(world.figures().smoke.emitted, 0.125, 1e-6);
}

TEST(WorldEvents, SourcesCanComeLater) {
  // Truth: a fluid without any smoke until 0.5 s, then half a second of 4 per second over 1/16 m^2.
  World world = worldOf(
      "fluid: {}\nevents: [{at: 0.5, set: {smoke.sources: [{shape: {box: {size: [0.25, 0.25]}, position: "
      "[0.5, 0.5]}, rate: 4}]}}]\n");
  run(world, 60);
  EXPECT_NEAR(world.figures().smoke.emitted, 0.125, 1e-6);
}

TEST(WorldEvents, SourcesCanMoveAndTakeAnotherColour) {
  // Truth: fluid at rest, so that smoke stays where it was let out: red in the first place, blue in the
  // other.
  World world =
      worldOf(kSource +
              "events: [{at: 0.5, set: {smoke.sources.0.shape: {box: {size: [0.25, 0.25]}, position: "
              "[0.75, 0.75]}, smoke.sources.0.color: blue}}]\n");
  run(world, 60);
  const Smoke& smoke = world.smoke()->smoke();
  const Grid& grid = world.boundary().grid;
  ASSERT_GE(smoke.channels(), 2);
  const int blue = static_cast<int>(world.smoke()->colors().size()) - 1;
  EXPECT_NEAR(massOf(smoke.value(0), grid, {0, 0}, {0.5, 0.5}), 0.125, 1e-6);
  EXPECT_NEAR(massOf(smoke.value(0), grid, {0.5, 0.5}, {1, 1}), 0, 1e-6);
  double others = 0;
  for (int c = 1; c <= blue; ++c) others += massOf(smoke.value(c), grid, {0.5, 0.5}, {1, 1});
  EXPECT_NEAR(others, 0.125, 1e-6);
}

TEST(WorldEvents, AnInflowThatIsSetToAFormulaFollowsIt) {
  // Truth: between slip walls what comes in passes every section of the channel, so at the end the mean speed
  // across the middle is 2 t = 2, to what a divergence of 1e-5 in each of the cells before it can add up to.
  World world = worldOf(
      "walls: {left: {inflow: [1, 0]}, right: open}\n"
      "events: [{at: 0.5, set: {walls.left.inflow: [\"2*t\", 0]}}]\n");
  run(world, 60);
  const int n = world.boundary().grid.ny;
  double mean = 0;
  for (int j = 0; j < n; ++j) mean += world.fluid()->u()(n / 2, j) / n;
  EXPECT_NEAR(mean, 2, 4e-4);
}

TEST(WorldEvents, ProfilesThatBalanceNeedNoOpenWall) {
  // Truth: 6 y (1 - y) lets out 1 m^2/s, just what comes in; the sealed box has nothing left to spread.
  World world = worldOf(
      "walls: {left: {inflow: [1, 0]}, right: {inflow: [\"6*y*(1-y)\", 0]}}\nfluid: {velocity: [\"1\", "
      "\"0\"]}\n");
  run(world, 5);
  EXPECT_LT(std::fabs(world.figures().compression), 1e-6);
}

TEST(WorldEvents, AMotionThatIsNoNumberIsNamed) {
  // Truth: log of a negative number between 0.3 s and 0.32 s, at the step that ends at 19/60 s.
  World world = worldOf(
      "fluid: {}\nsolids: [{name: gate, shape: {circle: {radius: 0.1}}, position: [0.5, 0.5], motion: "
      "{expression: {x: \"(t > 0.3) && (t < 0.32) ? log(-t) : 0.5\"}}}]\n");
  run(world, 18);
  try {
    world.step();
    FAIL() << "no error";
  } catch (const SimulationError& error) {
    EXPECT_NE(std::string(error.what()).find("step 19 (t = 0.3167 s): the motion of the solid `gate`"),
              std::string::npos)
        << error.what();
  }
}

TEST(WorldEvents, ASolidThatFliesAwayIsForgotten) {
  // Truth: at t = 1 it is 1e217 m away, where its outline has no width in float64; the box is empty then.
  World world = worldOf(
      "fluid: {}\nsolids: [{shape: {circle: {radius: 0.1}}, motion: {expression: {x: \"exp(500*t)\", y: "
      "\"0.5\"}}}]\n");
  run(world, 60);
  EXPECT_EQ(world.boundary().volume(31, 16), 1);
}

TEST(WorldEvents, ASolidReportsItsMotionWithoutAFluid) {
  // Truth: 0.1 m/s and 90 degrees a second for a second, from (0.5, 0.5) and 30 degrees; no force.
  World world = worldOf(
      "solids: [{name: a, report: true, shape: {box: {size: [0.2, 0.1]}}, position: [0.5, 0.5], angle: 30, "
      "motion: {velocity: [0.1, 0], spin: 90}}]\n");
  run(world, 60);
  ASSERT_EQ(world.figures().bodies.size(), 1u);
  EXPECT_NEAR(world.figures().bodies[0].position.x, 0.6, 1e-12);
  EXPECT_NEAR(world.figures().bodies[0].angleDegrees, 120, 1e-9);
  EXPECT_EQ(world.figures().bodies[0].force, Vec2{});
}

TEST(WorldEvents, LayersCanBeSetWhileRangesAreFound) {
  // Truth: the path names the scene's own layers; what is in them when the ranges are found does not matter.
  const FilmRanges ranges =
      findRanges(SceneDocument::parse(
                     kBox + "walls: {left: {inflow: [0.9, 0]}, right: open}\nview: {layers: [solids, smoke, "
                            "{speed: {opacity: 0.5}}]}\n"
                            "events: [{at: 0.5, set: {view.layers.2.speed.opacity: 1}}]\n",
                     "test.yaml"),
                 1);
  EXPECT_EQ(ranges.speed[1], 1);
}

const std::string kPushed =
    "fluid: {}\nevents:\n"
    "- {at: 0, force: {circle: {center: [0.5, 0.5], radius: 0.2}, acceleration: [9, 0], for: 0.1}}\n";

bool shows(const World& world, LayerKind kind) {
  Snapshot snapshot;
  world.capture(snapshot);
  return snapshot.shows(kind);
}

TEST(WorldEvents, LayersAreShownFromTheMomentOn) {
  // Truth: shown at 0.5 s, its options set at 0.6 s, hidden at 0.75 s; what is not shown is not captured, and
  // the simulation does not depend on it.
  const std::string layers = "view: {layers: [time, {pressure: {opacity: 0.6, shown: false}}]}\n";
  World world = worldOf(layers + kPushed +
                        "- {at: 0.5, show: pressure}\n- {at: 0.6, set: {view.layers.pressure.opacity: 0.3}}\n"
                        "- {at: 0.75, hide: [pressure, time]}\n");
  Snapshot snapshot;
  world.capture(snapshot);
  EXPECT_EQ(snapshot.view.layers.size(), 1u);
  run(world, 30);
  EXPECT_FALSE(shows(world, LayerKind::pressure));
  run(world, 31);
  world.capture(snapshot);
  ASSERT_EQ(snapshot.view.layers.size(), 2u);
  EXPECT_EQ(snapshot.view.layers[1].opacity, 0.6);
  float largest = 0;
  for (int j = 0; j < 32; ++j)
    for (int i = 0; i < 32; ++i) largest = std::max(largest, std::fabs(snapshot.pressure(i, j)));
  EXPECT_GT(largest, 0);
  run(world, 40);
  world.capture(snapshot);
  ASSERT_EQ(snapshot.view.layers.size(), 2u);
  EXPECT_EQ(snapshot.view.layers[1].opacity, 0.3);
  run(world, 60);
  world.capture(snapshot);
  EXPECT_TRUE(snapshot.view.layers.empty());

  World plain = worldOf(layers + kPushed);
  run(plain, 60);
  EXPECT_EQ(plain.stateHash(), world.stateHash());
}

TEST(WorldEvents, RangesCountTheFramesThatShowTheField) {
  // Truth: a fluid at rest is pushed for a tenth of a second from the start. A pressure that is hidden at
  // first has the range of what is seen later, which is smaller; one that is never shown needs no run at all.
  auto range = [](const std::string& layer, const std::string& event, long& frames) {
    frames = 0;
    return findRanges(
        SceneDocument::parse(kBox + "view: {layers: [" + layer + "]}\n" + kPushed + event, "test.yaml"), 1,
        [&](long, long of) { frames = of; });
  };
  long frames = 0;
  const double always = range("pressure", "", frames).pressure[1];
  EXPECT_EQ(frames, 30);
  const double later =
      range("{pressure: {shown: false}}", "- {at: 0.5, show: pressure}\n", frames).pressure[1];
  EXPECT_EQ(frames, 30);
  EXPECT_LT(later, 0.5 * always);
  EXPECT_GT(later, 0);
  range("{pressure: {shown: false}}", "", frames);
  EXPECT_EQ(frames, 0);
  const auto given =
      range("{pressure: {shown: false, range: [-3, 3]}}", "- {at: 0.5, show: pressure}\n", frames);
  EXPECT_EQ(frames, 0);
  EXPECT_EQ(given.pressure[1], 3);
}

TEST(Ranges, TheLongestArrowIsTheFastestFluid) {
  // Truth: a uniform stream of 0.03 m/s; the arrows' speed is found unless their scale is given.
  auto fastest = [](const std::string& layer) {
    return findRanges(SceneDocument::parse(kBox +
                                               "walls: {left: {inflow: [0.03, 0]}, right: open}\nfluid: "
                                               "{velocity: [0.03, 0]}\nview: {layers: [" +
                                               layer + "]}\n",
                                           "test.yaml"),
                      1)
        .speed[1];
  };
  EXPECT_NEAR(fastest("velocity"), 0.03, 1e-6);
  EXPECT_EQ(fastest("{velocity: {scale: 1}}"), 1);
}

TEST(WorldCapture, ASolidOnAPeriodicSideIsSeenOnBoth) {
  // Truth: a disk of radius 0.1 at x = 0.95 also fills what is left of x = 0.05.
  World world = worldOf(
      "walls: {left: periodic, right: periodic}\nfluid: {}\n"
      "solids: [{name: a, shape: {circle: {radius: 0.1}}, position: [0.95, 0.5]}]\n");
  Snapshot snapshot;
  world.capture(snapshot);
  ASSERT_EQ(snapshot.solids.size(), 2u);
  double right = -1;
  for (const Vec2 point : snapshot.solids[1].outlines[0]) right = std::max(right, point.x);
  EXPECT_NEAR(right, 0.05, 1e-3);
}

}  // namespace
}  // namespace smokebox
