// Films read back as pictures: every frame, in its colours, and what is no film.
#include "video/film_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/errors.h"
#include "image/difference.h"
#include "support/temporary_folder.h"
#include "video/rgb.h"
#include "video/sink.h"
#include "video/yuv.h"

namespace smokebox {
namespace {

using Pixel = std::array<double, 3>;

Image painted(int width, int height, const std::function<Pixel(int, int)>& pixel) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Pixel value = pixel(x, y);
      std::uint8_t* const to = image.rgba.data() + 4 * (std::size_t(y) * width + x);
      for (int c = 0; c < 3; ++c) to[c] = static_cast<std::uint8_t>(std::lround(value[c]));
      to[3] = 255;
    }
  return image;
}

/// Each pixel and each frame another colour.
Image noise(int width, int height, int frame) {
  unsigned state = static_cast<unsigned>(frame);
  return painted(width, height, [&](int, int) {
    Pixel value;
    for (double& v : value) {
      state = state * 1664525u + 1013904223u;
      v = state >> 24;
    }
    return value;
  });
}

/// Smooth, of many colours, no two frames the same.
Image scenery(int width, int height, int frame) {
  return painted(width, height, [&](int x, int y) {
    const double u = 6.0 * x / width, v = 5.0 * y / height, t = 0.2 * frame;
    return Pixel{128 + 90 * std::sin(u + t), 128 + 90 * std::cos(v - t), 128 + 90 * std::sin(u + v)};
  });
}

void writeFilm(const std::filesystem::path& file, int width, int height, int frames, int fps,
               const std::function<Image(int)>& picture, long first = 0) {
  const auto sink = openSink(file.string(), {width, height, fps, {}});
  for (int k = 0; k < frames; ++k) sink->add(picture(k), first + k);
  sink->finish();
}

/// An uncompressed film; `tags` go into its header.
void writeY4m(const std::filesystem::path& file, int width, int height, const std::string& tags,
              const std::string& planes, int frames = 1) {
  std::string text =
      "YUV4MPEG2 W" + std::to_string(width) + " H" + std::to_string(height) + " F24:1 Ip A1:1 " + tags + "\n";
  for (int k = 0; k < frames; ++k) text += "FRAME\n" + planes;
  writeText(file, text);
}

std::vector<Image> readFilm(const std::filesystem::path& file) {
  FilmReader reader(file.string());
  std::vector<Image> images;
  for (Image image; reader.next(image);) images.push_back(image);
  EXPECT_EQ(reader.count(), static_cast<long>(images.size()));
  return images;
}

std::string reasonAgainst(const std::filesystem::path& file) {
  try {
    readFilm(file);
  } catch (const IoError& error) {
    EXPECT_EQ(std::string(error.what()).find(file.parent_path().string()), 0u) << error.what();
    return error.what();
  }
  ADD_FAILURE() << file << " was read";
  return "";
}

TEST(FilmReader, GivesALosslessFilmBackToTheByte) {
  // FFV1, at an odd size too, and the folder of its frames: all pictures are those that went in.
  for (const char* name : {"film.mkv", "frames/%05d.png", "f %3d.png", "50%/%d.png"}) {
    TemporaryFolder folder;
    writeFilm(folder / name, 65, 47, 12, 24, [](int k) { return noise(65, 47, k); });
    FilmReader reader((folder / name).string());
    EXPECT_EQ(reader.width(), 65);
    EXPECT_EQ(reader.height(), 47);
    const std::vector<Image> images = readFilm(folder / name);
    ASSERT_EQ(images.size(), 12u) << name;
    for (int k = 0; k < 12; ++k) EXPECT_EQ(images[k].rgba, noise(65, 47, k).rgba) << name << " " << k;
  }
}

TEST(FilmReader, GivesAllFramesOfAnEncodedFilm) {
  // H.264 keeps back frames until its end: 50 go in, 50 come out, each near to its own picture.
  TemporaryFolder folder;
  writeFilm(folder / "film.mp4", 320, 180, 50, 25, [](int k) { return scenery(320, 180, k); });
  FilmReader reader((folder / "film.mp4").string());
  EXPECT_DOUBLE_EQ(reader.fps(), 25);
  int frame = 0;
  for (Image image; reader.next(image); ++frame) {
    const ImageDifference own = measureDifference(scenery(320, 180, frame), image);
    EXPECT_GT(own.psnr, 40) << frame;
    EXPECT_LT(measureDifference(scenery(320, 180, frame + 1), image).psnr, 30) << frame;
  }
  EXPECT_EQ(frame, 50);
}

TEST(FilmReader, KnowsTheFrameRate) {
  // That of the film; a folder of pictures has none.
  TemporaryFolder folder;
  for (const char* name : {"a.mp4", "a.mkv", "a%d.png"})
    writeFilm(folder / name, 64, 48, 30, 30, [](int k) { return scenery(64, 48, k); });
  writeY4m(folder / "a.y4m", 2, 2, "C420mpeg2", std::string(6, '\x80'), 3);
  EXPECT_NEAR(FilmReader((folder / "a.mp4").string()).fps(), 30, 1e-9);
  EXPECT_NEAR(FilmReader((folder / "a.mkv").string()).fps(), 30, 1e-3);
  EXPECT_NEAR(FilmReader((folder / "a.y4m").string()).fps(), 24, 1e-9);
  EXPECT_EQ(FilmReader((folder / "a%d.png").string()).fps(), 0);
}

TEST(RgbConverter, PutsChromaWhereItWasTaken) {
  // Colour that rises by 8 levels a pixel along x, and by 4 along y, comes back without a bias: a siting that
  // is wrong by half a pixel would be off by 2 and 1 levels and more.
  for (const bool along : {true, false}) {
    const int width = 256, height = 256;
    const Image image = painted(width, height, [&](int x, int y) {
      const double rise = along ? 8.0 * std::abs(x % 32 - 16) : 4.0 * std::abs(y % 64 - 32);
      return Pixel{50 + rise, 120, 200 - rise};
    });
    const libav::Frame frame = libav::makeFrame(width, height, AV_PIX_FMT_YUV420P);
    YuvConverter(width, height).convert(image, *frame);
    frame->colorspace = AVCOL_SPC_BT709;
    for (const AVChromaLocation where : {AVCHROMA_LOC_LEFT, AVCHROMA_LOC_UNSPECIFIED}) {
      frame->chroma_location = where;
      Image back;
      RgbConverter("film").convert(*frame, back);
      double bias = 0, count = 0;
      for (int y = 2; y < height - 2; ++y)
        for (int x = 2; x < width - 2; ++x) {
          const bool rising = along ? x % 32 > 18 && x % 32 < 30 : y % 64 > 34 && y % 64 < 62;
          const std::size_t at = 4 * (std::size_t(y) * width + x);
          if (rising) bias += back.rgba[at] - image.rgba[at];
          count += rising;
        }
      EXPECT_LT(std::fabs(bias / count), 0.3) << along << " " << where;
    }
  }
}

/// The picture of a film of one flat colour, in YCbCr.
Pixel rgbOf(const std::array<int, 3>& yuv, int width, int height, const std::string& tags) {
  TemporaryFolder folder;
  const std::size_t pixels = std::size_t(width) * height;
  std::string planes;
  for (int c = 0; c < 3; ++c) planes += std::string(c ? pixels / 4 : pixels, static_cast<char>(yuv[c]));
  writeY4m(folder / "film.y4m", width, height, tags, planes);
  const std::vector<Image> images = readFilm(folder / "film.y4m");
  const std::uint8_t* const at = images.at(0).rgba.data() + 4 * (pixels / 2 + width / 2);
  EXPECT_EQ(at[3], 255);
  return {double(at[0]), double(at[1]), double(at[2])};
}

/// After the definition: `red` and `blue` are the weights of the matrix.
Pixel expected(const std::array<int, 3>& yuv, double red, double blue, bool full) {
  const double y = full ? yuv[0] / 255.0 : (yuv[0] - 16) / 219.0;
  const double scale = full ? 255 : 224, cb = (yuv[1] - 128) / scale, cr = (yuv[2] - 128) / scale;
  const double r = y + 2 * (1 - red) * cr, b = y + 2 * (1 - blue) * cb;
  return {255 * r, 255 * (y - red * r - blue * b) / (1 - red - blue), 255 * b};
}

TEST(FilmReader, UntaggedFilmsAreTakenAsPlayersDo) {
  // BT.601 for small pictures, BT.709 from 1280 columns or above 576 lines; of limited range unless the film
  // says otherwise. Values from the definitions of the matrices.
  const std::array<int, 3> yuv{120, 100, 160};
  const auto check = [&](int width, int height, const std::string& tags, const Pixel& truth) {
    const Pixel rgb = rgbOf(yuv, width, height, tags);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], truth[c], 1.01) << width << "x" << height << " " << tags;
  };
  const Pixel small = expected(yuv, 0.299, 0.114, false), large = expected(yuv, 0.2126, 0.0722, false);
  ASSERT_GT(std::fabs(small[1] - large[1]), 3);
  check(64, 32, "C420mpeg2", small);
  check(1024, 576, "C420mpeg2", small);
  check(1024, 578, "C420mpeg2", large);
  check(1280, 32, "C420mpeg2", large);
  check(64, 32, "C420mpeg2 XCOLORRANGE=LIMITED", small);
  check(64, 32, "C420jpeg XCOLORRANGE=FULL", expected(yuv, 0.299, 0.114, true));
}

TEST(FilmReader, TagsOfAFilmAreObeyed) {
  // A small film that is tagged as BT.709 is converted so, though untagged it would be BT.601: flat colours
  // come back within 2 levels.
  for (const Pixel& color : {Pixel{255, 0, 0}, {0, 200, 0}, {30, 60, 220}, {255, 179, 71}, {14, 16, 20}}) {
    TemporaryFolder folder;
    const Image image = painted(64, 48, [&](int, int) { return color; });
    writeFilm(folder / "film.mp4", 64, 48, 3, 30, [&](int) { return image; });
    for (const Image& read : readFilm(folder / "film.mp4"))
      EXPECT_LE(measureDifference(image, read).largest, 2);
  }
}

TEST(FilmReader, GreysOfAFilmKeepTheirRange) {
  // A film of luma alone: full range as pictures have it.
  TemporaryFolder folder;
  std::string ramp;
  for (int k = 0; k < 256; ++k) ramp += static_cast<char>(k);
  writeY4m(folder / "grey.y4m", 256, 1, "Cmono", ramp);
  const std::vector<Image> images = readFilm(folder / "grey.y4m");
  ASSERT_EQ(images.size(), 1u);
  for (int k = 0; k < 256; ++k)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(images[0].rgba[4 * k + c], k, 1);
}

TEST(FilmReader, FolderMayStartAtAnyNumber) {
  // The frames of a part of a film are read from the first that is there to the last.
  TemporaryFolder folder;
  writeFilm(
      folder / "%04d.png", 32, 16, 5, 30, [](int k) { return noise(32, 16, k); }, 137);
  const std::vector<Image> images = readFilm(folder / "%04d.png");
  ASSERT_EQ(images.size(), 5u);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(images[k].rgba, noise(32, 16, k).rgba);
}

TEST(FilmReader, MissingPictureOfAFolderIsNamed) {
  // A gap is an error, not the end of the film.
  TemporaryFolder folder;
  writeFilm(folder / "%04d.png", 32, 16, 9, 30, [](int k) { return noise(32, 16, k); });
  std::filesystem::remove(folder / "0006.png");
  EXPECT_NE(reasonAgainst(folder / "%04d.png").find("0006.png: is not there"), std::string::npos);
  EXPECT_NE(reasonAgainst(folder / "other%04d.png").find("no picture"), std::string::npos);
}

TEST(FilmReader, PictureOfAnotherSizeIsRefused) {
  // All frames of a film have one size.
  TemporaryFolder folder;
  writeFilm(folder / "%d.png", 32, 16, 3, 30, [](int k) { return noise(32, 16, k); });
  writePng(folder / "3.png", noise(16, 32, 3), {});
  EXPECT_NE(reasonAgainst(folder / "%d.png").find("size at frame 3"), std::string::npos);
}

TEST(FilmReader, TakesAnyName) {
  // What looks like an address or a pattern is just a name if it is there.
  for (const char* name :
       {"a film.mp4", "50%.mp4", "%d.mkv", "плюм é.mkv", "http:x.mp4", "-.mkv", "a:b.mp4"}) {
    TemporaryFolder folder;
    const auto file = folder / name;
    const auto sink = openSink(file.string(), {32, 32, 30, {}});
    sink->add(noise(32, 32, 0), 0);
    sink->finish();
    ASSERT_TRUE(std::filesystem::exists(file)) << name;
    EXPECT_EQ(readFilm(file).size(), 1u) << name;
  }
}

TEST(FilmReader, WhatIsNoFilmIsAnIoError) {
  // The error names the file and says why.
  TemporaryFolder folder;
  writeText(folder / "text.mp4", "title: a scene\ndomain: {size: [2, 1]}\n");
  writeText(folder / "empty.mkv", "");
  std::filesystem::create_directory(folder / "folder.mp4");
  EXPECT_NE(reasonAgainst(folder / "none.mp4").find("No such file"), std::string::npos);
  EXPECT_NE(reasonAgainst(folder / "text.mp4").find("cannot be read"), std::string::npos);
  EXPECT_NE(reasonAgainst(folder / "empty.mkv").find("cannot be read"), std::string::npos);
  EXPECT_NE(reasonAgainst(folder / "folder.mp4").find("cannot be read"), std::string::npos);
  EXPECT_NE(reasonAgainst(folder / "nowhere" / "%d.png").find("No such file"), std::string::npos);
}

TEST(FilmReader, DamagedFilmIsAnIoError) {
  // A film with wrong bytes does not pass for a worse one, nor one that was cut off for a whole one.
  for (const char* name : {"film.mp4", "film.mkv"}) {
    TemporaryFolder folder;
    writeFilm(folder / name, 64, 48, 20, 30, [](int k) { return noise(64, 48, k); });
    const std::string bytes = fileText(folder / name);
    std::string wrong = bytes;
    for (std::size_t k = 0; k < 400; ++k) wrong[bytes.size() / 2 + k] = static_cast<char>(k * 37 % 251);
    const std::string bad = std::string("bad_") + name;
    writeText(folder / bad, wrong);
    EXPECT_NE(reasonAgainst(folder / bad).find("damaged"), std::string::npos) << name;
    writeText(folder / bad, bytes.substr(0, bytes.size() / 2));
    if (name == std::string("film.mp4")) {
      EXPECT_NE(reasonAgainst(folder / bad).find("damaged"), std::string::npos);
    } else {  // Matroska does not say how many frames it has
      EXPECT_LT(readFilm(folder / bad).size(), 20u);
    }
  }
}

TEST(FilmReader, PlayListLeadsNowhere) {
  // A list of addresses is not followed off the disk.
  TemporaryFolder folder;
  writeText(folder / "list.m3u8",
            "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nhttp://127.0.0.1:9/a.ts\n#EXT-X-ENDLIST\n");
  EXPECT_NE(reasonAgainst(folder / "list.m3u8"), "");
}

}  // namespace
}  // namespace smokebox
