// `render`: the files that it writes, those that it refuses to, and what it leaves behind when it is broken
// off.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "image/png.h"
#include "support/decoded_film.h"
#include "support/run_program.h"

namespace smokebox {
namespace {

class Render : public testing::Test {
 protected:
  void SetUp() override { writeText(folder / "scene.yaml", kSmallScene); }
  RunResult render(std::vector<std::string> arguments, const std::string& output = "") {
    arguments.insert(arguments.begin(), {"render", "scene.yaml"});
    return runProgram(std::move(arguments), folder.path(), output);
  }
  std::set<std::string> written() const {
    std::set<std::string> names = folder.names();
    names.erase("scene.yaml");
    return names;
  }
  TemporaryFolder folder;
};

TEST_F(Render, GoesToRendersByDefaultAndIsRenewed) {
  // With no -o the film is renders/<scene>.mp4, and a second run replaces it unasked.
  for (int run = 0; run < 2; ++run) {
    const RunResult result = render({});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.err.find("renders/scene.mp4: 15 frames"), std::string::npos) << result.err;
  }
  const DecodedFilm film = decodeFilm(folder / "renders/scene.mp4");
  EXPECT_EQ(film.times.size(), 15u);
  EXPECT_NEAR(film.duration, 0.5, 1e-3);
  EXPECT_EQ(film.width, 64);
  EXPECT_EQ(film.metadata.at("title"), "A small scene");
  EXPECT_EQ(film.metadata.at("scene"), "scene");
  EXPECT_EQ(film.metadata.at("scene_hash").size(), 16u);
  EXPECT_EQ(film.metadata.at("program").substr(0, 9), "smokebox ");
}

TEST_F(Render, WritesAllOutputsOfOneRun) {
  // Film, lossless film, frames and a still come from the same frames.
  const RunResult run =
      render({"-o", "a film.mp4", "-o", "b.mkv", "-o", "f/%03d.png", "-o", "still.png", "--quiet"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(written(), (std::set<std::string>{"a film.mp4", "b.mkv", "f", "still.png"}));
  EXPECT_EQ(decodeFilm(folder / "a film.mp4").times.size(), 15u);
  const DecodedFilm lossless = decodeFilm(folder / "b.mkv");
  ASSERT_EQ(lossless.times.size(), 15u);
  for (int k = 0; k < 15; ++k) {
    char name[16];
    std::snprintf(name, sizeof name, "f/%03d.png", k);
    const Image image = readPng(folder / name);
    const std::size_t at = 4 * (std::size_t{16} * 64 + 32);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(lossless.middle[k][c], image.rgba[at + c]) << k;
  }
  EXPECT_EQ(readPng(folder / "still.png").rgba, readPng(folder / "f/014.png").rgba);
}

TEST_F(Render, FrameDoesNotDependOnWhatElseIsDrawn) {
  // A still at a time, and a part of the frames, are the frames of the whole film, to the byte.
  ASSERT_EQ(render({"-o", "all/%d.png", "--threads", "1"}).status, 0);
  const RunResult run = render({"-o", "part/%d.png", "--frames", "3-5", "-o", "still.png", "--at", "0.26"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(fileText(folder / "still.png"), fileText(folder / "all/8.png"));
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "part")) {
    names.insert(entry.path().filename());
    EXPECT_EQ(fileText(entry.path()), fileText(folder / "all" / entry.path().filename()));
  }
  EXPECT_EQ(names, (std::set<std::string>{"3.png", "4.png", "5.png"}));
}

TEST_F(Render, SizeOverridesTheScene) {
  // --size is the size of the picture.
  ASSERT_EQ(render({"-o", "a.png", "--at", "0", "--size", "50x30"}).status, 0);
  const Image image = readPng(folder / "a.png");
  EXPECT_EQ(image.width, 50);
  EXPECT_EQ(image.height, 30);
}

TEST_F(Render, StreamsY4m) {
  // `-o -` gives every frame on standard output, and nothing else there.
  const RunResult run = render({"-o", "-"}, folder / "film.y4m");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(decodeFilm(folder / "film.y4m").times.size(), 15u);
}

TEST_F(Render, TellsProgressInTenths) {
  // Off a terminal there is a line for each 10%, each with frame, per cent and time left, and one at the end.
  const RunResult run = render({"-o", "a.mp4"});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 11) << run.err;
  EXPECT_NE(run.err.find("frame 15 of 15, 100%"), std::string::npos) << run.err;
  EXPECT_EQ(run.err.find('\r'), std::string::npos);
}

TEST_F(Render, WritesFiguresOfTheFilm) {
  // The same names as from `simulate`, for every step of the duration, and the speed of the film; of a part
  // of the film, up to its last frame.
  ASSERT_EQ(render({"-o", "a.mp4", "--stats", "s.json"}).status, 0);
  const nlohmann::json json = nlohmann::json::parse(fileText(folder / "s.json"));
  EXPECT_EQ(json["steps"].size(), 30u);  // though frame 14 is after 28 steps
  EXPECT_EQ(json["summary"]["steps"], 30);
  EXPECT_GT(json["summary"]["film_fps"].get<double>(), 0);
  ASSERT_EQ(render({"-o", "b.mp4", "--frames", "2-4", "--stats", "part.json"}).status, 0);
  EXPECT_EQ(nlohmann::json::parse(fileText(folder / "part.json"))["steps"].size(), 8u);
}

TEST_F(Render, RefusesToReplaceAFileUnasked) {
  // Status 4, the name and the way out, and the file is as it was; with -y it is replaced.
  writeText(folder / "a.mp4", "precious");
  const RunResult refused = render({"-o", "a.mp4"});
  EXPECT_EQ(refused.status, 4);
  EXPECT_NE(refused.err.find("a.mp4"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("-y"), std::string::npos) << refused.err;
  EXPECT_EQ(fileText(folder / "a.mp4"), "precious");
  ASSERT_EQ(render({"-o", "a.mp4", "-y"}).status, 0);
  EXPECT_EQ(decodeFilm(folder / "a.mp4").times.size(), 15u);
}

TEST_F(Render, OneFileUnderTwoNamesIsRefused) {
  // Two films cannot be written into one file, also by two runs at once: nothing is spoilt, nothing left.
  std::filesystem::create_symlink(".", folder / "here");
  for (const char* other : {"./x.mp4", "here/x.mp4"}) {
    const RunResult result = render({"-o", "x.mp4", "-o", other});
    EXPECT_EQ(result.status, 4) << result.err;
    EXPECT_NE(result.err.find("is being written already"), std::string::npos) << result.err;
    EXPECT_EQ(written(), std::set<std::string>{"here"});
  }
}

TEST_F(Render, FolderThatCannotBeWrittenIsAnInputOutputError) {
  // A file in place of a folder, a folder that is not there, one that takes no files: status 4, and no film
  // beside.
  writeText(folder / "file", "");
  for (const char* name :
       {"file/a.mp4", "file/%d.png", "nowhere/a.mp4", "nowhere/a.png", "/proc/a.mp4", "/proc/a.png"}) {
    const RunResult run = render({"-o", "good.mp4", "-o", name});
    EXPECT_EQ(run.status, 4) << name << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_EQ(written(), std::set<std::string>{"file"}) << name;
  }
}

TEST_F(Render, FullDiskIsAnInputOutputError) {
  // Whatever the form, a disk that is full ends the run with 4 and its reason, and no other file is left.
  for (const char* name : {"a.mp4", "a.mkv", "a.png"}) {
    std::filesystem::create_symlink("/dev/full", folder / name);
    const RunResult run = render({"-o", name, "--quiet"});
    EXPECT_EQ(run.status, 4) << name << run.err;
    EXPECT_NE(run.err.find("No space left"), std::string::npos) << name << run.err;
    EXPECT_EQ(written(), std::set<std::string>{name});
    std::filesystem::remove(folder / name);
  }
  const RunResult stream = render({"-o", "-", "--quiet"}, "/dev/full");
  EXPECT_EQ(stream.status, 4);
  EXPECT_NE(stream.err.find("standard output: No space left"), std::string::npos) << stream.err;
}

TEST_F(Render, OddSizeIsRefusedBeforeTheRun) {
  // H.264 cannot have it: the message names a size that goes. The lossless form takes it.
  const RunResult run = render({"-o", "a.mp4", "--size", "65x32"});
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("66x32"), std::string::npos) << run.err;
  EXPECT_TRUE(written().empty());
  EXPECT_EQ(render({"-o", "a.mkv", "--size", "65x33"}).status, 0);
}

TEST_F(Render, CtrlCLeavesNothingHalfDone) {
  // In the middle of a film: status 130, and nothing under the final names nor beside them; frames that are
  // whole stay.
  ProgramRun run({"render", "scene.yaml", "--set", "time.duration=3000", "-o", "a.mp4", "-o", "b.mkv", "-o",
                  "c.png", "-o", "f/%d.png", "--stats", "s.json"},
                 folder.path());
  ASSERT_TRUE(run.waitUntil([&] { return std::filesystem::exists(folder / "f/20.png"); })) << run.errSoFar();
  run.signal(SIGINT);
  const RunResult result = run.wait();
  EXPECT_EQ(result.status, 130) << result.err;
  EXPECT_EQ(written(), std::set<std::string>{"f"});
  for (const auto& entry : std::filesystem::directory_iterator(folder / "f"))
    EXPECT_NO_THROW(readPng(entry.path()));
}

TEST_F(Render, CtrlCStopsTheCoarseRunToo) {
  // While the ranges of the colours are being found, before any frame.
  ProgramRun run({"render", "scene.yaml", "--set", "time.duration=30000", "--set", "view.layers=[pressure]",
                  "-o", "a.mp4"},
                 folder.path());
  ASSERT_TRUE(run.waitUntil([&] { return std::filesystem::exists(folder / "a.mp4.part"); }))
      << run.errSoFar();
  run.signal(SIGINT);
  const RunResult result = run.wait();
  EXPECT_EQ(result.status, 130) << result.err;
  EXPECT_EQ(written(), std::set<std::string>{});
}

TEST_F(Render, ReaderThatGoesAwayIsAnInputOutputError) {
  // `smokebox render -o - | head` ends with a message, not by a signal.
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  ProgramRun run({"render", "scene.yaml", "--set", "time.duration=3000", "-o", "-", "--quiet"}, folder.path(),
                 folder / "pipe");
  {
    std::ifstream reader(folder / "pipe", std::ios::binary);
    char byte = 0;
    ASSERT_TRUE(reader.get(byte));
  }
  const RunResult result = run.wait();
  EXPECT_EQ(result.status, 4);
  EXPECT_NE(result.err.find("Broken pipe"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace smokebox
