// `compare`: runs in step as panels of one film, and the stills beside it.
#include <gtest/gtest.h>

#include <algorithm>

#include "image/png.h"
#include "image/sheet.h"
#include "support/decoded_film.h"
#include "support/run_program.h"

namespace smokebox {
namespace {

class Compare : public testing::Test {
 protected:
  void SetUp() override {
    std::string scene = kSmallScene;
    scene.replace(scene.find("[64, 32]"), 8, "[320, 160]");
    writeText(folder / "scene.yaml", scene);
  }
  RunResult run(std::vector<std::string> arguments) {
    return runProgram(std::move(arguments), folder.path());
  }
  RunResult compare(std::vector<std::string> arguments) {
    for (const char* last : {"scene.yaml", "compare"}) arguments.insert(arguments.begin(), last);
    return run(std::move(arguments));
  }
  std::set<std::string> written() const {
    std::set<std::string> names = folder.names();
    names.erase("scene.yaml");
    return names;
  }
  TemporaryFolder folder;
};

/// What stands in a panel of a sheet.
Image cutOut(const Image& sheet, const SheetLayout& layout, int panel) {
  Image image(layout.panelWidth, layout.panelHeight);
  for (int y = 0; y < image.height; ++y)
    std::copy_n(&sheet.rgba[4 * (std::size_t(layout.top(panel) + y) * sheet.width + layout.left(panel))],
                4 * image.width, &image.rgba[std::size_t{4} * y * image.width]);
  return image;
}

TEST_F(Compare, GoesToRendersWithItsStillsAndIsRenewed) {
  // Truth: without -o there are renders/<scene>-compare.mp4 and its stills, and a second run replaces them.
  for (int k = 0; k < 2; ++k) {
    const RunResult result =
        compare({"--vary", "fluid.vorticity=0.5,0", "--stills", "0.1,0.25", "--size", "320x160"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("renders/scene-compare.mp4"), std::string::npos) << result.err;
  }
  EXPECT_EQ(written(), std::set<std::string>{"renders"});
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "renders"))
    names.insert(entry.path().filename());
  EXPECT_EQ(names,
            (std::set<std::string>{"scene-compare.mp4", "scene-compare-0.1.png", "scene-compare-0.25.png"}));
  const DecodedFilm film = decodeFilm(folder / "renders/scene-compare.mp4");
  const SheetLayout layout = layOut(2, 320, 160);
  EXPECT_EQ(film.times.size(), 15u);
  EXPECT_EQ(film.width, layout.width);
  EXPECT_EQ(film.height, layout.height);
  EXPECT_EQ(film.metadata.at("compared"), "fluid.vorticity=0.5,0");
}

TEST_F(Compare, APanelIsWhatTheRunAloneWouldDraw) {
  // Truth: cut out of the sheet, each panel is the still of `render` with that value, to the bit; for any
  // number of threads.
  const SheetLayout layout = layOut(3, 480, 240);
  for (const char* threads : {"1", "4"}) {
    const RunResult result = compare({"--vary", "smoke.sources.0.rate=1,4,16", "--stills", "0.4", "--size",
                                      "480x240", "-o", "sheet.png", "-y", "--threads", threads});
    ASSERT_EQ(result.status, 0) << result.err;
    const Image sheet = readPng(folder / "sheet-0.4.png");
    ASSERT_EQ(sheet.width, layout.width);
    int panel = 0;
    for (const char* rate : {"1", "4", "16"}) {
      const std::string size = std::to_string(layout.panelWidth) + "x" + std::to_string(layout.panelHeight);
      const RunResult alone =
          run({"render", "scene.yaml", "--set", "smoke.sources.0.rate=" + std::string(rate), "--at", "0.4",
               "--size", size, "-o", "alone.png", "-y"});
      ASSERT_EQ(alone.status, 0) << alone.err;
      EXPECT_EQ(cutOut(sheet, layout, panel++).rgba, readPng(folder / "alone.png").rgba) << rate;
    }
  }
}

TEST_F(Compare, TheDifferenceIsAPanelOfItsOwn) {
  // Truth: dark all over where the runs agree (at the start), bright somewhere once they do not.
  const RunResult result = compare({"--vary", "smoke.sources.0.rate=0,8", "--stills", "0,0.4", "--diff",
                                    "--size", "480x240", "-o", "sheet.png"});
  ASSERT_EQ(result.status, 0) << result.err;
  const SheetLayout layout = layOut(3, 480, 240);
  const auto brightest = [&](const char* file) {
    const Image panel = cutOut(readPng(folder / file), layout, 2);
    int most = 0;
    for (std::size_t k = 0; k < panel.rgba.size(); k += 4) most = std::max<int>(most, panel.rgba[k + 1]);
    return most;
  };
  EXPECT_LT(brightest("sheet-0.png"), 40);
  EXPECT_GT(brightest("sheet-0.4.png"), 120);
}

TEST_F(Compare, EqualValuesHaveEqualColoursInAllPanels) {
  // Truth: the range of a field is one for all runs: the colour bars have the same numbers beside them,
  // although one flow is three times as fast as the other.
  const RunResult result =
      compare({"--set", "view.layers=[speed]", "--vary", "walls.left.inflow=[1, 0],[3, 0]", "--stills", "0.4",
               "--size", "1280x640", "-o", "sheet.png"});
  ASSERT_EQ(result.status, 0) << result.err;
  const SheetLayout layout = layOut(2, 1280, 640);
  const Image sheet = readPng(folder / "sheet-0.4.png");
  const Image slow = cutOut(sheet, layout, 0), fast = cutOut(sheet, layout, 1);
  int marks = 0, differ = 0;
  const auto isWhite = [](const Image& image, std::size_t k) { return image.rgba[k] > 200; };
  for (int y = 0; y < slow.height; ++y)
    for (int x = slow.width * 9 / 10; x < slow.width; ++x) {
      const std::size_t k = 4 * (std::size_t(y) * slow.width + x);
      marks += isWhite(slow, k);
      differ += isWhite(slow, k) != isWhite(fast, k);
    }
  EXPECT_GT(marks, 40);
  EXPECT_EQ(differ, 0);
}

TEST_F(Compare, ARunThatFailsIsNamedAndNothingIsLeft) {
  // Truth: the message says which of the runs, status 1, and no half film stays.
  const RunResult result =
      compare({"--vary", "method.max_iterations=200,1", "--set", "method.tolerance=1e-7", "-o", "x.mp4"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.err.find("method.max_iterations = 1: "), std::string::npos) << result.err;
  EXPECT_EQ(written(), std::set<std::string>{});
}

TEST_F(Compare, WrongUsageIsToldBeforeAnyWork) {
  // Truth: status 2 (3 for a value that the scene does not take), and a message that names the option.
  const struct {
    std::vector<std::string> arguments;
    int status;
    const char* message;
  } cases[] = {
      {{}, 2, "--vary"},
      {{"--vary", "fluid.vorticity=1"}, 2, "nothing to compare"},
      {{"--vary", "fluid.vorticity=1,2,3,4,5,6,7,8,9,10"}, 2, "more than 9"},
      {{"--vary", "fluid.vortex=1,2"}, 3, "vorticity"},
      {{"--vary", "fluid.vorticity=0,x"}, 3, "--vary fluid.vorticity=x"},
      {{"--vary", "fluid.vorticity=0,1", "--stills", "0.9"}, 2, "--stills: the film ends at 0.5 s"},
      {{"--vary", "fluid.vorticity=0,1", "--stills", "-1"}, 2, "--stills"},
      {{"--vary", "fluid.vorticity=0,1", "--size", "40x20"}, 2, "room"},
      {{"--vary", "fluid.vorticity=0,1", "-o", "x.doc"}, 2, "x.doc"},
      {{"--vary", "output.fps=30,60"}, 2, "in step"},
      {{"--vary", "fluid.vorticity=0,1", "-o", "scene.yaml.png", "--frames", "0-99"}, 2, "--frames"},
  };
  for (const auto& wrong : cases) {
    const RunResult result = compare(wrong.arguments);
    EXPECT_EQ(result.status, wrong.status) << wrong.message << result.err;
    EXPECT_NE(result.err.find(wrong.message), std::string::npos) << result.err;
  }
  EXPECT_EQ(written(), std::set<std::string>{});
}

TEST_F(Compare, RefusesToReplaceWhatWasNamed) {
  // Truth: a still that is there is refused like a film, before any work; -y replaces it.
  writeText(folder / "x-0.2.png", "mine");
  const std::vector<std::string> arguments = {
      "--vary", "fluid.vorticity=0,1", "--stills", "0.2", "--size", "320x160", "-o", "x.mp4"};
  EXPECT_EQ(compare(arguments).status, 4);
  EXPECT_EQ(fileText(folder / "x-0.2.png"), "mine");
  EXPECT_EQ(written(), std::set<std::string>{"x-0.2.png"});
  std::vector<std::string> replacing = arguments;
  replacing.push_back("-y");
  EXPECT_EQ(compare(replacing).status, 0);
  EXPECT_EQ(written(), (std::set<std::string>{"x-0.2.png", "x.mp4"}));
  EXPECT_NE(fileText(folder / "x-0.2.png"), "mine");
}

TEST_F(Compare, RenewsStillsThatWereNotNamed) {
  // Truth: beside a folder of frames the stills go to renders/, as without -o, and are replaced unasked.
  for (const char* frames : {"f/%05d.png", "g/%05d.png"}) {
    const RunResult result =
        compare({"--vary", "fluid.vorticity=0,1", "--stills", "0.1", "--frames", "0-3", "-o", frames});
    EXPECT_EQ(result.status, 0) << result.err;
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "renders/scene-compare-0.1.png"));
}

TEST_F(Compare, AnInterruptLeavesNothing) {
  // Truth: Ctrl-C ends it with status 130 and no file.
  ProgramRun run({"compare", "scene.yaml", "--vary", "fluid.vorticity=0,1", "--set", "time.duration=2000",
                  "-o", "x.mp4"},
                 folder.path());
  const auto begun = [&] {
    const auto names = written();
    return std::any_of(names.begin(), names.end(),
                       [](const std::string& n) { return n.starts_with("x.mp4"); });
  };
  ASSERT_TRUE(run.waitUntil(begun));
  run.signal(SIGINT);
  EXPECT_EQ(run.wait().status, 130);
  EXPECT_EQ(written(), std::set<std::string>{});
}

}  // namespace
}  // namespace smokebox
