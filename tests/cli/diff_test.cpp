// `diff`: what it says of two pictures or films, its exit status, and what it writes.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>

#include "image/difference.h"
#include "image/png.h"
#include "support/decoded_film.h"
#include "support/run_program.h"
#include "video/film_reader.h"
#include "video/sink.h"

namespace smokebox {
namespace {

bool says(const RunResult& run, const std::string& text) { return run.out.find(text) != std::string::npos; }

std::string lastLine(const RunResult& run) {
  const std::size_t end = run.out.find_last_not_of('\n');
  const std::size_t start = run.out.rfind('\n', end);
  return run.out.substr(start + 1, end - start);
}

class Diff : public testing::Test {
 protected:
  /// Three runs of a small scene, once for all tests: `a`, `same` and `b`, where the smoke is a little
  /// denser; as lossless film, and `a` as all there is.
  static void SetUpTestSuite() {
    films = new TemporaryFolder;
    writeText(*films / "scene.yaml", kSmallScene);
    const auto render = [](std::vector<std::string> arguments) {
      arguments.insert(arguments.begin(), {"render", "scene.yaml", "--quiet"});
      const RunResult run = runProgram(std::move(arguments), films->path());
      ASSERT_EQ(run.status, 0) << run.err;
    };
    render({"-o", "a.mkv", "-o", "a.mp4", "-o", "a/%03d.png"});
    render({"-o", "same.mkv", "--threads", "1"});
    render({"-o", "b.mkv", "-o", "b/%03d.png", "--set", "smoke.sources.0.rate=5"});
    render({"-o", "short.mkv", "--frames", "0-11"});
    render({"-o", "wide.mkv", "-o", "wide.png", "--size", "96x32"});
    render({"-o", "slow.mkv", "--set", "output.fps=20", "--set", "time.duration=0.75"});
  }
  static void TearDownTestSuite() {
    delete films;
    films = nullptr;
  }
  static std::string film(const std::string& name) { return (*films / name).string(); }

  RunResult diff(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "diff");
    return runProgram(std::move(arguments), folder.path());
  }
  /// A picture whose pixels in the rectangle are brighter by `by`.
  std::string picture(const std::string& name, int by, int left = 100, int top = 60, int size = 20) {
    Image image(320, 180);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const bool inside = x >= left && x < left + size && y >= top && y < top + size;
        std::uint8_t* const to = image.rgba.data() + 4 * (std::size_t(y) * image.width + x);
        for (int c = 0; c < 3; ++c) to[c] = static_cast<std::uint8_t>(40 + x / 4 + (inside ? by : 0));
        to[3] = 255;
      }
    writePng(folder / name, image, {});
    return name;
  }

  static TemporaryFolder* films;
  TemporaryFolder folder;
};

TemporaryFolder* Diff::films = nullptr;

TEST_F(Diff, EqualPicturesAreWithinTheTolerance) {
  // Status 0, all measures on standard output, nothing on standard error.
  const RunResult run = diff({picture("a.png", 0), picture("b.png", 0)});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(lastLine(run), "within the tolerance");
  for (const char* line :
       {"size                320x180", "pixels off          0%", "largest difference  none",
        "PSNR                infinite", "SSIM                1.00000"})
    EXPECT_TRUE(says(run, line)) << line << "\n" << run.out;
}

TEST_F(Diff, SaysHowFarPicturesAreApart) {
  // 400 of 57600 pixels that are off by 3 levels: the figures can be worked out by hand.
  const RunResult run = diff({picture("a.png", 0), picture("b.png", 3)});
  EXPECT_EQ(run.status, 5) << run.err;
  EXPECT_EQ(run.err, "");
  for (const char* line : {"pixels off          0.694% by more than 2 levels (0.05% may be)",
                           "worst 16x16 window  100% of it off, at (100, 60) (10% may be)",
                           "shift of a window   3.00 levels, at (100, 60) (0.25 may be)",
                           "largest difference  3 levels", "PSNR                60.17 dB"})
    EXPECT_TRUE(says(run, line)) << line << "\n" << run.out;
  EXPECT_EQ(lastLine(run).find("they differ: 0.694% of the pixels off by more than 2 levels"), 0u) << run.out;
}

TEST_F(Diff, NamesWhatBreaksTheTolerance) {
  // A patch of one level is told by its shift, and by nothing else; a few pixels off do not matter.
  const RunResult shift = diff({picture("a.png", 0), picture("b.png", 1)});
  EXPECT_EQ(shift.status, 5);
  EXPECT_EQ(lastLine(shift).find("they differ: the window at"), 0u) << shift.out;
  EXPECT_EQ(lastLine(shift).find("pixels off"), std::string::npos) << shift.out;
  const RunResult few = diff({"a.png", picture("c.png", 3, 100, 60, 2)});
  EXPECT_EQ(few.status, 0) << few.out;
  EXPECT_EQ(lastLine(few), "within the tolerance");
}

TEST_F(Diff, PicturesOfTwoSizesDiffer) {
  // Told in words; a picture of the difference there is none.
  const RunResult run = diff({picture("a.png", 0), film("wide.png"), "-o", "d.png"});
  EXPECT_EQ(run.status, 5) << run.err;
  EXPECT_EQ(lastLine(run), "they differ: the size is 320x180 against 96x32 pixels");
  EXPECT_TRUE(says(run, "not written"));
  EXPECT_EQ(folder.names(), std::set<std::string>{"a.png"});
}

TEST_F(Diff, ShowsWhereInAPicture) {
  // The output has the pictures' size, marks what differs, is refused a second time, and renewed with -y.
  // It is written for equal pictures too.
  picture("a.png", 0);
  picture("b.png", 9);
  ASSERT_EQ(diff({"a.png", "b.png", "-o", "d.png"}).status, 5);
  const Image shown = readPng(folder / "d.png");
  ASSERT_EQ(shown.width, 320);
  const auto* const patch = shown.rgba.data() + 4 * (std::size_t{78} * 320 + 118);
  EXPECT_GT(patch[0], patch[2] + 100);
  const std::string before = fileText(folder / "d.png");
  const RunResult refused = diff({"a.png", "a.png", "-o", "d.png"});
  EXPECT_EQ(refused.status, 4);
  EXPECT_NE(refused.err.find("-y"), std::string::npos);
  EXPECT_EQ(fileText(folder / "d.png"), before);
  EXPECT_EQ(diff({"a.png", "a.png", "-o", "d.png", "-y"}).status, 0);
  EXPECT_NE(fileText(folder / "d.png"), before);
}

TEST_F(Diff, EqualFilmsAreWithinTheTolerance) {
  // The film of another run, the same by another number of threads; and the folder of its frames.
  for (const char* other : {"same.mkv", "a/%03d.png"}) {
    const RunResult run = diff({film("a.mkv"), film(other)});
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    EXPECT_EQ(lastLine(run), "within the tolerance");
    EXPECT_TRUE(says(run, "size                64x32")) << run.out;
    EXPECT_TRUE(says(run, "frames              15\n")) << run.out;
    EXPECT_TRUE(says(run, "frame rate          30 frames/s")) << run.out;
    EXPECT_TRUE(says(run, "out of tolerance    none of 15 frames")) << run.out;
    EXPECT_TRUE(says(run, "PSNR of the film    infinite")) << run.out;
  }
}

TEST_F(Diff, FilmsAreJudgedFrameByFrame) {
  // The first frame out of tolerance and the worst one are those that comparing the single pictures gives;
  // so are the means over the film.
  long outside = 0, first = -1, worst = -1;
  double lowest = 1e9, squares = 0, similarity = 0;
  for (int k = 0; k < 15; ++k) {
    char name[16];
    std::snprintf(name, sizeof name, "%03d.png", k);
    const ImageDifference one = measureDifference(readPng(*films / "a" / name), readPng(*films / "b" / name));
    squares += std::isinf(one.psnr) ? 0 : 255 * 255 * std::pow(10, -one.psnr / 10);
    similarity += one.ssim;
    if (one.within({})) continue;
    ++outside;
    if (first < 0) first = k;
    if (one.psnr < lowest) {
      lowest = one.psnr;
      worst = k;
    }
  }
  ASSERT_GT(first, 0);
  ASSERT_GT(worst, first);
  const RunResult run = diff({film("a.mkv"), film("b.mkv")});
  EXPECT_EQ(run.status, 5) << run.err;
  char text[100];
  std::snprintf(text, sizeof text, "out of tolerance    %ld of 15 frames, the first is %ld (%.3f s)\n",
                outside, first, first / 30.0);
  EXPECT_TRUE(says(run, text)) << text << run.out;
  std::snprintf(text, sizeof text, "worst frame         %ld (%.3f s)\n", worst, worst / 30.0);
  EXPECT_TRUE(says(run, text)) << text << run.out;
  std::snprintf(text, sizeof text, "PSNR of the film    %.2f dB\nSSIM of the film    %.5f\n",
                10 * std::log10(255 * 255 * 15 / squares), similarity / 15);
  EXPECT_TRUE(says(run, text)) << text << run.out;
  EXPECT_EQ(lastLine(run).find("they differ: " + std::to_string(outside) + " of 15 frames"), 0u) << run.out;
}

TEST_F(Diff, FilmsOfTwoLengthsDiffer) {
  // Though the frames that both have are equal.
  const RunResult run = diff({film("a.mkv"), film("short.mkv")});
  EXPECT_EQ(run.status, 5) << run.err;
  EXPECT_EQ(lastLine(run), "they differ: 15 frames against 12");
  EXPECT_TRUE(says(run, "out of tolerance    none of 12 frames")) << run.out;
  EXPECT_EQ(lastLine(diff({film("short.mkv"), film("a.mkv")})), "they differ: 12 frames against 15");
}

TEST_F(Diff, FilmsOfTwoRatesOrSizesDiffer) {
  // Told in words, first of all.
  const RunResult rate = diff({film("a.mkv"), film("slow.mkv")});
  EXPECT_EQ(rate.status, 5) << rate.err;
  EXPECT_EQ(lastLine(rate).find("they differ: 30 frames/s against 20 frames/s"), 0u) << rate.out;
  const RunResult size = diff({film("a.mkv"), film("wide.mkv"), "-o", "d.mp4"});
  EXPECT_EQ(size.status, 5) << size.err;
  EXPECT_EQ(lastLine(size), "they differ: the size is 64x32 against 96x32 pixels");
  EXPECT_TRUE(folder.names().empty());
}

TEST_F(Diff, WritesAFilmOfTheDifferences) {
  // As long as the films, at their rate; a .png shows the worst frame, a folder all of them.
  for (const char* name : {"d.mp4", "d.mkv", "d/%02d.png"}) {
    ASSERT_EQ(diff({film("a.mkv"), film("b.mkv"), "-o", name}).status, 5) << name;
    FilmReader reader((folder / name).string());
    EXPECT_EQ(reader.width(), 64);
    long frames = 0;
    for (Image image; reader.next(image);) ++frames;
    EXPECT_EQ(frames, 15) << name;
  }
  EXPECT_DOUBLE_EQ(decodeFilm(folder / "d.mp4").framesPerSecond, 30);
  ASSERT_EQ(diff({film("a.mkv"), film("b.mkv"), "-o", "worst.png"}).status, 5);
  EXPECT_EQ(readPng(folder / "worst.png").width, 64);
  EXPECT_EQ(folder.names(), (std::set<std::string>{"d", "d.mkv", "d.mp4", "worst.png"}));
  EXPECT_EQ(diff({film("a.mkv"), film("b.mkv"), "-o", "d.mp4"}).status, 4);
  EXPECT_EQ(diff({film("a.mkv"), film("same.mkv"), "-o", "equal.mp4"}).status, 0);
  EXPECT_EQ(decodeFilm(folder / "equal.mp4").times.size(), 15u);
}

TEST_F(Diff, WhatCannotBeReadHasStatusFour) {
  // One line names the file and says why; nothing is written.
  writeText(folder / "no.png", "not a picture");
  writeText(folder / "no.mp4", "not a film");
  picture("a.png", 0);
  std::string bytes = fileText(*films / "a.mp4");
  writeText(folder / "cut.mp4", bytes.substr(0, bytes.size() * 3 / 4));
  const std::vector<std::array<std::string, 3>> wrong = {{"a.png", "gone.png", "gone.png"},
                                                         {"gone.mp4", film("a.mkv"), "gone.mp4"},
                                                         {"a.png", "no.png", "no.png"},
                                                         {film("a.mkv"), "no.mp4", "no.mp4"},
                                                         {film("a.mkv"), "f/%03d.png", "f"},
                                                         {film("a.mkv"), "%03d.png", "%03d.png"},
                                                         {film("a.mkv"), film("a"), "is a folder"},
                                                         {film("a.mkv"), "cut.mp4", "cut.mp4"},
                                                         {film("scene.yaml"), film("a.mkv"), "scene.yaml"}};
  for (const auto& [a, b, name] : wrong) {
    const RunResult run = diff({a, b, "-o", a == "a.png" ? "d.png" : "d.mp4"});
    EXPECT_EQ(run.status, 4) << a << " " << b << "\n" << run.err;
    EXPECT_NE(run.err.find(name), std::string::npos) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_EQ(run.out, "");
  }
  EXPECT_EQ(folder.names(), (std::set<std::string>{"a.png", "cut.mp4", "no.mp4", "no.png"}));
}

TEST_F(Diff, WrongUsageHasStatusTwo) {
  // A picture against a film, outputs that cannot be, one file too few; nothing is written.
  picture("a.png", 0);
  const std::string a = film("a.mkv");
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{"a.png", a}, "is a film"},
      {{a, "a.png"}, "is a film"},
      {{"a.png"}, "b is required"},
      {{"a.png", "a.png", "-o", "d.mp4"}, "name a .png"},
      {{"a.png", "a.png", "-o", "d/%d.png"}, "name a .png"},
      {{"a.png", "a.png", "-o", "a.png", "-y"}, "is one of the two"},
      {{"a.png", "a.png", "-o", "./a.png", "-y"}, "is one of the two"},
      {{"%d.png", "%d.png", "-o", "./%d.png", "-y"}, "is one of the two"},
      {{a, a, "-o", "d.avi"}, "'.avi'"},
      {{a, a, "-o", "-"}, "name a file"},
      {{a, a, "--tolerance", "3"}, "--tolerance"}};
  for (const auto& [arguments, why] : wrong) {
    const RunResult run = diff(arguments);
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_NE(run.err.find(why), std::string::npos) << run.err;
    EXPECT_EQ(run.out, "");
  }
  EXPECT_EQ(folder.names(), std::set<std::string>{"a.png"});
}

TEST_F(Diff, OddFilmNeedsALosslessOutput) {
  // H.264 takes even sizes only: said before anything is compared, with what to do.
  const auto sink = openSink((folder / "odd.mkv").string(), {33, 21, 30, {}});
  sink->add(Image(33, 21), 0);
  sink->finish();
  const RunResult run = diff({"odd.mkv", "odd.mkv", "-o", "d.mp4"});
  EXPECT_EQ(run.status, 2) << run.err;
  EXPECT_NE(run.err.find(".mkv"), std::string::npos) << run.err;
  EXPECT_EQ(diff({"odd.mkv", "odd.mkv", "-o", "d.mkv"}).status, 0);
}

TEST_F(Diff, InterruptLeavesNothing) {
  // Ctrl-C while films are compared: status 130, and no half of an output.
  ASSERT_EQ(mkfifo((folder / "slow.y4m").c_str(), 0600), 0);
  ProgramRun run({"diff", film("a.mkv"), "slow.y4m", "-o", "d.mkv"}, folder.path());
  std::ofstream feed(folder / "slow.y4m", std::ios::binary);  // opens when the program reads it
  ASSERT_TRUE(feed);
  const std::string planes(std::size_t{64} * 32 * 3 / 2, '\x60');
  feed << "YUV4MPEG2 W64 H32 F30:1 Ip A1:1 C420mpeg2\n";
  std::signal(SIGPIPE, SIG_IGN);
  for (int k = 0; k < 8; ++k) feed << "FRAME\n" << planes;
  feed.flush();
  ASSERT_TRUE(run.waitUntil([&] {
    feed << "FRAME\n" << planes << std::flush;
    return folder.names().contains("d.mkv.part");
  }));
  run.signal(SIGINT);
  for (int k = 0; k < 400; ++k) feed << "FRAME\n" << planes << std::flush;
  feed.close();
  const RunResult result = run.wait();
  EXPECT_EQ(result.status, 130) << result.out << result.err;
  EXPECT_EQ(folder.names(), std::set<std::string>{"slow.y4m"});
}

}  // namespace
}  // namespace smokebox
