// Wrong usage: status 2, a clear line on standard error, and nothing written.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/run_program.h"

namespace smokebox {
namespace {

TEST(Usage, AloneShowsHelp) {
  // Without arguments the commands are listed, and that is no error.
  TemporaryFolder folder;
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{}, {"--help"}}) {
    const RunResult run = runProgram(arguments, folder.path());
    EXPECT_EQ(run.status, 0);
    for (const char* command : {"render", "simulate", "check", "plan"})
      EXPECT_NE(run.out.find(command), std::string::npos) << run.out;
  }
}

TEST(Usage, HelpOfACommandListsItsOptions) {
  // Each option of `render` is in its help.
  TemporaryFolder folder;
  const RunResult run = runProgram({"render", "--help"}, folder.path());
  EXPECT_EQ(run.status, 0);
  for (const char* option :
       {"-o", "--at", "--frames", "--size", "--set", "--threads", "--stats", "--gl", "-y", "--quiet"})
    EXPECT_NE(run.out.find(option), std::string::npos) << option << "\n" << run.out;
}

TEST(Usage, UnknownCommandIsGuessed) {
  // A slip of the finger is told with the word that was meant.
  TemporaryFolder folder;
  const RunResult run = runProgram({"rendr", "scene.yaml"}, folder.path());
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("rendr"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("`render`"), std::string::npos) << run.err;
}

struct WrongUsage {
  std::vector<std::string> arguments;
  const char* says;
};

void PrintTo(const WrongUsage& wrong, std::ostream* out) {
  for (const std::string& argument : wrong.arguments) *out << argument << " ";
}

class UsageError : public testing::TestWithParam<WrongUsage> {};

TEST_P(UsageError, HasStatusTwoAndSaysWhy) {
  // Wrong usage ends with 2, one line on standard error names the culprit, and no file appears.
  TemporaryFolder folder;
  writeText(folder / "scene.yaml", kSmallScene);
  const RunResult run = runProgram(GetParam().arguments, folder.path());
  EXPECT_EQ(run.status, 2) << run.err;
  EXPECT_NE(run.err.find(GetParam().says), std::string::npos) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_EQ(folder.names(), std::set<std::string>{"scene.yaml"});
}

INSTANTIATE_TEST_SUITE_P(
    Cli, UsageError,
    testing::Values(WrongUsage{{"render"}, "scene is required"}, WrongUsage{{"check"}, "scene is required"},
                    WrongUsage{{"render", "scene.yaml", "--sise", "64x32"}, "--sise"},
                    WrongUsage{{"render", "scene.yaml", "--threads", "0", "-o", "a.mp4"}, "--threads"},
                    WrongUsage{{"render", "scene.yaml", "--threads", "two", "-o", "a.mp4"}, "--threads"},
                    WrongUsage{{"render", "scene.yaml", "--size", "64", "-o", "a.mp4"}, "--size"},
                    WrongUsage{{"render", "scene.yaml", "--size", "0x32", "-o", "a.mp4"}, "--size"},
                    WrongUsage{{"render", "scene.yaml", "--size", "-64x32", "-o", "a.mp4"}, "--size"},
                    WrongUsage{{"render", "scene.yaml", "--frames", "9-3", "-o", "a.mp4"}, "--frames"},
                    WrongUsage{{"render", "scene.yaml", "--frames", "a-b", "-o", "a.mp4"}, "--frames"},
                    WrongUsage{{"render", "scene.yaml", "--frames", "3-15", "-o", "a.mp4"}, "0-14"},
                    WrongUsage{{"render", "scene.yaml", "--at", "0.6", "-o", "a.png"}, "0.5 s"},
                    WrongUsage{{"render", "scene.yaml", "--at", "-1", "-o", "a.png"}, "--at"},
                    WrongUsage{{"render", "scene.yaml", "--at", "nan", "-o", "a.png"}, "--at"},
                    WrongUsage{{"render", "scene.yaml", "--at", "0.1", "-o", "a.mp4"}, "still"},
                    WrongUsage{{"render", "scene.yaml", "-o", "a.mp4", "-o", "a.mp4"}, "twice"},
                    WrongUsage{{"render", "scene.yaml", "--size", "65x33", "-o", "a.mp4"}, "even"},
                    WrongUsage{{"render", "scene.yaml", "--gl", "glide", "-o", "a.mp4"}, "--gl"},
                    WrongUsage{{"render", "scene.yaml", "-o", "a.avi"}, "'.avi'"},
                    WrongUsage{{"render", "scene.yaml", "-o", "a"}, "no ending"},
                    WrongUsage{{"render", "scene.yaml", "-o", "/dev/full"}, "no ending"},
                    WrongUsage{{"render", "scene.yaml", "-o", "%d_%d.png"}, "one field"},
                    WrongUsage{{"render", "scene.yaml", "--set", "fluid.vorticity", "-o", "a.mp4"},
                               "KEY=VALUE"},
                    WrongUsage{{"simulate", "scene.yaml", "--steps", "0"}, "--steps"},
                    WrongUsage{{"simulate", "scene.yaml", "--steps", "1.5"}, "--steps"},
                    WrongUsage{{"simulate", "scene.yaml", "-o", "a.mp4"}, "-o"}));

}  // namespace
}  // namespace smokebox
