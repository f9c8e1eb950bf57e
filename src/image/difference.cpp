#include "image/difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "base/errors.h"
#include "image/similarity.h"

namespace smokebox {

namespace {

constexpr int kChannels = 3;
constexpr int kLevels = 256;
using Histogram = std::array<long, 2 * kLevels - 1>;  // of b - a

/// b - a, a channel after the other, and which pixels are off.
struct Differences {
  std::array<std::vector<std::int16_t>, kChannels> channels;
  std::vector<std::int16_t> off;  // 1 or 0

  Differences(const Image& a, const Image& b, int level) : off(std::size_t(a.width) * a.height) {
    for (auto& channel : channels) channel.resize(off.size());
    const std::uint8_t *const pa = a.rgba.data(), *const pb = b.rgba.data();
    std::int16_t* const __restrict red = channels[0].data();
    std::int16_t* const __restrict green = channels[1].data();
    std::int16_t* const __restrict blue = channels[2].data();
    std::int16_t* const __restrict isOff = off.data();
    for (std::size_t k = 0; k < off.size(); ++k) {
      const int r = pb[4 * k] - pa[4 * k], g = pb[4 * k + 1] - pa[4 * k + 1],
                u = pb[4 * k + 2] - pa[4 * k + 2];
      red[k] = static_cast<std::int16_t>(r);
      green[k] = static_cast<std::int16_t>(g);
      blue[k] = static_cast<std::int16_t>(u);
      isOff[k] = std::max({std::abs(r), std::abs(g), std::abs(u)}) > level;
    }
  }
};

/// Of values that were rounded to whole levels, each spread evenly over its level: where half of them lie
/// below. Moves smoothly, so that a picture rounded up here and there has no jump of a whole level.
double median(const Histogram& counts) {
  long total = 0, below = 0;
  for (const long count : counts) total += count;
  std::size_t level = 0;
  while (2 * (below + counts[level]) < total) below += counts[level++];
  return static_cast<double>(level) - (kLevels - 1) - 0.5 + (0.5 * total - below) / counts[level];
}

/// Size of the windows in a picture.
struct WindowSize {
  int width, height;
  explicit WindowSize(const Image& image)
      : width(std::min(image.width, DifferenceTolerance::kWindow)),
        height(std::min(image.height, DifferenceTolerance::kWindow)) {}
  int pixels() const { return width * height; }
};

/// Sums of a plane over windows, row of windows by row of windows. Unsigned sums may wrap around: their
/// differences, which are what is asked for, do not.
template <class Value>
class WindowSums {
 public:
  WindowSums(int planeWidth, const WindowSize& window, Value value)
      : value_(value),
        window_(window),
        columns_(planeWidth),
        before_(planeWidth + 1),
        sums_(planeWidth + 1 - window.width) {}

  /// Adds row `y` of the plane. After the last row of a window, sums()[x] is of that window whose left column
  /// is x.
  void addRow(const std::int16_t* plane, int y) {
    const int width = static_cast<int>(columns_.size());
    const std::int16_t* const newest = plane + std::size_t(y) * width;
    std::uint32_t* const __restrict columns = columns_.data();
    for (int x = 0; x < width; ++x) columns[x] += value_(newest[x]);
    if (y >= window_.height) {
      const std::int16_t* const oldest = newest - std::size_t(window_.height) * width;
      for (int x = 0; x < width; ++x) columns[x] -= value_(oldest[x]);
    }
    if (y + 1 < window_.height) return;
    for (int x = 0; x < width; ++x) before_[x + 1] = before_[x] + columns[x];
    const int step = window_.width, count = static_cast<int>(sums_.size());
    for (int x = 0; x < count; ++x) sums_[x] = static_cast<std::int32_t>(before_[x + step] - before_[x]);
  }
  const std::vector<std::int32_t>& sums() const { return sums_; }

 private:
  Value value_;
  WindowSize window_;
  std::vector<std::uint32_t> columns_, before_;
  std::vector<std::int32_t> sums_;
};

constexpr auto kPlain = [](std::int32_t v) { return static_cast<std::uint32_t>(v); };
constexpr auto kSquare = [](std::int32_t v) { return static_cast<std::uint32_t>(v * v); };

/// Keeps the largest value of a row of windows, and the first place where it stands.
void keepWorst(const std::vector<float>& values, int y, ImageDifference::Window& worst) {
  float most = 0;
  for (const float value : values) most = std::max(most, value);
  if (!(most > worst.value)) return;
  const auto at = std::find(values.begin(), values.end(), most);
  worst = {static_cast<int>(at - values.begin()), y, most};
}

ImageDifference::Window worstShare(const Image& image, const std::vector<std::int16_t>& off) {
  const WindowSize window(image);
  WindowSums counts(image.width, window, kPlain);
  std::vector<float> share(counts.sums().size());
  ImageDifference::Window worst;
  for (int y = 0; y < image.height; ++y) {
    counts.addRow(off.data(), y);
    if (y + 1 < window.height) continue;
    for (std::size_t x = 0; x < share.size(); ++x)
      share[x] = static_cast<float>(counts.sums()[x]) / static_cast<float>(window.pixels());
    keepWorst(share, y + 1 - window.height, worst);
  }
  return worst;
}

/// A shift is significant above half the standard deviation of the differences in its window: 8 standard
/// errors of the mean of 256 independent pixels, out of reach of noise in a million windows.
void keepWorstShift(const Image& image, const std::vector<std::int16_t>& channel, double whole,
                    ImageDifference::Window& worst) {
  const WindowSize window(image);
  WindowSums sums(image.width, window, kPlain);
  WindowSums squares(image.width, window, kSquare);
  std::vector<float> shift(sums.sums().size());
  const double share = 1.0 / window.pixels();
  for (int y = 0; y < image.height; ++y) {
    sums.addRow(channel.data(), y);
    squares.addRow(channel.data(), y);
    if (y + 1 < window.height) continue;
    for (std::size_t x = 0; x < shift.size(); ++x) {
      const double mean = sums.sums()[x] * share, variance = squares.sums()[x] * share - mean * mean;
      const double from = mean - whole;
      shift[x] = 4 * from * from > variance ? static_cast<float>(std::fabs(from)) : 0.0f;
    }
    keepWorst(shift, y + 1 - window.height, worst);
  }
}

std::string formatted(const char* form, double value) {
  char text[64];
  std::snprintf(text, sizeof text, form, value);
  return text;
}

std::string percent(double share) { return formatted("%.3g%%", 100 * share); }

std::string placeText(const ImageDifference::Window& window) {
  return "(" + std::to_string(window.x) + ", " + std::to_string(window.y) + ")";
}

struct Part {
  bool broken;
  std::string text;
};

/// What the tolerance is about.
std::vector<Part> toleratedParts(const ImageDifference& difference, const DifferenceTolerance& tolerance) {
  const auto& [pixelsOff, worstWindow, worstShift, largest, psnr, ssim] = difference;
  return {
      {pixelsOff > tolerance.pixelsOff, percent(pixelsOff) + " of the pixels off by more than " +
                                            std::to_string(tolerance.level) + " levels (" +
                                            percent(tolerance.pixelsOff) + " may be)"},
      {worstWindow.value > tolerance.windowOff,
       percent(worstWindow.value) + " of the pixels off in the window at " + placeText(worstWindow) + " (" +
           percent(tolerance.windowOff) + " may be)"},
      {worstShift.value > tolerance.windowShift, "the window at " + placeText(worstShift) + " shifted by " +
                                                     formatted("%.2f levels", worstShift.value) +
                                                     formatted(" (%.2f may be)", tolerance.windowShift)}};
}

std::string joined(const std::vector<Part>& parts) {
  std::string text;
  for (const Part& part : parts) text += (text.empty() ? "" : "; ") + part.text;
  return text;
}

}  // namespace

ImageDifference measureDifference(const Image& a, const Image& b, const DifferenceTolerance& tolerance) {
  checkInvariant(a.width == b.width && a.height == b.height && a.width > 0 && a.height > 0,
                 "pictures to be compared have one size");
  ImageDifference difference;
  const Differences d(a, b, tolerance.level);
  const double pixels = static_cast<double>(d.off.size());
  double squares = 0;
  for (const auto& channel : d.channels) {
    Histogram counts{};
    for (const std::int16_t value : channel) ++counts[value + kLevels - 1];
    for (int k = 0; k < static_cast<int>(counts.size()); ++k) {
      const int level = std::abs(k - (kLevels - 1));
      if (counts[k]) difference.largest = std::max(difference.largest, level);
      squares += static_cast<double>(counts[k]) * level * level;
    }
    keepWorstShift(a, channel, median(counts), difference.worstShift);
  }
  long off = 0;
  for (const std::int16_t value : d.off) off += value;
  difference.pixelsOff = off / pixels;
  difference.worstWindow = worstShare(a, d.off);
  const double mean = squares / (kChannels * pixels);
  difference.psnr =
      mean > 0 ? 10 * std::log10(255.0 * 255.0 / mean) : std::numeric_limits<double>::infinity();
  difference.ssim = structuralSimilarity(a, b);
  return difference;
}

bool ImageDifference::within(const DifferenceTolerance& tolerance) const {
  return pixelsOff <= tolerance.pixelsOff && worstWindow.value <= tolerance.windowOff &&
         worstShift.value <= tolerance.windowShift;
}

std::string ImageDifference::inWords(const DifferenceTolerance& tolerance) const {
  if (equal()) return "the pictures are equal";
  std::vector<Part> parts = toleratedParts(*this, tolerance);
  std::stable_partition(parts.begin(), parts.end(), [](const Part& part) { return part.broken; });
  return joined(parts) + "; largest difference " + std::to_string(largest) +
         formatted(", PSNR %.2f dB", psnr) + formatted(", SSIM %.5f", ssim);
}

std::string ImageDifference::whatBreaks(const DifferenceTolerance& tolerance) const {
  std::vector<Part> parts = toleratedParts(*this, tolerance);
  std::erase_if(parts, [](const Part& part) { return !part.broken; });
  return joined(parts);
}

}  // namespace smokebox
