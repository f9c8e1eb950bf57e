// `simulate` and `plan`, and the figures that scripts rely on.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/run_program.h"

namespace smokebox {
namespace {

using Json = nlohmann::json;

Json figures(const std::filesystem::path& file) { return Json::parse(fileText(file)); }

TEST(Simulate, WritesTheFiguresOfEachStep) {
  // One record a step, with every name of the contract, and a summary.
  TemporaryFolder folder;
  writeText(folder / "scene.yaml", kSmallScene);
  const RunResult run =
      runProgram({"simulate", "scene.yaml", "--steps", "7", "--stats", "s.json"}, folder.path());
  ASSERT_EQ(run.status, 0) << run.err;
  const Json json = figures(folder / "s.json");
  ASSERT_EQ(json["steps"].size(), 7u);
  for (int k = 0; k < 7; ++k) {
    const Json& step = json["steps"][k];
    for (const char* name :
         {"step", "time", "ms", "iterations", "divergence", "compression", "smoke", "momentum",
          "angular_momentum", "energy", "contacts", "overlap", "bodies", "probes"})
      EXPECT_TRUE(step.contains(name)) << name;
    EXPECT_EQ(step["step"], k + 1);
    EXPECT_NEAR(step["time"].get<double>(), (k + 1) / 60.0, 1e-12);
    EXPECT_TRUE(step["ms"].contains("total"));
    for (const char* name : {"mass", "emitted", "left", "min", "max"})
      EXPECT_TRUE(step["smoke"].contains(name)) << name;
    EXPECT_EQ(step["momentum"].size(), 2u);
    for (const char* name : {"fluid", "bodies", "potential"})
      EXPECT_TRUE(step["energy"].contains(name)) << name;
    ASSERT_EQ(step["bodies"].size(), 1u);
    for (const char* name : {"name", "position", "angle", "velocity", "spin", "force", "torque"})
      EXPECT_TRUE(step["bodies"][0].contains(name)) << name;
    ASSERT_EQ(step["probes"].size(), 1u);
    for (const char* name : {"name", "velocity", "pressure", "smoke", "temperature", "mass"})
      EXPECT_TRUE(step["probes"][0].contains(name)) << name;
  }
  for (const char* name : {"scene", "version", "steps", "cells", "threads", "step_ms_median", "film_fps",
                           "divergence_max", "smoke_error", "overlap_max", "peak_memory_mb", "state_hash"})
    EXPECT_TRUE(json["summary"].contains(name)) << name;
  EXPECT_EQ(json["summary"]["scene"], "scene");
  EXPECT_EQ(json["summary"]["cells"], 32 * 16);
  EXPECT_LE(json["summary"]["divergence_max"].get<double>(), 1e-5);
  EXPECT_LE(std::abs(json["summary"]["smoke_error"].get<double>()), 1e-5);
}

TEST(Simulate, TellsOfABodyThatHasLeftOnce) {
  // One line on standard error names it; the figures list it until then, and its fall is that of g.
  TemporaryFolder folder;
  writeText(
      folder / "scene.yaml",
      "domain: {size: [2, 1], resolution: 32}\nwalls: {bottom: open}\ntime: {step: 1/60, duration: 1}\n"
      "output: {fps: 30}\ngravity: [0, -10]\nbodies: [{name: ball, shape: {circle: {radius: 0.1}}, position: "
      "[1, 0.8], mass: 2}]\n");
  const RunResult run = runProgram({"simulate", "scene.yaml", "--stats", "s.json"}, folder.path());
  ASSERT_EQ(run.status, 0) << run.err;
  const std::size_t first = run.err.find("warning: t = ");
  ASSERT_NE(first, std::string::npos) << run.err;
  EXPECT_NE(run.err.find("`ball` has left the domain", first), std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("ball", run.err.find("ball") + 1), std::string::npos) << run.err;
  const Json steps = figures(folder / "s.json")["steps"];
  EXPECT_EQ(steps[11]["bodies"][0]["name"], "ball");
  EXPECT_NEAR(steps[11]["bodies"][0]["position"][1].get<double>(), 0.8 - 0.2, 1e-9);
  EXPECT_NEAR(steps[11]["momentum"][1].get<double>(), -2 * 10 * 0.2, 0.2);
  EXPECT_NEAR(steps[11]["energy"]["potential"].get<double>(), 2 * 10 * 0.6, 1e-6);
  EXPECT_TRUE(steps[59]["bodies"].empty());
}

TEST(Simulate, HashDoesNotDependOnThreads) {
  // One and two threads end in the same state.
  TemporaryFolder folder;
  writeText(folder / "scene.yaml", kSmallScene);
  for (const char* threads : {"1", "2"}) {
    const RunResult run = runProgram({"simulate", "scene.yaml", "--steps", "100", "--threads", threads,
                                      "--stats", std::string(threads) + ".json"},
                                     folder.path());
    ASSERT_EQ(run.status, 0) << run.err;
  }
  const Json one = figures(folder / "1.json")["summary"], two = figures(folder / "2.json")["summary"];
  EXPECT_EQ(one["steps"], 100);
  EXPECT_EQ(two["threads"], 2);
  EXPECT_EQ(one["state_hash"], two["state_hash"]);
}

TEST(Simulate, RunsTheDurationOfTheScene) {
  // Without --steps there are duration / step of them, and the summary is on standard output.
  TemporaryFolder folder;
  writeText(folder / "scene.yaml", kSmallScene);
  const RunResult run = runProgram({"simulate", "scene.yaml"}, folder.path());
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("30 steps"), std::string::npos) << run.out;
  EXPECT_EQ(folder.names(), std::set<std::string>{"scene.yaml"});
}

TEST(Simulate, FiguresOfManyBodiesTakeNoMemory) {
  // A record goes to the file as soon as it is there: ten times the steps of a thousand bodies, the same
  // memory.
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "what is freed stays in quarantine";
#endif
  TemporaryFolder folder;
  writeText(folder / "scene.yaml",
            "domain: {size: [20, 20], resolution: 20}\ntime: {step: 1/60, duration: 2}\nbodies:\n"
            "  - {name: dot, shape: {circle: {radius: 0.1}}, position: [0.3, 0.3],\n"
            "     repeat: {grid: [40, 25], spacing: [0.45, 0.7]}}\n");
  double peak[2];
  for (const int k : {0, 1}) {
    const int steps = k == 0 ? 6 : 60;
    const RunResult run = runProgram(
        {"simulate", "scene.yaml", "--steps", std::to_string(steps), "--stats", "s.json"}, folder.path());
    ASSERT_EQ(run.status, 0) << run.err;
    const Json json = figures(folder / "s.json");
    ASSERT_EQ(json["steps"].size(), static_cast<std::size_t>(steps));
    const Json& last = json["steps"][steps - 1]["bodies"][999];
    EXPECT_EQ(last["name"], "dot.999");
    EXPECT_EQ(last["position"][0].get<double>(), 0.3 + 39 * 0.45);
    EXPECT_TRUE(last["torque"].is_number_float());
    peak[k] = json["summary"]["peak_memory_mb"].get<double>();
  }
  EXPECT_LT(peak[1], peak[0] + 20);  // a tree of all of it took 60 MB more
}

TEST(Simulate, FullDiskIsAnInputOutputError) {
  // Whether the figures or the summary do not fit, the status is 4.
  TemporaryFolder folder;
  writeText(folder / "scene.yaml", kSmallScene);
  const RunResult stats =
      runProgram({"simulate", "scene.yaml", "--steps", "1", "--stats", "/dev/full"}, folder.path());
  EXPECT_EQ(stats.status, 4);
  EXPECT_NE(stats.err.find("/dev/full: No space left"), std::string::npos) << stats.err;
  const RunResult summary =
      runProgram({"simulate", "scene.yaml", "--steps", "1"}, folder.path(), "/dev/full");
  EXPECT_EQ(summary.status, 4);
  EXPECT_NE(summary.err.find("standard output: No space left"), std::string::npos) << summary.err;
}

TEST(Simulate, FiguresThatCannotBeWrittenAreFoundBeforeTheRun) {
  // A folder that is not there is told before the first step, however long the scene.
  TemporaryFolder folder;
  writeText(folder / "scene.yaml", kSmallScene);
  const RunResult run = runProgram(
      {"simulate", "scene.yaml", "--steps", "1000000000", "--stats", "nowhere/s.json"}, folder.path());
  EXPECT_EQ(run.status, 4);
  EXPECT_NE(run.err.find("nowhere"), std::string::npos) << run.err;
}

TEST(Simulate, CtrlCEndsItWith130) {
  // An interrupted run says so by its status, and writes no figures.
  TemporaryFolder folder;
  writeText(folder / "scene.yaml", kSmallScene);
  ProgramRun run({"simulate", "scene.yaml", "--steps", "1000000000", "--stats", "s.json"}, folder.path());
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  run.signal(SIGINT);
  EXPECT_EQ(run.wait().status, 130);
  EXPECT_EQ(folder.names(), std::set<std::string>{"scene.yaml"});
}

TEST(Plan, SaysWhatIsModelledAndWhatNot) {
  // Cells, memory and stages of the scene are listed.
  TemporaryFolder folder;
  writeText(folder / "scene.yaml", kSmallScene);
  const RunResult run = runProgram({"plan", "scene.yaml"}, folder.path());
  EXPECT_EQ(run.status, 0) << run.err;
  for (const char* word : {"32 x 16 cells", "15 frames", "1 solids", "MB", "\n  + ", "\n  - "})
    EXPECT_NE(run.out.find(word), std::string::npos) << word << "\n" << run.out;
}

}  // namespace
}  // namespace smokebox
