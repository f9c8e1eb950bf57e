#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "base/errors.h"
#include "image/difference.h"

namespace smokebox {

namespace {

using Rgb = std::array<double, 3>;  // levels of 255

constexpr double kGround = 0.4;       // how bright the picture stays under what differs
constexpr double kFaint = 0.45;       // opacity of what is within the level of the tolerance, at most
constexpr double kLeast = 0.75;       // of what is off by one level more
constexpr Rgb kWithin{90, 140, 255};  // blue
constexpr Rgb kSmall{255, 225, 40};   // yellow: off by little
constexpr Rgb kLarge{255, 30, 10};    // red: off by half the range and more
constexpr double kHalfRange = 128;
constexpr Rgb kFrame{255, 255, 255};
constexpr int kFrameWidth = 2;

struct Paint {
  Rgb color;
  double opacity;
};

/// How a pixel is marked whose channels differ by at most `levels`.
Paint paintOf(int levels, int tolerated) {
  if (levels == 0) return {kWithin, 0};
  if (levels <= tolerated) return {kWithin, kFaint * levels / tolerated};
  // By the logarithm: a step from 3 to 6 levels matters as much as one from 60 to 120.
  const double least = tolerated + 1, most = std::max(kHalfRange, 2 * least);
  const double t = std::min(1.0, std::log(levels / least) / std::log(most / least));
  Rgb color;
  for (int c = 0; c < 3; ++c) color[c] = kSmall[c] + t * (kLarge[c] - kSmall[c]);
  return {color, kLeast + t * (1 - kLeast)};
}

void put(Image& image, int x, int y, const Rgb& color) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  std::uint8_t* const pixel = image.rgba.data() + 4 * (std::size_t(y) * image.width + x);
  for (int c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(std::lround(color[c]));
}

/// A frame around a window, outside of it where the picture goes on there.
void frameWindow(Image& image, const ImageDifference::Window& window) {
  const auto edges = [](int start, int size) {
    const int end = std::min(start + DifferenceTolerance::kWindow, size);
    return std::pair{std::max(start - kFrameWidth, 0), std::min(end + kFrameWidth, size)};
  };
  const auto [left, right] = edges(window.x, image.width);
  const auto [top, bottom] = edges(window.y, image.height);
  for (int k = 0; k < kFrameWidth; ++k) {
    for (int x = left; x < right; ++x) {
      put(image, x, top + k, kFrame);
      put(image, x, bottom - 1 - k, kFrame);
    }
    for (int y = top; y < bottom; ++y) {
      put(image, left + k, y, kFrame);
      put(image, right - 1 - k, y, kFrame);
    }
  }
}

}  // namespace

Image differencePicture(const Image& a, const Image& b, const DifferenceTolerance& tolerance,
                        bool frameWorst) {
  checkInvariant(a.width == b.width && a.height == b.height, "pictures to be compared have one size");
  std::array<Paint, 256> paints;
  for (int levels = 0; levels < 256; ++levels) paints[levels] = paintOf(levels, tolerance.level);
  const ImageDifference difference = frameWorst ? measureDifference(a, b, tolerance) : ImageDifference{};
  Image picture(a.width, a.height);
  for (std::size_t k = 0; k < picture.rgba.size(); k += 4) {
    int levels = 0;
    for (int c = 0; c < 3; ++c) levels = std::max(levels, std::abs(int{b.rgba[k + c]} - int{a.rgba[k + c]}));
    const double grey = kGround * (0.2126 * a.rgba[k] + 0.7152 * a.rgba[k + 1] + 0.0722 * a.rgba[k + 2]);
    const Paint& paint = paints[levels];
    for (int c = 0; c < 3; ++c)
      picture.rgba[k + c] =
          static_cast<std::uint8_t>(std::lround(grey + paint.opacity * (paint.color[c] - grey)));
    picture.rgba[k + 3] = 255;
  }
  if (difference.worstShift.value > tolerance.windowShift) frameWindow(picture, difference.worstShift);
  if (difference.worstWindow.value > tolerance.windowOff) frameWindow(picture, difference.worstWindow);
  return picture;
}

}  // namespace smokebox
