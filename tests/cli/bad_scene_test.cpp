// Bad scenes: a line with file, line and column for each problem, and the right status, from every command.
#include <gtest/gtest.h>

#include <regex>

#include "support/run_program.h"

namespace smokebox {
namespace {

struct BadScene {
  const char* name;
  std::string text;
  int line;          // of the problem; 0: not looked at
  const char* says;  // regular expression over the message
};

std::string withDomain(const std::string& rest) { return "domain: {size: [2, 1], resolution: 32}\n" + rest; }

std::string aliasBomb() {
  std::string text = withDomain("a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n");
  for (int k = 1; k < 12; ++k) {
    const std::string before = "*a" + std::to_string(k - 1);
    text += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " [" + before;
    for (int n = 1; n < 10; ++n) text += ", " + before;
    text += "]\n";
  }
  return text;
}

void PrintTo(const BadScene& scene, std::ostream* out) { *out << scene.name; }

class BadSceneFile : public testing::TestWithParam<BadScene> {};

TEST_P(BadSceneFile, IsRefusedWithItsPlace) {
  // `check` prints the problem with its place, `render` and `simulate` too; the status is 3 and nothing is
  // written.
  const BadScene& bad = GetParam();
  TemporaryFolder folder;
  writeText(folder / "scene.yaml", bad.text);
  const std::regex message(std::string("(^|\n)scene.yaml") +
                           (bad.line ? ":" + std::to_string(bad.line) + ":[0-9]+" : "[:0-9]*") + ": [^\n]*(" +
                           bad.says + ")");
  const RunResult check = runProgram({"check", "scene.yaml"}, folder.path());
  EXPECT_EQ(check.status, 3) << check.out << check.err;
  EXPECT_TRUE(std::regex_search(check.out, message)) << check.out << check.err;
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"render", "scene.yaml", "-o", "a.mp4"},
        {"simulate", "scene.yaml", "--steps", "1"},
        {"plan", "scene.yaml"}}) {
    const RunResult run = runProgram(arguments, folder.path());
    EXPECT_EQ(run.status, 3) << arguments[0] << ": " << run.err;
    EXPECT_TRUE(std::regex_search(run.err, message)) << arguments[0] << ": " << run.err;
  }
  EXPECT_EQ(folder.names(), std::set<std::string>{"scene.yaml"});
}

INSTANTIATE_TEST_SUITE_P(
    Cli, BadSceneFile,
    testing::Values(
        BadScene{"Empty", "", 0, "empty"}, BadScene{"OnlyAComment", "# nothing\n", 0, "empty"},
        BadScene{"NotYaml", "domain: {size: [2, 1]\nwalls: ]\n", 0, "."},
        BadScene{"NoMapping", "- 1\n- 2\n", 0, "."},
        BadScene{"NoDomain", "gravity: [0, -9.81]\n", 0, "domain"},
        BadScene{"UnknownKey", withDomain("fluid: {vorticty: 1}\n"), 2, "vorticty.*vorticity"},
        BadScene{"WrongType", withDomain("gravity: down\n"), 2, "gravity|list|numbers"},
        BadScene{"NotANumber", withDomain("fluid: {density: .nan}\n"), 2, "density|number"},
        BadScene{"Infinite", withDomain("fluid: {density: .inf}\n"), 2, "density|number|finite"},
        BadScene{"NegativeSize", "domain: {size: [-2, 1], resolution: 32}\n", 1, "size|positive|greater"},
        BadScene{"HeightIsNoWholeNumberOfCells", "domain: {size: [2, 1.01], resolution: 32}\n", 1,
                 "cells|height"},
        BadScene{"SelfCrossingPolygon",
                 withDomain("solids:\n  - {name: a, shape: {polygon: [[0.2, 0.2], [0.8, 0.8], [0.8, 0.2], "
                            "[0.2, 0.8]]}}\n"),
                 3, "cross|edge"},
        BadScene{
            "DegeneratePolygon",
            withDomain("solids:\n  - {name: a, shape: {polygon: [[0.2, 0.2], [0.8, 0.8], [0.5, 0.5]]}}\n"), 3,
            "polygon|area|edge"},
        BadScene{"FrameIsNoWholeNumberOfSteps",
                 withDomain("time: {step: 1/50, duration: 1}\noutput: {fps: 30}\n"), 0, "step|frame|whole"},
        BadScene{"TwoKeysAlike", withDomain("fluid: {density: 1}\nfluid: {density: 2}\n"), 3,
                 "fluid|twice|again"},
        BadScene{"AliasBomb", aliasBomb(), 0, "."},
        BadScene{"DeepNesting",
                 withDomain("solids: " + std::string(100000, '[') + std::string(100000, ']') + "\n"), 0,
                 "deep|nest"},
        BadScene{"InflowWithoutAWayOut", withDomain("walls: {left: {inflow: [1, 0]}}\n"), 0,
                 "inflow|out|open"},
        BadScene{
            "BadExpression",
            withDomain("solids:\n  - {name: a, shape: {circle: {radius: 0.1}}, position: [1, 0.5], motion: "
                       "{expression: {x: \"1 +\", y: \"0\"}}}\n"),
            3, "."}),
    [](const auto& scene) { return std::string(scene.param.name); });

TEST(BadScene, AllProblemsAreToldInOneRun) {
  // Three mistakes give three lines.
  TemporaryFolder folder;
  writeText(folder / "scene.yaml", withDomain("fluid: {vorticty: 1}\ngravity: 3\ntime: {step: -1}\n"));
  const RunResult run = runProgram({"check", "scene.yaml"}, folder.path());
  EXPECT_EQ(run.status, 3);
  for (const char* place : {"scene.yaml:2:", "scene.yaml:3:", "scene.yaml:4:"})
    EXPECT_NE(run.out.find(place), std::string::npos) << run.out;
}

TEST(BadScene, FileThatCannotBeReadIsAnInputError) {
  // No such file, and a folder in place of a file: status 4, with the name.
  TemporaryFolder folder;
  std::filesystem::create_directory(folder / "folder.yaml");
  for (const char* name : {"missing.yaml", "folder.yaml"})
    for (const char* command : {"check", "render", "simulate", "plan"}) {
      const RunResult run = runProgram({command, name}, folder.path());
      EXPECT_EQ(run.status, 4) << command << " " << name << ": " << run.out << run.err;
      EXPECT_NE((run.out + run.err).find(name), std::string::npos) << run.out << run.err;
    }
  EXPECT_EQ(folder.names(), std::set<std::string>{"folder.yaml"});
}

TEST(BadScene, NamesAGoodOneOk) {
  // A good scene is said to be so, and several scenes are all looked at.
  TemporaryFolder folder;
  writeText(folder / "good.yaml", kSmallScene);
  writeText(folder / "bad.yaml", "domain: 3\n");
  EXPECT_EQ(runProgram({"check", "good.yaml"}, folder.path()).out, "good.yaml: ok\n");
  const RunResult both = runProgram({"check", "bad.yaml", "good.yaml"}, folder.path());
  EXPECT_EQ(both.status, 3);
  EXPECT_NE(both.out.find("bad.yaml:1"), std::string::npos) << both.out;
  EXPECT_NE(both.out.find("good.yaml: ok\n"), std::string::npos) << both.out;
}

TEST(BadScene, SettingsAreCheckedLikeTheFile) {
  // An override with a wrong path or value is refused with the setting as its place.
  TemporaryFolder folder;
  writeText(folder / "scene.yaml", kSmallScene);
  for (const char* setting :
       {"fluid.vorticty=1", "fluid.density=heavy", "solids.pots.drag=1", "output.size=[0, 3]"}) {
    const RunResult run = runProgram({"simulate", "scene.yaml", "--set", setting}, folder.path());
    EXPECT_EQ(run.status, 3) << setting << ": " << run.err;
    EXPECT_NE(run.err.find("--set"), std::string::npos) << run.err;
  }
}

TEST(BadScene, MemoryThatCannotBeHadIsToldBeforehand) {
  // A grid of terabytes ends at once, with the figure, and not in a crash.
  TemporaryFolder folder;
  writeText(folder / "scene.yaml", kSmallScene);
  for (const char* command : {"simulate", "render"}) {
    const RunResult run =
        runProgram({command, "scene.yaml", "--set", "domain.resolution=1000000"}, folder.path());
    EXPECT_TRUE(run.status == 1 || run.status == 3) << run.status << run.err;
    EXPECT_TRUE(std::regex_search(run.err, std::regex("[0-9.]+ ?(MB|GB|TB)"))) << run.err;
  }
  EXPECT_EQ(folder.names(), std::set<std::string>{"scene.yaml"});
}

}  // namespace
}  // namespace smokebox
