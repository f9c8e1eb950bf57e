#include "image/png.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/errors.h"

namespace smokebox {
namespace {

namespace fs = std::filesystem;

class ImagePng : public testing::Test {
 protected:
  ImagePng() {
    folder_ = fs::temp_directory_path() / ("smokebox_png_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  ~ImagePng() override { fs::remove_all(folder_); }

  static Image pattern(int width, int height) {
    Image image(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        std::uint8_t* p = image.rgba.data() + 4 * (std::size_t(y) * width + x);
        p[0] = static_cast<std::uint8_t>(7 * x);
        p[1] = static_cast<std::uint8_t>(5 * y);
        p[2] = static_cast<std::uint8_t>(x ^ y);
        p[3] = 255;
      }
    return image;
  }
  static std::string bytes(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  fs::path folder_;
};

TEST_F(ImagePng, RoundTripKeepsEveryPixel) {
  // What is written is read back exactly, odd sizes too, and nothing but the file is left.
  for (const auto& [w, h] : {std::pair{1, 1}, {37, 21}, {320, 200}}) {
    const Image image = pattern(w, h);
    writePng(folder_ / "a.png", image, {});
    const Image back = readPng(folder_ / "a.png");
    EXPECT_EQ(back.width, w);
    EXPECT_EQ(back.height, h);
    EXPECT_EQ(back.rgba, image.rgba);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
  }
}

TEST_F(ImagePng, MetadataComesBackInOrder) {
  // Text chunks keep their order and their letters, beyond ASCII too.
  const Metadata metadata{{"Title", "wake"}, {"Software", "smokebox 0.1.0"}, {"Comment", "Größe 5 µm"}};
  writePng(folder_ / "m.png", pattern(8, 8), metadata);
  EXPECT_EQ(readPngMetadata(folder_ / "m.png"), metadata);
}

TEST_F(ImagePng, SecondRunGivesTheSameBytes) {
  // No clock time goes into a file.
  writePng(folder_ / "1.png", pattern(64, 48), {{"Title", "t"}});
  writePng(folder_ / "2.png", pattern(64, 48), {{"Title", "t"}});
  EXPECT_EQ(bytes(folder_ / "1.png"), bytes(folder_ / "2.png"));
}

TEST_F(ImagePng, FullDiskIsAnIoError) {
  // The failure of a full disk shows at the latest when the file is closed, and is reported.
  EXPECT_THROW(writePng("/dev/full", pattern(16, 16), {}), IoError);
  EXPECT_THROW(writePng("/dev/full", pattern(1000, 1000), {}), IoError);
}

TEST_F(ImagePng, UnwritablePlacesAreIoErrors) {
  // A missing folder, and a folder in place of the file.
  EXPECT_THROW(writePng(folder_ / "none" / "a.png", pattern(4, 4), {}), IoError);
  EXPECT_THROW(writePng(folder_, pattern(4, 4), {}), IoError);
}

TEST_F(ImagePng, WhatIsNoPngIsAnIoError) {
  // A missing file, a folder, an empty file, text, and a PNG that was cut off.
  EXPECT_THROW(readPng(folder_ / "none.png"), IoError);
  EXPECT_THROW(readPng(folder_), IoError);
  std::ofstream(folder_ / "empty.png").flush();
  EXPECT_THROW(readPng(folder_ / "empty.png"), IoError);
  std::ofstream(folder_ / "text.png") << "this is no picture at all";
  EXPECT_THROW(readPng(folder_ / "text.png"), IoError);
  writePng(folder_ / "whole.png", pattern(100, 100), {});
  const std::string whole = bytes(folder_ / "whole.png");
  std::ofstream(folder_ / "cut.png", std::ios::binary) << whole.substr(0, whole.size() / 2);
  EXPECT_THROW(readPng(folder_ / "cut.png"), IoError);
}

}  // namespace
}  // namespace smokebox
