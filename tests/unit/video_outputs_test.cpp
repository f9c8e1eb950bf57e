// What an `-o` means, numbered frames, stills, and the uncompressed stream.
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>

#include "base/errors.h"
#include "base/part_file.h"
#include "image/png.h"
#include "support/decoded_film.h"
#include "support/temporary_folder.h"
#include "video/png_sinks.h"
#include "video/sink.h"
#include "video/y4m_sink.h"

namespace smokebox {
namespace {

Image flat(int width, int height, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  Image image(width, height);
  for (std::size_t k = 0; k < image.rgba.size(); k += 4) {
    image.rgba[k] = r, image.rgba[k + 1] = g, image.rgba[k + 2] = b, image.rgba[k + 3] = 255;
  }
  return image;
}

FilmFormat small() { return {16, 8, 30, {{"scene", "wake"}}}; }

TEST(OutputKind, FollowsTheEnding) {
  // The ending alone picks the form; capitals count as small letters.
  EXPECT_EQ(outputKind("film.mp4"), OutputKind::mp4);
  EXPECT_EQ(outputKind("a.b/FILM.MP4"), OutputKind::mp4);
  EXPECT_EQ(outputKind("film.mkv"), OutputKind::mkv);
  EXPECT_EQ(outputKind("still.png"), OutputKind::pngStill);
  EXPECT_EQ(outputKind("50%.png"), OutputKind::pngStill);
  EXPECT_EQ(outputKind("frames/%05d.png"), OutputKind::pngSequence);
  EXPECT_EQ(outputKind("frames/%d.png"), OutputKind::pngSequence);
  EXPECT_EQ(outputKind("-"), OutputKind::y4m);
}

TEST(OutputKind, UnknownEndingNamesThoseThatThereAre) {
  // A wrong ending is wrong usage, and the message lists the right ones.
  for (const char* name : {"film.avi", "film", "film.mp4x", "mp4", "", "/dev/full"}) {
    try {
      outputKind(name);
      FAIL() << name;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(".mkv"), std::string::npos) << error.what();
    }
  }
}

TEST(FramePattern, HasExactlyOneField) {
  // Two numbers in a name, or one in a folder's, are wrong usage.
  EXPECT_THROW(FramePattern::parse("a_%d_%d.png"), UsageError);
  EXPECT_THROW(FramePattern::parse("run%d/a.png"), UsageError);
  EXPECT_THROW(FramePattern::parse("run%d/%05d.png"), UsageError);
  EXPECT_THROW(FramePattern::parse("%099d.png"), UsageError);
  EXPECT_FALSE(FramePattern::parse("a.png").has_value());
}

TEST(FramePattern, WritesTheNumberAsAsked) {
  // Zeros fill up to the width; longer numbers are never cut.
  EXPECT_EQ(FramePattern::parse("f/%05d.png")->file(42), "f/00042.png");
  EXPECT_EQ(FramePattern::parse("f/x%dy.png")->file(42), "f/x42y.png");
  EXPECT_EQ(FramePattern::parse("%02d.png")->file(1234), "1234.png");
  EXPECT_EQ(FramePattern::parse("100%_%03d.png")->file(7), "100%_007.png");
  EXPECT_TRUE(FramePattern::parse("f/%05d.png")->matches("00042.png"));
  EXPECT_FALSE(FramePattern::parse("f/%05d.png")->matches("42.png"));
  EXPECT_FALSE(FramePattern::parse("f/%05d.png")->matches("0004a.png"));
}

TEST(PngSequence, MakesItsFolderAndNumbersItsFrames) {
  // A frame's file has the number that the film gives it, and is whole as soon as it is there.
  TemporaryFolder folder;
  const auto sink = openSink((folder / "new/deep/%03d.png").string(), small());
  sink->add(flat(16, 8, 1, 2, 3), 7);
  const Image image = readPng(folder / "new/deep/007.png");
  EXPECT_EQ(image.width, 16);
  EXPECT_EQ(image.rgba[2], 3);
  sink->add(flat(16, 8, 4, 5, 6), 8);
  sink->finish();
  EXPECT_EQ(readPng(folder / "new/deep/008.png").rgba[0], 4);
  EXPECT_EQ(readPngMetadata(folder / "new/deep/008.png"), (Metadata{{"scene", "wake"}}));
}

TEST(PngStill, IsTheLastImageAndOnlyThereWhenFinished) {
  // Until finish() nothing stands under the name.
  TemporaryFolder folder;
  const auto sink = openSink((folder / "still.png").string(), small());
  sink->add(flat(16, 8, 1, 2, 3), 0);
  sink->add(flat(16, 8, 9, 8, 7), 1);
  EXPECT_TRUE(folder.names().empty());
  sink->finish();
  EXPECT_EQ(readPng(folder / "still.png").rgba[0], 9);
}

TEST(PngStill, FolderThatTakesNoFilesIsFoundBeforeTheFirstFrame) {
  // Opening is enough to see that nothing can be written there.
  TemporaryFolder folder;
  writeText(folder / "file", "");
  EXPECT_THROW(openSink((folder / "file/still.png").string(), small()), IoError);
  EXPECT_THROW(openSink((folder / "file/%d.png").string(), small()), IoError);
  EXPECT_THROW(openSink("/proc/still.png", small()), IoError);
  EXPECT_THROW(openSink("/proc/%d.png", small()), IoError);
}

TEST(RefuseExisting, NamesWhatIsThereAndTheWayOut) {
  // A file is not replaced unasked; -y is named in the message.
  TemporaryFolder folder;
  writeText(folder / "film.mp4", "precious");
  writeText(folder / "00003.png", "precious");
  for (const char* name : {"film.mp4", "%05d.png"}) {
    try {
      refuseExisting((folder / name).string());
      FAIL() << name;
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find("-y"), std::string::npos);
    }
  }
  EXPECT_NO_THROW(refuseExisting((folder / "other.mp4").string()));
  EXPECT_NO_THROW(refuseExisting((folder / "%04d_.png").string()));
  EXPECT_NO_THROW(refuseExisting((folder / "not/there/%04d.png").string()));
  EXPECT_NO_THROW(refuseExisting("-"));
}

TEST(Y4m, StreamCanBeReadBack) {
  // Header, frames and colours come back through libav's own reader, for odd sizes too.
  TemporaryFolder folder;
  const std::filesystem::path file = folder / "film.y4m";
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  ASSERT_NE(stream, nullptr);
  Y4mSink sink(fileno(stream), "stream", {33, 17, 25, {}});
  for (int k = 0; k < 5; ++k) sink.add(flat(33, 17, 255, 179, 71), k);
  sink.finish();
  std::fclose(stream);
  const DecodedFilm film = decodeFilm(file);
  EXPECT_EQ(film.width, 33);
  EXPECT_EQ(film.height, 17);
  EXPECT_DOUBLE_EQ(film.framesPerSecond, 25);
  ASSERT_EQ(film.middle.size(), 5u);
  const std::array<double, 3> rgb = rgbOfBt709(film.middle[4]);
  EXPECT_NEAR(rgb[0], 255, 3);
  EXPECT_NEAR(rgb[1], 179, 3);
  EXPECT_NEAR(rgb[2], 71, 3);
}

TEST(Y4m, FullDiskAndGoneReaderAreIoErrors) {
  // What write() refuses is reported with its reason.
  std::signal(SIGPIPE, SIG_IGN);
  std::FILE* full = std::fopen("/dev/full", "wb");
  ASSERT_NE(full, nullptr);
  Y4mSink toFull(fileno(full), "stream", small());
  EXPECT_THROW(toFull.add(flat(16, 8, 0, 0, 0), 0), IoError);
  std::fclose(full);
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  close(ends[0]);
  Y4mSink toNobody(ends[1], "stream", small());
  EXPECT_THROW(toNobody.add(flat(16, 8, 0, 0, 0), 0), IoError);
  close(ends[1]);
}

TEST(PartFile, AppearsOnlyWhenCommitted) {
  // What is broken off leaves nothing; what is committed replaces the old file in one step.
  TemporaryFolder folder;
  writeText(folder / "a", "old");
  { const PartFile part(folder / "a"); }
  EXPECT_EQ(fileText(folder / "a"), "old");
  EXPECT_EQ(folder.names(), std::set<std::string>{"a"});
  writeWholeFile(folder / "a", "new");
  EXPECT_EQ(fileText(folder / "a"), "new");
  EXPECT_EQ(folder.names(), std::set<std::string>{"a"});
}

TEST(PartFile, RefusesFoldersAndFullDisks) {
  // A folder is no file; a device that is full says so.
  TemporaryFolder folder;
  EXPECT_THROW(PartFile(folder.path()), IoError);
  EXPECT_THROW(writeWholeFile("/dev/full", "text"), IoError);
  EXPECT_NO_THROW(writeWholeFile("/dev/null", "text"));
}

}  // namespace
}  // namespace smokebox
