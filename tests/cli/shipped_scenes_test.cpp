// The scenes that come with the program.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "support/run_program.h"

namespace smokebox {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr double kCheckSeconds = 1;  // an instrumented program starts slowly
#else
constexpr double kCheckSeconds = 0.05;
#endif

std::vector<std::string> shippedScenes() {
  std::vector<std::string> scenes;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(SMOKEBOX_SOURCE_DIR "/scenes"))
    if (entry.path().extension() == ".yaml") scenes.push_back(entry.path());
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

TEST(ShippedScenes, AreSoundAndCheckedInFiftyMilliseconds) {
  // Truth: no error and no warning, and an editor may check at every key: the median of nine runs is under 50
  // ms.
  TemporaryFolder folder;
  for (const std::string& scene : shippedScenes()) {
    std::vector<double> seconds;
    for (int k = 0; k < 9; ++k) {
      const auto start = std::chrono::steady_clock::now();
      const RunResult run = runProgram({"check", scene}, folder.path());
      seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      ASSERT_EQ(run.status, 0) << run.out << run.err;
      ASSERT_EQ(run.out, scene + ": ok\n");
    }
    std::nth_element(seconds.begin(), seconds.begin() + 4, seconds.end());
    std::printf("check %s: %.1f ms\n", std::filesystem::path(scene).filename().c_str(), 1e3 * seconds[4]);
    EXPECT_LT(seconds[4], kCheckSeconds) << scene;
  }
}

}  // namespace
}  // namespace smokebox
