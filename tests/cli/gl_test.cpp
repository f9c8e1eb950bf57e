// `--gl`: which way to OpenGL a film is drawn.
#include <gtest/gtest.h>

#include <cstdlib>

#include "render/gl_backend.h"
#include "support/run_program.h"

namespace smokebox {
namespace {

RunResult still(const TemporaryFolder& folder, const std::string& gl) {
  writeText(folder / "scene.yaml", kSmallScene);
  return runProgram({"render", "scene.yaml", "--gl", gl, "-o", gl + ".png", "--quiet"}, folder.path());
}

bool isBuilt(const std::string& gl) {
  for (const GlBackend backend : builtGlBackends())
    if (gl == nameOf(backend)) return true;
  return false;
}

TEST(Gl, TakesTheBackendsThatAreBuilt) {
  // Each backend that is built draws; one that is not is wrong usage, and the message says what there is.
  TemporaryFolder folder;
  for (const std::string gl : {"osmesa", "egl"}) {
    const RunResult run = still(folder, gl);
    EXPECT_EQ(run.status, isBuilt(gl) ? 0 : 2) << run.err;
    EXPECT_EQ(folder.names().contains(gl + ".png"), isBuilt(gl));
    if (isBuilt(gl)) continue;
    EXPECT_NE(run.err.find("this build has no '" + gl + "'; it has "), std::string::npos) << run.err;
  }
}

TEST(Gl, RefusesSoftpipe) {
  // A rasteriser that is 45 times slower is an error that says what to do, and no picture appears.
  for (const GlBackend backend : builtGlBackends()) {
    TemporaryFolder folder;
    setenv("GALLIUM_DRIVER", "softpipe", 1);
    const RunResult run = still(folder, nameOf(backend));
    unsetenv("GALLIUM_DRIVER");
    EXPECT_EQ(run.status, 1) << nameOf(backend) << run.err;
    EXPECT_NE(run.err.find("unset GALLIUM_DRIVER"), std::string::npos) << run.err;
    EXPECT_EQ(folder.names(), std::set<std::string>{"scene.yaml"});
  }
}

TEST(Gl, PrefersSoftwareUnlessTheUserSaysOtherwise) {
  // What the user has set for Mesa stays, and what is not set is chosen: software, without threads.
  setenv("LP_NUM_THREADS", "3", 1);
  unsetenv("LIBGL_ALWAYS_SOFTWARE");
  preferDrawingAlone();
  EXPECT_STREQ(getenv("LP_NUM_THREADS"), "3");
  EXPECT_STREQ(getenv("LIBGL_ALWAYS_SOFTWARE"), "true");
  unsetenv("LP_NUM_THREADS");
}

}  // namespace
}  // namespace smokebox
