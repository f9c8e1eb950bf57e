#include "video/yuv.h"

#include <cstdint>

#include "base/errors.h"

namespace smokebox {

namespace {

constexpr int kShift = 16;
constexpr double kRed = 0.2126, kBlue = 0.0722, kGreen = 1 - kRed - kBlue;
constexpr double kLuma = 219.0 / 255 * (1 << kShift), kChroma = 224.0 / 255 * (1 << kShift);

constexpr int rounded(double x) { return static_cast<int>(x < 0 ? x - 0.5 : x + 0.5); }

struct Weights {
  int red, green, blue;
};
constexpr Weights kY{rounded(kLuma * kRed), rounded(kLuma* kGreen), rounded(kLuma* kBlue)};
// Greens are what is left, so that a grey has no colour.
constexpr int kCbRed = rounded(-kChroma * kRed / (2 * (1 - kBlue))),
              kCrBlue = rounded(-kChroma * kBlue / (2 * (1 - kRed)));
constexpr Weights kCb{kCbRed, -kCbRed - rounded(kChroma / 2), rounded(kChroma / 2)};
constexpr Weights kCr{rounded(kChroma / 2), -kCrBlue - rounded(kChroma / 2), kCrBlue};

void lumaRow(const std::uint32_t* __restrict pixels, int width, std::uint8_t* __restrict y) {
  constexpr int kBias = (16 << kShift) + (1 << (kShift - 1));
  for (int x = 0; x < width; ++x) {
    const int red = pixels[x] & 255, green = pixels[x] >> 8 & 255, blue = pixels[x] >> 16 & 255;
    y[x] = static_cast<std::uint8_t>((kY.red * red + kY.green * green + kY.blue * blue + kBias) >> kShift);
  }
}

void sumRows(const std::uint32_t* __restrict a, const std::uint32_t* __restrict b, int width,
             int* __restrict red, int* __restrict green, int* __restrict blue) {
  for (int x = 0; x < width; ++x) {
    red[x] = static_cast<int>((a[x] & 255) + (b[x] & 255));
    green[x] = static_cast<int>((a[x] >> 8 & 255) + (b[x] >> 8 & 255));
    blue[x] = static_cast<int>((a[x] >> 16 & 255) + (b[x] >> 16 & 255));
  }
}

}  // namespace

YuvConverter::YuvConverter(int width, int height)
    : width_(width), height_(height), red_(width + 2), green_(width + 2), blue_(width + 2) {}

void YuvConverter::convert(const Image& image, AVFrame& frame) {
  checkInvariant(
      image.width == width_ && image.height == height_ && frame.width == width_ && frame.height == height_,
      "every frame of a film has its size");
  const auto* pixels = reinterpret_cast<const std::uint32_t*>(image.rgba.data());  // R is the lowest byte
  auto plane = [&](int which, int row) {
    return frame.data[which] + std::ptrdiff_t{row} * frame.linesize[which];
  };
  for (int j = 0; j < height_; j += 2) {
    const std::uint32_t* const upper = pixels + std::size_t(j) * width_;
    const std::uint32_t* const lower = j + 1 < height_ ? upper + width_ : upper;
    lumaRow(upper, width_, plane(0, j));
    if (lower != upper) lumaRow(lower, width_, plane(0, j + 1));
    int *const red = red_.data() + 1, *const green = green_.data() + 1, *const blue = blue_.data() + 1;
    sumRows(upper, lower, width_, red, green, blue);
    for (int* sums : {red, green, blue}) {
      sums[-1] = sums[0];
      sums[width_] = sums[width_ - 1];
    }
    std::uint8_t* __restrict const cb = plane(1, j / 2), * __restrict const cr = plane(2, j / 2);
    constexpr int kChromaShift = kShift + 3;  // eight pixels count
    constexpr int kBias = (128 << kChromaShift) + (1 << (kChromaShift - 1));
    for (int i = 0; i < (width_ + 1) / 2; ++i) {
      const int r = red[2 * i - 1] + 2 * red[2 * i] + red[2 * i + 1];
      const int g = green[2 * i - 1] + 2 * green[2 * i] + green[2 * i + 1];
      const int b = blue[2 * i - 1] + 2 * blue[2 * i] + blue[2 * i + 1];
      cb[i] = static_cast<std::uint8_t>((kCb.red * r + kCb.green * g + kCb.blue * b + kBias) >> kChromaShift);
      cr[i] = static_cast<std::uint8_t>((kCr.red * r + kCr.green * g + kCr.blue * b + kBias) >> kChromaShift);
    }
  }
}

}  // namespace smokebox
