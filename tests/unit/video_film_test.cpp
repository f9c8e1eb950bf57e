// Films: what a player sees of them.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cmath>
#include <csignal>

#include "base/errors.h"
#include "support/decoded_film.h"
#include "support/temporary_folder.h"
#include "video/sink.h"

namespace smokebox {
namespace {

Image flat(int width, int height, std::array<int, 3> color) {
  Image image(width, height);
  for (std::size_t k = 0; k < image.rgba.size(); k += 4) {
    for (int c = 0; c < 3; ++c) image.rgba[k + c] = static_cast<std::uint8_t>(color[c]);
    image.rgba[k + 3] = 255;
  }
  return image;
}

/// Each pixel another colour.
Image noise(int width, int height, unsigned seed) {
  Image image(width, height);
  unsigned state = seed;
  for (std::size_t k = 0; k < image.rgba.size(); ++k) {
    state = state * 1664525u + 1013904223u;
    image.rgba[k] = k % 4 == 3 ? 255 : static_cast<std::uint8_t>(state >> 24);
  }
  return image;
}

FilmFormat formatOf(int width, int height, int fps) {
  return {
      width, height, fps, {{"title", "Smoke, “é”"}, {"scene", "wake"}, {"scene_hash", "0123456789abcdef"}}};
}

void writeFilm(const std::filesystem::path& file, const FilmFormat& format, int frames) {
  const auto sink = openSink(file.string(), format);
  for (int k = 0; k < frames; ++k) sink->add(noise(format.width, format.height, k), k);
  sink->finish();
}

TEST(Mp4, HasEveryFrameForItsTime) {
  // 50 frames at 25 frames/s last two seconds, and frame k is shown at k/25 s.
  TemporaryFolder folder;
  writeFilm(folder / "film.mp4", formatOf(64, 48, 25), 50);
  const DecodedFilm film = decodeFilm(folder / "film.mp4");
  EXPECT_EQ(film.codec, AV_CODEC_ID_H264);
  EXPECT_EQ(film.width, 64);
  EXPECT_EQ(film.height, 48);
  EXPECT_DOUBLE_EQ(film.framesPerSecond, 25);
  EXPECT_NEAR(film.duration, 2, 1e-3);
  ASSERT_EQ(film.times.size(), 50u);
  for (int k = 0; k < 50; ++k) EXPECT_NEAR(film.times[k], k / 25.0, 1e-4) << k;
}

TEST(Mp4, OneFrameLastsItsTime) {
  // The shortest film has one frame, and its duration is that frame's.
  TemporaryFolder folder;
  writeFilm(folder / "film.mp4", formatOf(64, 48, 30), 1);
  const DecodedFilm film = decodeFilm(folder / "film.mp4");
  EXPECT_EQ(film.times.size(), 1u);
  EXPECT_NEAR(film.duration, 1.0 / 30, 1e-3);
}

TEST(Mp4, ColoursAreThoseOfTheImage) {
  // A flat colour comes back within 3 of 255 when the player does what the tags say.
  for (const std::array<int, 3> color : {std::array<int, 3>{255, 0, 0},
                                         {0, 255, 0},
                                         {0, 0, 255},
                                         {255, 255, 255},
                                         {0, 0, 0},
                                         {255, 179, 71},
                                         {14, 16, 20},
                                         {128, 128, 128}}) {
    TemporaryFolder folder;
    const auto sink = openSink((folder / "film.mp4").string(), formatOf(64, 48, 30));
    for (int k = 0; k < 3; ++k) sink->add(flat(64, 48, color), k);
    sink->finish();
    const DecodedFilm film = decodeFilm(folder / "film.mp4");
    ASSERT_EQ(film.middle.size(), 3u);
    const std::array<double, 3> rgb = rgbOfBt709(film.middle[1]);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], color[c], 3) << "component " << c;
  }
}

TEST(Mp4, IsTaggedAsBt709LimitedRange) {
  // Every player must know the matrix, the primaries, the transfer curve and the range without guessing.
  TemporaryFolder folder;
  writeFilm(folder / "film.mp4", formatOf(64, 48, 30), 3);
  const DecodedFilm film = decodeFilm(folder / "film.mp4");
  EXPECT_EQ(film.pixelFormat, AV_PIX_FMT_YUV420P);
  EXPECT_EQ(film.matrix, AVCOL_SPC_BT709);
  EXPECT_EQ(film.primaries, AVCOL_PRI_BT709);
  EXPECT_EQ(film.transfer, AVCOL_TRC_BT709);
  EXPECT_EQ(film.range, AVCOL_RANGE_MPEG);
}

TEST(Mp4, StartsPlayingBeforeItIsAllThere) {
  // The index (moov) stands before the pictures (mdat).
  TemporaryFolder folder;
  writeFilm(folder / "film.mp4", formatOf(64, 48, 30), 10);
  const std::string bytes = fileText(folder / "film.mp4");
  ASSERT_NE(bytes.find("moov"), std::string::npos);
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
}

TEST(Film, CarriesItsMetadata) {
  // Title, scene and hash come back from both kinds of film.
  for (const char* name : {"film.mp4", "film.mkv"}) {
    TemporaryFolder folder;
    writeFilm(folder / name, formatOf(64, 48, 30), 2);
    std::map<std::string, std::string> found;
    for (const auto& [key, value] : decodeFilm(folder / name).metadata) {
      std::string small = key;  // Matroska has its tags in capitals
      for (char& c : small) c = static_cast<char>(std::tolower(c));
      found[small] = value;
    }
    EXPECT_EQ(found["title"], "Smoke, “é”") << name;
    EXPECT_EQ(found["scene"], "wake") << name;
    EXPECT_EQ(found["scene_hash"], "0123456789abcdef") << name;
    EXPECT_EQ(found.count("creation_time"), 0u) << name;
  }
}

TEST(Film, SecondRunGivesTheSameBytes) {
  // Nothing of the clock or of the order of threads goes into a film.
  for (const char* ending : {".mp4", ".mkv"}) {
    TemporaryFolder folder;
    const std::filesystem::path a = folder / (std::string("a") + ending),
                                b = folder / (std::string("b") + ending);
    writeFilm(a, formatOf(320, 240, 30), 40);
    writeFilm(b, formatOf(320, 240, 30), 40);
    EXPECT_EQ(fileText(a), fileText(b)) << ending;
  }
}

TEST(Mkv, LosesNothing) {
  // Each frame comes back with its very colours, at odd sizes too.
  TemporaryFolder folder;
  const FilmFormat format = formatOf(65, 47, 24);
  writeFilm(folder / "film.mkv", format, 12);
  const DecodedFilm film = decodeFilm(folder / "film.mkv");
  EXPECT_EQ(film.codec, AV_CODEC_ID_FFV1);
  EXPECT_NEAR(film.duration, 0.5, 2e-3);
  ASSERT_EQ(film.middle.size(), 12u);
  for (int k = 0; k < 12; ++k) {
    const Image image = noise(65, 47, k);
    const std::size_t at = 4 * (std::size_t{47 / 2} * 65 + 65 / 2);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(film.middle[k][c], image.rgba[at + c]);
  }
}

TEST(Mp4, RefusesOddSizes) {
  // 4:2:0 has one colour for two by two pixels: the message says what to do instead.
  TemporaryFolder folder;
  try {
    openSink((folder / "film.mp4").string(), formatOf(1281, 720, 30));
    FAIL() << "an odd width was taken";
  } catch (const VideoError& error) {
    EXPECT_NE(std::string(error.what()).find("1281x720"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("try 1280x720"), std::string::npos) << error.what();
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(Film, NothingStandsUnderItsNameBeforeItIsWhole) {
  // While a film is written, and after it was broken off, its name does not exist.
  for (const char* name : {"film.mp4", "film.mkv"}) {
    TemporaryFolder folder;
    {
      const auto sink = openSink((folder / name).string(), formatOf(64, 48, 30));
      for (int k = 0; k < 60; ++k) sink->add(noise(64, 48, k), k);
      EXPECT_FALSE(std::filesystem::exists(folder / name));
    }
    EXPECT_TRUE(folder.names().empty()) << name;
  }
}

TEST(Film, TakesAnyName) {
  // Blanks, signs and letters of any script, and what looks like an address, are just names.
  for (const char* name : {"a film.mp4", "50%.mp4", "%d.mp4", "плюм é.mkv", "http:x.mp4", "-.mkv"}) {
    TemporaryFolder folder;
    writeFilm(folder / name, formatOf(32, 32, 30), 2);
    EXPECT_EQ(folder.names(), std::set<std::string>{name});
    EXPECT_EQ(decodeFilm(folder / name).times.size(), 2u) << name;
  }
}

TEST(Film, FullDeviceIsAnIoError) {
  // A link to a device is written through, and its full disk reported, whatever the form.
  for (const char* name : {"film.mp4", "film.mkv"}) {
    TemporaryFolder folder;
    std::filesystem::create_symlink("/dev/full", folder / name);
    try {
      writeFilm(folder / name, formatOf(320, 240, 30), 30);
      FAIL() << name << ": a full disk was not noticed";
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(std::filesystem::is_symlink(folder / name)) << name;
  }
}

/// Exits with 4 if the film is too large for a limit on the size of files.
[[noreturn]] void writeUnderLimit(const std::filesystem::path& file) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{100'000, 100'000};
  setrlimit(RLIMIT_FSIZE, &limit);
  try {
    writeFilm(file, formatOf(320, 240, 30), 30);
  } catch (const IoError& error) {
    std::fprintf(stderr, "IoError %s", error.what());
    std::_Exit(4);
  }
  std::_Exit(0);
}

TEST(Film, DiskThatFillsUpIsAnIoErrorAndLeavesNothing) {
  // When the file cannot grow any more, the error says so and the part is removed.
  for (const char* name : {"film.mp4", "film.mkv"}) {
    TemporaryFolder folder;
    EXPECT_EXIT(writeUnderLimit(folder / name), testing::ExitedWithCode(4), "IoError .*film.*File too large");
    EXPECT_TRUE(folder.names().empty()) << name;
  }
}

TEST(Film, FolderThatIsNotThereIsNamed) {
  // A film is not written into a folder that does not exist; the error names the folder.
  TemporaryFolder folder;
  try {
    openSink((folder / "nowhere/film.mp4").string(), formatOf(64, 48, 30));
    FAIL() << "no error";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("nowhere"), std::string::npos);
  }
}

TEST(Mp4, PipeIsRefused) {
  // MP4 needs to go back to its beginning, which a pipe cannot: the message says so instead of hanging.
  TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "film.mp4").c_str(), 0600), 0);
  EXPECT_THROW(openSink((folder / "film.mp4").string(), formatOf(64, 48, 30)), IoError);
}

TEST(Film, ReplacesTheFileThatALinkPointsTo) {
  // A link stays a link: the new film stands where it points.
  TemporaryFolder folder;
  std::filesystem::create_directory(folder / "store");
  writeText(folder / "store/real.mp4", "old");
  std::filesystem::create_symlink("store/real.mp4", folder / "film.mp4");
  writeFilm(folder / "film.mp4", formatOf(64, 48, 30), 2);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "film.mp4"));
  EXPECT_EQ(decodeFilm(folder / "store/real.mp4").times.size(), 2u);
}

}  // namespace
}  // namespace smokebox
