#include "world/world.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "world/plan.h"
#include "world/ranges.h"

namespace smokebox {
namespace {

World worldOf(const std::string& yaml, int threads = 1) {
  return World(SceneDocument::parse(yaml, "test.yaml"), {.threads = threads, .figures = true});
}

double largestSpeed(const World& world) {
  const Grid& grid = world.boundary().grid;
  double largest = 0;
  for (int j = 0; j <= grid.ny; ++j)
    for (int i = 0; i <= grid.nx; ++i)
      largest = std::max<double>(
          {largest, std::fabs(world.fluid()->u()(i, j)), std::fabs(world.fluid()->v()(i, j))});
  return largest;
}

// Every scene that is shipped, on a coarser grid and for a part of a second.
std::vector<std::filesystem::path> shippedScenes() {
  std::vector<std::filesystem::path> scenes;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(SMOKEBOX_SOURCE_DIR "/scenes"))
    if (entry.path().extension() == ".yaml") scenes.push_back(entry.path());
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

TEST(World, ASceneWithoutFluidBuildsNone) {
  // Truth: no fluid, smoke or inflow is named, so there is no field and no memory.
  World world = worldOf(
      "domain: {size: [1, 1], resolution: 64}\nsolids: [{shape: {circle: {radius: 0.1}}, position: [0.5, "
      "0.5]}]\n");
  world.step();
  EXPECT_EQ(world.fluid(), nullptr);
  EXPECT_EQ(world.bytes(), 0u);
}

TEST(World, FluidAtRestUnderGravityStaysAtRest) {
  // Truth: a fluid of one density has no weight of its own to move it; the largest speed stays 0.
  World world = worldOf(
      "domain: {size: [1, 1], resolution: 48}\ngravity: [0, -9.81]\nfluid: {}\n"
      "solids: [{shape: {circle: {radius: 0.2}}, position: [0.5, 0.5]}]\n");
  for (int k = 0; k < 100; ++k) world.step();
  EXPECT_EQ(largestSpeed(world), 0);
}

TEST(World, UniformFlowBetweenSlipWallsStaysUniform) {
  // Truth: u = 1, v = 0 solves the equations exactly.
  World world = worldOf(
      "domain: {size: [2, 1], resolution: 64}\nwalls: {left: {inflow: [1, 0]}, right: open}\n"
      "fluid: {velocity: [\"1\", \"0\"]}\ntime: {step: 1/60}\n");
  for (int k = 0; k < 50; ++k) world.step();
  const Grid& grid = world.boundary().grid;
  double off = 0;
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i <= grid.nx; ++i) off = std::max<double>(off, std::fabs(world.fluid()->u()(i, j) - 1));
  EXPECT_LT(off, 1e-5);
}

TEST(World, AForceOnTheWholeOfAPeriodicBoxGivesItsImpulse) {
  // Truth: nothing resists, so 2 m/s^2 for 0.5 s makes the velocity 1 m/s everywhere, and no more afterwards.
  World world = worldOf(
      "domain: {size: [1, 1], resolution: 32}\nwalls: {left: periodic, right: periodic, bottom: periodic, "
      "top: periodic}\n"
      "fluid: {density: 3}\ntime: {step: 1/60, duration: 1}\n"
      "events: [{at: 0.1, force: {box: {size: [1, 1]}, position: [0.5, 0.5], acceleration: [2, 0], for: "
      "0.5}}]\n");
  for (int k = 0; k < 60; ++k) world.step();
  EXPECT_NEAR(world.figures().momentum.x, 3.0, 1e-4);  // density x area x velocity
  EXPECT_NEAR(world.figures().momentum.y, 0, 1e-6);
}

TEST(World, SmokeIsConservedWhileAFanStirsIt) {
  // Truth: in a closed box what is there is what was given: 1000 steps of a rotating fan and a moving block
  // lose nothing.
  World world = worldOf(
      "domain: {size: [2, 1], resolution: 96}\ntime: {step: 1/60, duration: 20}\nfluid: {vorticity: 0.2}\n"
      "smoke: {buoyancy: 0.3, sources: [{shape: {circle: {center: [0.6, 0.5], radius: 0.1}}, rate: 1, until: "
      "5}]}\n"
      "solids:\n"
      "  - {name: fan, shape: {box: {size: [0.5, 0.04]}}, position: [0.6, 0.5], motion: {velocity: [0, 0], "
      "spin: 200}}\n"
      "  - {name: block, shape: {box: {size: [0.15, 0.2]}}, motion: {expression: {x: \"1.4 + 0.3*sin(t)\", "
      "y: \"0.5\"}}}\n");
  double error = 0, lowest = 0;
  for (int k = 0; k < 1000; ++k) {
    world.step();
    error = std::max(error, std::fabs(world.summary().smokeError));
    lowest = std::min(lowest, world.figures().smoke.min);
  }
  RecordProperty("smoke_error", std::to_string(error));
  EXPECT_LT(error, 1e-6);
  EXPECT_GE(lowest, 0);
  EXPECT_GT(world.figures().smoke.mass, 0.1);
}

TEST(World, DivergenceStaysUnderTheToleranceInEveryShippedScene) {
  // Truth: section 3 of the design, 1e-5 in the worst cell of every step.
  for (const auto& scene : shippedScenes()) {
    SceneDocument document = SceneDocument::load(scene);
    const SceneSpec full = document.spec();
    document.set("domain.resolution", std::to_string(full.domain.grid.nx / 4), {});
    World world(document, {.threads = 1, .figures = false});
    for (int k = 0; k < 60; ++k) {
      world.step();
      ASSERT_LE(world.figures().divergence, 1e-5) << scene << ", step " << k + 1;
    }
  }
}

TEST(World, StateIsTheSameToTheBitForOneAndTwoThreads) {
  // Truth: section 6 of the design, after 100 steps of every shipped scene.
  for (const auto& scene : shippedScenes()) {
    SceneDocument document = SceneDocument::load(scene);
    document.set("domain.resolution", std::to_string(document.spec().domain.grid.nx / 2), {});
    World one(document, {.threads = 1, .figures = false}), two(document, {.threads = 2, .figures = false});
    for (int k = 0; k < 100; ++k) {
      one.step();
      two.step();
    }
    EXPECT_EQ(one.stateHash(), two.stateHash()) << scene;
  }
}

TEST(World, SmokeValuesAddUpToItsMass) {
  // Truth: smoke is its value times the open area, cell by cell; none may be shown thinner than it is,
  // whatever cells a step has merged beside the car.
  SceneDocument document = SceneDocument::load(SMOKEBOX_SOURCE_DIR "/scenes/paper/fig20-car.yaml");
  document.set("domain.resolution", "256", {});
  document.set("time.step", "1/60", {});
  World world(document, {.threads = 2, .figures = true});
  const Grid& grid = world.boundary().grid;
  for (int k = 0; k < 240; ++k) {
    world.step();
    double sum = 0;
    for (int c = 0; c < world.smoke()->smoke().channels(); ++c)
      for (int j = 0; j < grid.ny; ++j)
        for (int i = 0; i < grid.nx; ++i)
          sum += double{world.smoke()->smoke().value(c)(i, j)} * world.boundary().volume(i, j);
    const double mass = world.figures().smoke.mass;
    ASSERT_NEAR(sum * grid.h * grid.h, mass, 1e-4 * mass) << "step " << k + 1;
  }
}

TEST(World, AMirrorSymmetricSceneStaysSymmetric) {
  // Truth: mirrored in the line x = 1 the scene is itself, so v is even and u is odd.
  World world = worldOf(
      "domain: {size: [2, 2], resolution: 64}\nfluid: {}\n"
      "smoke: {buoyancy: 1, sources: [{shape: {circle: {center: [1, 0.3], radius: 0.15}}, rate: 2}]}\n"
      "solids: [{shape: {circle: {radius: 0.2}}, position: [1, 1.1]}]\n");
  for (int k = 0; k < 200; ++k) world.step();
  const Grid& grid = world.boundary().grid;
  double off = 0;
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i)
      off =
          std::max<double>(off, std::fabs(world.fluid()->v()(i, j) - world.fluid()->v()(grid.nx - 1 - i, j)));
  EXPECT_LT(off / largestSpeed(world), 1e-4);
}

TEST(World, EventsChangeWhatTheySayWhenTheySay) {
  // Truth: the event at 0.1 s acts at the first step that begins at 0.1 s, the sixth of 1/50 s; the stop
  // holds the pose.
  World world = worldOf(
      "domain: {size: [1, 1], resolution: 32}\ntime: {step: 1/50, duration: 1}\noutput: {fps: 25}\nfluid: "
      "{}\n"
      "solids: [{name: a, shape: {circle: {radius: 0.05}}, position: [0.3, 0.5], motion: {velocity: [1, "
      "0]}},\n"
      "         {name: b, shape: {circle: {radius: 0.05}}, position: [0.3, 0.2], motion: {velocity: [1, "
      "0]}}]\n"
      "smoke: {sources: []}\n"
      "events:\n"
      "  - {at: 0.1, set: {fluid.density: 2}}\n"
      "  - {at: 0.2, stop: a}\n"
      "  - {at: 0.2, set: {solids.b.motion.velocity: [0, 1]}}\n"
      "  - {at: 0.1, hide: a}\n"
      "  - {at: 0.3, caption: {text: hello, for: 0.1}}\n"
      "  - {every: 0.1, from: 0, until: 0.25, burst: {circle: {center: [0.8, 0.8], radius: 0.1}, smoke: "
      "1}}\n");
  for (int k = 0; k < 5; ++k) world.step();
  EXPECT_EQ(world.spec().fluid.density, 1.2);
  world.step();
  EXPECT_EQ(world.spec().fluid.density, 2);
  EXPECT_FALSE(world.solids().shown(0));
  for (int k = 6; k < 16; ++k) world.step();
  EXPECT_NEAR(world.solids().pose(0).position.x, 0.5, 1e-12);
  EXPECT_NEAR(world.solids().pose(1).position.x, 0.5, 1e-12);
  EXPECT_NEAR(world.solids().pose(1).position.y, 0.2 + 6 * 0.02, 1e-12);
  Snapshot snapshot;
  world.capture(snapshot);
  ASSERT_EQ(snapshot.captions.size(), 1u);
  EXPECT_EQ(snapshot.captions[0], "hello");
  EXPECT_EQ(snapshot.solids.size(), 1u);
  // Bursts at 0, 0.1 and 0.2: three disks' worth.
  EXPECT_NEAR(world.figures().smoke.emitted, 3 * M_PI * 0.01, 2e-4);
}

TEST(World, AMovingBoxOfSmokeLosesNothing) {
  // Truth: walls thinner than a cell part the smoke inside from the air outside, wherever the box goes and
  // turns.
  World world = worldOf(
      "domain: {size: [2, 2], resolution: 64}\ntime: {step: 1/120, duration: 4}\nfluid: {}\n"
      "smoke: {sources: []}\n"
      "solids:\n"
      "  - name: box\n"
      "    shape:\n"
      "      union:\n"
      "        - {box: {size: [0.72, 0.012]}, position: [0, 0.35]}\n"
      "        - {box: {size: [0.72, 0.012]}, position: [0, -0.35]}\n"
      "        - {box: {size: [0.012, 0.72]}, position: [0.35, 0]}\n"
      "        - {box: {size: [0.012, 0.72]}, position: [-0.35, 0]}\n"
      "    position: [0.7, 1]\n"
      "    motion: {velocity: [0.15, 0.02], spin: 40}\n"
      "events: [{at: 0, burst: {circle: {radius: 0.2}, position: [0.7, 1], smoke: 1}}]\n"
      "probes: [{name: inside, region: {box: {size: [0.7, 0.7]}, position: [0.7, 1]}, follow: box}]\n");
  for (int k = 0; k < 480; ++k) world.step();
  const double given = world.figures().smoke.emitted;
  ASSERT_GT(given, 0.1);
  EXPECT_NEAR(world.figures().probes.at(0).mass / given, 1,
              1e-3);  // the probe's own edge cuts cells along the walls
  EXPECT_LT(std::fabs(world.summary().smokeError), 1e-6);
}

TEST(World, APistonInASealedBoxReportsCompression) {
  // Truth: the piston takes volume at 0.2 m x 0.1 m/s from a region of (1 - solid) m^2.
  World world = worldOf(
      "domain: {size: [1, 1], resolution: 40}\ntime: {step: 1/60, duration: 1}\nfluid: {}\n"
      "solids: [{name: piston, shape: {box: {size: [0.4, 0.2]}}, position: [0, 0.5], motion: {velocity: "
      "[0.1, 0]}}]\n");
  for (int k = 0; k < 20; ++k) {
    world.step();
    EXPECT_LE(world.figures().divergence, 1e-5);
  }
  const double area = 1 - 0.2 * (0.2 + 0.1 * 20 / 60);
  EXPECT_NEAR(std::fabs(world.figures().compression), 0.2 * 0.1 / area, 0.03 * 0.02 / area);
}

TEST(Ranges, OfAStreamPastADiskAreThoseOfPotentialFlow) {
  // Truth: slip flow past a disk reaches twice the speed of the stream, U = 1.5 m/s, and some more between
  // near walls; the range given by the scene is taken as it is, and a film of a third of a second will do.
  const FilmRanges ranges = findRanges(
      SceneDocument::parse(
          "domain: {size: [4, 4], resolution: 256}\nwalls: {left: {inflow: [1.5, 0]}, right: open}\n"
          "time: {step: 1/120, duration: 1/3}\nfluid: {velocity: [\"1.5\", \"0\"]}\n"
          "solids: [{shape: {circle: {radius: 0.5}}, position: [2, 2]}]\n"
          "view: {layers: [speed, {pressure: {range: [-7, 3]}}]}\n",
          "t"),
      1);
  EXPECT_GE(ranges.speed[1], 3);
  EXPECT_LE(ranges.speed[1], 4);
  EXPECT_EQ(ranges.pressure[0], -7);
  EXPECT_EQ(ranges.pressure[1], 3);
}

TEST(Ranges, NiceCeilingIsRoundAndNotBelow) {
  // Truth: 1, 1.5, 2, 3, 4, 5, 6, 8 or 10 times a power of ten.
  EXPECT_DOUBLE_EQ(niceCeiling(1), 1);
  EXPECT_DOUBLE_EQ(niceCeiling(1.2), 1.5);
  EXPECT_DOUBLE_EQ(niceCeiling(0.0321), 0.04);
  EXPECT_DOUBLE_EQ(niceCeiling(870), 1000);
}

TEST(Plan, NamesWhatIsModelledAndWhatIsNot) {
  // Truth: a scene without viscosity, smoke or solids has none of their stages.
  const Plan plan = planOf(
      SceneDocument::parse("domain: {size: [2, 1], resolution: 64}\nfluid: {vorticity: 0.1}\n", "t").spec());
  EXPECT_EQ(plan.cells, 64 * 32);
  auto modelled = [&](const std::string& stage) {
    for (const PlanLine& line : plan.lines)
      if (line.stage == stage) return line.modelled;
    ADD_FAILURE() << stage;
    return false;
  };
  EXPECT_TRUE(modelled("fluid"));
  EXPECT_FALSE(modelled("fields in pictures"));
  EXPECT_TRUE(modelled("vorticity confinement"));
  EXPECT_FALSE(modelled("viscosity"));
  EXPECT_FALSE(modelled("smoke"));
}

TEST(Plan, SaysWhichFieldsThePicturesShow) {
  // Truth: a layer that is hidden at first is in the plan if an event shows it, by its name or in a new list.
  auto fields = [](const std::string& layers, const std::string& events) {
    const Plan plan = planOf(SceneDocument::parse("domain: {size: [2, 1], resolution: 64}\nfluid: {}\nview: "
                                                  "{layers: [" +
                                                      layers + "]}\nevents: [" + events + "]\n",
                                                  "t")
                                 .spec());
    for (const PlanLine& line : plan.lines)
      if (line.stage == "fields in pictures") return (line.modelled ? "+ " : "- ") + line.why;
    return std::string();
  };
  EXPECT_EQ(fields("smoke, velocity, pressure", ""), "+ pressure, velocity");
  EXPECT_EQ(fields("{pressure: {shown: false}}", ""), "- pressure is hidden, and no event shows it");
  EXPECT_EQ(fields("{pressure: {shown: false}}", "{at: 1, hide: pressure}"),
            "- pressure is hidden, and no event shows it");
  EXPECT_EQ(fields("speed, {pressure: {shown: false}}", "{at: 1, show: pressure}"),
            "+ pressure (when an event shows it), speed");
  EXPECT_EQ(fields("{pressure: {shown: false}}", "{at: 1, set: {view.layers.0.pressure.shown: true}}"),
            "+ pressure (when an event shows it)");
  EXPECT_EQ(fields("{pressure: {shown: false}}, smoke", "{at: 1, set: {view.layers.1.smoke.opacity: 0}}"),
            "- pressure is hidden, and no event shows it");
}

}  // namespace
}  // namespace smokebox
