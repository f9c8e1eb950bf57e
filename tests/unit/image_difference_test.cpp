// The measure by which pictures are compared: cases with known answers, and what it must and must not see.
#include "image/difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/errors.h"
#include "image/similarity.h"
#include "image/text.h"

namespace smokebox {
namespace {

const DifferenceTolerance kTolerance;

using Pixel = std::array<int, 3>;

Image painted(int width, int height, const std::function<Pixel(int, int)>& pixel) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Pixel value = pixel(x, y);
      std::uint8_t* const to = image.rgba.data() + 4 * (std::size_t(y) * width + x);
      for (int c = 0; c < 3; ++c) to[c] = static_cast<std::uint8_t>(value[c]);
      to[3] = 255;
    }
  return image;
}

/// Grey values only.
Image grey(int width, int height, const std::function<int(int, int)>& level) {
  return painted(width, height, [&](int x, int y) {
    const int value = level(x, y);
    return Pixel{value, value, value};
  });
}

/// A smooth picture, with levels from 20 to 220 and different channels.
Image scenery(int width, int height) {
  return painted(width, height, [&](int x, int y) {
    const double u = double(x) / width, v = double(y) / height;
    return Pixel{int(20 + 200 * u), int(120 + 99 * std::sin(6 * u) * std::cos(5 * v)), int(20 + 200 * v)};
  });
}

/// The picture with `by` added to what lies in a rectangle, in all channels or in one.
Image shifted(Image image, int left, int top, int width, int height, int by, int channel = -1) {
  for (int y = top; y < top + height; ++y)
    for (int x = left; x < left + width; ++x)
      for (int c = 0; c < 3; ++c)
        if (channel < 0 || channel == c) image.rgba[4 * (std::size_t(y) * image.width + x) + c] += by;
  return image;
}

/// A random number that depends on the index alone (SplitMix64).
std::uint64_t randomAt(std::uint64_t index) {
  std::uint64_t z = (index + 1) * 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

Image withText(Image image, const std::string& text, int left, int top) {
  const TextMask mask = TextPainter().line(text, 18);
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x) {
      std::uint8_t* const to = image.rgba.data() + 4 * (std::size_t(top + y) * image.width + left + x);
      for (int c = 0; c < 3; ++c) to[c] = std::max(to[c], mask.coverage[std::size_t(y) * mask.width + x]);
    }
  return image;
}

TEST(ImageDifference, OfEqualPicturesIsNone) {
  // Nothing is off, the noise is infinitely small, the structure the same to the bit.
  const Image image = scenery(320, 180);
  const ImageDifference difference = measureDifference(image, image);
  EXPECT_TRUE(difference.equal());
  EXPECT_TRUE(difference.within({.level = 0, .pixelsOff = 0, .windowOff = 0, .windowShift = 0}));
  EXPECT_EQ(difference.pixelsOff, 0);
  EXPECT_EQ(difference.worstWindow.value, 0);
  EXPECT_EQ(difference.worstShift.value, 0);
  EXPECT_TRUE(std::isinf(difference.psnr));
  EXPECT_EQ(difference.ssim, 1);
  EXPECT_EQ(difference.inWords(kTolerance), "the pictures are equal");
  EXPECT_EQ(difference.whatBreaks(kTolerance), "");
}

TEST(ImageDifference, CountsPixelsThatAreOff) {
  // 30 pixels of 64 x 50, off by 3 in one channel; 2 levels are not counted. The worst window holds 24.
  const Image a = scenery(64, 50);
  Image b = shifted(a, 40, 20, 12, 2, 3, 1);
  b = shifted(b, 4, 44, 6, 1, -3, 2);
  b = shifted(b, 10, 5, 20, 1, 2);
  const ImageDifference difference = measureDifference(a, b);
  EXPECT_DOUBLE_EQ(difference.pixelsOff, 30.0 / (64 * 50));
  EXPECT_EQ(difference.largest, 3);
  EXPECT_DOUBLE_EQ(difference.worstWindow.value, 24.0 / 256);
  EXPECT_LE(difference.worstWindow.x, 40);
  EXPECT_GE(difference.worstWindow.x + 16, 52);
  EXPECT_LE(difference.worstWindow.y, 20);
  EXPECT_GE(difference.worstWindow.y + 16, 22);
  EXPECT_DOUBLE_EQ(measureDifference(a, b, {.level = 1}).pixelsOff, 50.0 / (64 * 50));
  EXPECT_EQ(measureDifference(a, b, {.level = 3}).pixelsOff, 0);
}

TEST(ImageDifference, WindowStandsWhereTheFaultIs) {
  // A block of 16x16 fills exactly one window, and that is the one which is named.
  const Image a = scenery(200, 100);
  for (const auto& [x, y] : {std::pair{0, 0}, {184, 84}, {0, 84}, {184, 0}, {61, 37}}) {
    const ImageDifference difference = measureDifference(a, shifted(a, x, y, 16, 16, 5));
    EXPECT_EQ(difference.worstWindow.value, 1);
    EXPECT_EQ(difference.worstWindow.x, x);
    EXPECT_EQ(difference.worstWindow.y, y);
    EXPECT_EQ(difference.worstShift.x, x);
    EXPECT_EQ(difference.worstShift.y, y);
    EXPECT_NEAR(difference.worstShift.value, 5, 0.05);
  }
}

TEST(ImageDifference, SignalToNoiseIsThatOfTheMeanSquare) {
  // Every component off by 5: 20 log10(255/5) dB. One channel of three off by 6: a mean square of 12.
  const Image a = scenery(40, 30);
  EXPECT_NEAR(measureDifference(a, shifted(a, 0, 0, 40, 30, 5)).psnr, 20 * std::log10(51.0), 1e-12);
  EXPECT_NEAR(measureDifference(a, shifted(a, 0, 0, 40, 30, -6, 1)).psnr, 10 * std::log10(255 * 255 / 12.0),
              1e-12);
}

TEST(ImageDifference, SimilarityIsThatOfTheDefinition) {
  // Values worked out in double precision straight from the definition, window by window, by another program;
  // for flat pictures and for a single bright pixel the formula gives them by hand.
  const Image a = grey(20, 14, [](int x, int y) { return (7 * x + 11 * y) % 256; });
  const Image b = grey(20, 14, [](int x, int y) { return (7 * x + 11 * y + x * y % 23) % 256; });
  EXPECT_NEAR(structuralSimilarity(a, b), 0.939149408017572, 1e-12);

  const double c1 = 2.55 * 2.55, c2 = 7.65 * 7.65;
  const auto flat = [](int level) { return grey(11, 11, [=](int, int) { return level; }); };
  EXPECT_NEAR(structuralSimilarity(flat(100), flat(120)), (2 * 100 * 120 + c1) / (100 * 100 + 120 * 120 + c1),
              2e-6);

  const Image dot = grey(11, 11, [](int x, int y) { return x == 5 && y == 5 ? 255 : 0; });
  double sum = 0;
  for (int y = -5; y <= 5; ++y)
    for (int x = -5; x <= 5; ++x) sum += std::exp(-(x * x + y * y) / 4.5);
  const double mean = 255 / sum, variance = 255 * 255 / sum - mean * mean;
  EXPECT_NEAR(structuralSimilarity(flat(0), dot), c1 / (mean * mean + c1) * c2 / (variance + c2), 1e-15);
}

TEST(ImageDifference, SeesAPatchOfOneLevel) {
  // 20x20 pixels that are one level brighter or darker in one channel are out of tolerance wherever they are,
  // though no pixel is off.
  const Image a = scenery(320, 180);
  for (const auto& [x, y] : {std::pair{0, 0}, {300, 0}, {0, 160}, {300, 160}, {150, 80}, {7, 133}})
    for (const int channel : {-1, 0, 1, 2})
      for (const int by : {1, -1}) {
        const ImageDifference difference = measureDifference(a, shifted(a, x, y, 20, 20, by, channel));
        EXPECT_EQ(difference.pixelsOff, 0);
        EXPECT_NEAR(difference.worstShift.value, 1, 0.02);
        EXPECT_FALSE(difference.within(kTolerance)) << x << ", " << y << " channel " << channel;
        EXPECT_NE(difference.whatBreaks(kTolerance).find("shifted"), std::string::npos);
      }
}

TEST(ImageDifference, LetsTheWholePictureShift) {
  // A whole picture that is up to two levels brighter, also in one channel, is a matter of rounding.
  const Image a = scenery(320, 180);
  for (const int by : {1, 2, -2})
    for (const int channel : {-1, 1}) {
      const ImageDifference difference = measureDifference(a, shifted(a, 0, 0, 320, 180, by, channel));
      EXPECT_TRUE(difference.within(kTolerance)) << difference.inWords(kTolerance);
      EXPECT_EQ(difference.worstShift.value, 0);
      EXPECT_EQ(difference.largest, std::abs(by));
    }
  EXPECT_FALSE(measureDifference(a, shifted(a, 0, 0, 320, 180, 3)).within(kTolerance));
}

TEST(ImageDifference, LetsRoundingBeAnother) {
  // Rounded down instead of to the nearest: about half of the pixels, evenly strewn, are one level lower.
  const Image a = scenery(640, 360);
  Image b = a;
  for (std::size_t k = 0; k < b.rgba.size(); ++k)
    if (k % 4 != 3) b.rgba[k] -= randomAt(k) % 2;
  const ImageDifference difference = measureDifference(a, b);
  EXPECT_TRUE(difference.within(kTolerance)) << difference.inWords(kTolerance);
}

TEST(ImageDifference, LetsNoiseOfTwoLevelsPass) {
  // Noise of -2 to 2 over a whole picture of 1280x720 trips neither the count nor, in 900 000 windows, the
  // shift.
  const Image a = scenery(1280, 720);
  for (const std::uint64_t seed : {0, 1, 2}) {
    Image b = a;
    for (std::size_t k = 0; k < b.rgba.size(); ++k)
      if (k % 4 != 3) b.rgba[k] += static_cast<int>(randomAt(seed << 32 | k) % 5) - 2;
    const ImageDifference difference = measureDifference(a, b);
    EXPECT_EQ(difference.largest, 2);
    EXPECT_TRUE(difference.within(kTolerance)) << difference.inWords(kTolerance);
  }
}

TEST(ImageDifference, SeesASmallThingInALargePicture) {
  // 20x20 pixels off by 3 are fewer than 0.05% of 1280x720, but fill a window.
  const Image a = scenery(1280, 720);
  const ImageDifference difference = measureDifference(a, shifted(a, 700, 400, 20, 20, 3));
  EXPECT_LT(difference.pixelsOff, kTolerance.pixelsOff);
  EXPECT_EQ(difference.worstWindow.value, 1);
  EXPECT_FALSE(difference.within(kTolerance));
  EXPECT_EQ(difference.inWords(kTolerance).find("100% of the pixels off in the window at (700, 400)"), 0u)
      << difference.inWords(kTolerance);
}

TEST(ImageDifference, SeesTextThatMovedByAPixel) {
  // A line of 18 pixels on 1280x720 is out of tolerance if it is one pixel to the right or lower.
  const Image ground = grey(1280, 720, [](int, int) { return 20; });
  const Image a = withText(ground, "vorticity on", 30, 40);
  EXPECT_FALSE(measureDifference(a, withText(ground, "vorticity on", 31, 40)).within(kTolerance));
  EXPECT_FALSE(measureDifference(a, withText(ground, "vorticity on", 30, 41)).within(kTolerance));
  EXPECT_FALSE(measureDifference(a, ground).within(kTolerance));
}

TEST(ImageDifference, TakesPicturesSmallerThanAWindow) {
  // The window is clipped to the picture: a pixel of 5 x 3 that is off is 1 of 15.
  const Image a = scenery(5, 3);
  const ImageDifference difference = measureDifference(a, shifted(a, 2, 1, 1, 1, 9));
  EXPECT_DOUBLE_EQ(difference.pixelsOff, 1.0 / 15);
  EXPECT_FLOAT_EQ(difference.worstWindow.value, 1.0 / 15);
  EXPECT_LT(difference.ssim, 1);
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 40}, {40, 1}, {9, 200}, {16, 16}}) {
    const Image b = scenery(width, height);
    EXPECT_EQ(measureDifference(b, b).ssim, 1) << width << "x" << height;
    const ImageDifference whole = measureDifference(b, shifted(b, 0, 0, width, height, 20));
    EXPECT_EQ(whole.pixelsOff, 1);
    EXPECT_EQ(whole.worstWindow.value, 1);
    EXPECT_EQ(whole.worstShift.value, 0);
    EXPECT_LT(whole.ssim, 1);
  }
}

TEST(ImageDifference, DoesNotLookAtAlpha) {
  // Two pictures that differ in alpha alone are equal.
  const Image a = scenery(32, 32);
  Image b = a;
  for (std::size_t k = 3; k < b.rgba.size(); k += 4) b.rgba[k] = 7;
  EXPECT_TRUE(measureDifference(a, b).equal());
}

TEST(ImageDifference, NeedsOneSize) {
  // Pictures of two sizes are a fault of the caller.
  EXPECT_ANY_THROW(measureDifference(scenery(32, 16), scenery(16, 32)));
  EXPECT_ANY_THROW(differencePicture(scenery(32, 16), scenery(16, 32), {}, false));
}

const std::uint8_t* at(const Image& image, int x, int y) {
  return image.rgba.data() + 4 * (std::size_t(y) * image.width + x);
}

TEST(DifferencePicture, MarksWhatDiffersByHowMuch) {
  // Grey where nothing differs, blue within the level, yellow for a little more, red for much; all opaque.
  const Image a = painted(100, 60, [](int, int) { return Pixel{200, 40, 90}; });
  Image b = shifted(a, 10, 10, 1, 1, 2);
  b = shifted(b, 30, 10, 1, 1, 3);
  b = shifted(b, 50, 10, 1, 1, -200, 0);
  const Image picture = differencePicture(a, b, kTolerance, false);
  const auto *same = at(picture, 0, 0), *faint = at(picture, 10, 10), *small = at(picture, 30, 10),
             *large = at(picture, 50, 10);
  EXPECT_EQ(same[0], same[1]);
  EXPECT_EQ(same[1], same[2]);
  EXPECT_LT(same[0], 80);
  EXPECT_GT(faint[2], faint[0] + 30);
  EXPECT_GT(small[0], 180);
  EXPECT_GT(small[1], 150);
  EXPECT_LT(small[2], 80);
  EXPECT_GT(large[0], 230);
  EXPECT_LT(large[1], 60);
  for (std::size_t k = 3; k < picture.rgba.size(); k += 4) ASSERT_EQ(picture.rgba[k], 255);
}

TEST(DifferencePicture, FramesTheWorstWindowIfItBreaksTheTolerance) {
  // White pixels stand around the window, outside of it, and none if nothing is broken or none is asked for.
  const Image a = grey(100, 60, [](int, int) { return 100; });
  const Image b = shifted(a, 40, 20, 16, 16, 9);
  const auto white = [](const Image& image) {
    int count = 0;
    for (std::size_t k = 0; k < image.rgba.size(); k += 4)
      count += image.rgba[k] == 255 && image.rgba[k + 1] == 255 && image.rgba[k + 2] == 255;
    return count;
  };
  const Image framed = differencePicture(a, b);
  EXPECT_EQ(white(framed), 20 * 20 - 16 * 16);
  EXPECT_EQ(at(framed, 38, 18)[2], 255);
  EXPECT_EQ(at(framed, 57, 37)[2], 255);
  EXPECT_LT(at(framed, 40, 20)[2], 100);
  EXPECT_EQ(white(differencePicture(a, b, kTolerance, false)), 0);
  EXPECT_EQ(white(differencePicture(a, shifted(a, 40, 20, 2, 1, 9))), 0);
  EXPECT_EQ(white(differencePicture(a, shifted(a, 40, 20, 16, 16, 1))), 20 * 20 - 16 * 16);
}

}  // namespace
}  // namespace smokebox
