#include "image/similarity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/errors.h"

namespace smokebox {

namespace {

constexpr int kRadius = 5;
constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 255 * 0.01 * 255, kC2 = 0.03 * 255 * 0.03 * 255;

/// Weights of a window of at most 11 pixels that fits into `size`; they sum to 1.
std::vector<double> gaussian(int size) {
  const int radius = std::min(kRadius, (size - 1) / 2);
  std::vector<double> weights;
  double sum = 0;
  for (int k = -radius; k <= radius; ++k) {
    weights.push_back(std::exp(-k * k / (2 * kSigma * kSigma)));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

void lumaRow(const std::uint8_t* rgba, int width, double* __restrict luma) {
  for (int x = 0; x < width; ++x)
    luma[x] = 0.2126 * rgba[4 * x] + 0.7152 * rgba[4 * x + 1] + 0.0722 * rgba[4 * x + 2];
}

/// out[x] = sum over k of weights[k] in[x + k].
void blurAlong(const std::vector<double>& weights, const double* in, int count, double* __restrict out) {
  std::fill(out, out + count, 0.0);
  for (std::size_t k = 0; k < weights.size(); ++k)
    for (int x = 0; x < count; ++x) out[x] += weights[k] * in[x + k];
}

/// What the similarity is made of, each averaged over the window: a, b, a^2 + b^2, a b.
constexpr int kMoments = 4;

/// The last rows of the moments, averaged along the rows.
class MomentRows {
 public:
  MomentRows(int width, std::vector<double> across, int rows)
      : width_(width), count_(width + 1 - static_cast<int>(across.size())), across_(std::move(across)) {
    for (auto& row : plain_) row.resize(width);
    for (auto& ring : rings_) ring.assign(rows, std::vector<double>(count_));
  }
  int count() const { return count_; }
  void put(int y, const std::uint8_t* a, const std::uint8_t* b) {
    double *const la = plain_[0].data(), *const lb = plain_[1].data();
    lumaRow(a, width_, la);
    lumaRow(b, width_, lb);
    double* const __restrict squares = plain_[2].data(), * const __restrict products = plain_[3].data();
    for (int x = 0; x < width_; ++x) {
      squares[x] = la[x] * la[x] + lb[x] * lb[x];
      products[x] = la[x] * lb[x];
    }
    for (int m = 0; m < kMoments; ++m)
      blurAlong(across_, plain_[m].data(), count_, rings_[m][y % rings_[m].size()].data());
  }
  const double* row(int moment, int y) const { return rings_[moment][y % rings_[moment].size()].data(); }

 private:
  int width_, count_;
  std::vector<double> across_;
  std::array<std::vector<double>, kMoments> plain_;
  std::array<std::vector<std::vector<double>>, kMoments> rings_;
};

}  // namespace

double structuralSimilarity(const Image& a, const Image& b) {
  checkInvariant(a.width == b.width && a.height == b.height && a.width > 0 && a.height > 0,
                 "pictures to be compared have one size");
  const std::vector<double> down = gaussian(a.height);
  const int rows = static_cast<int>(down.size());
  MomentRows moments(a.width, gaussian(a.width), rows);
  const int count = moments.count();
  std::array<std::vector<double>, kMoments> mean;
  for (auto& row : mean) row.resize(count);
  std::vector<double> similarity(count);
  double sum = 0;
  for (int y = 0; y < a.height; ++y) {
    const std::size_t start = std::size_t{4} * y * a.width;
    moments.put(y, a.rgba.data() + start, b.rgba.data() + start);
    if (y + 1 < rows) continue;
    for (int m = 0; m < kMoments; ++m) {
      double* const __restrict out = mean[m].data();
      std::fill(out, out + count, 0.0);
      for (int k = 0; k < rows; ++k) {
        const double* const in = moments.row(m, y + 1 - rows + k);
        const double weight = down[k];
        for (int x = 0; x < count; ++x) out[x] += weight * in[x];
      }
    }
    for (int x = 0; x < count; ++x) {
      const double product = mean[0][x] * mean[1][x];
      const double squares = mean[0][x] * mean[0][x] + mean[1][x] * mean[1][x];
      similarity[x] = (2 * product + kC1) * (2 * (mean[3][x] - product) + kC2) /
                      ((squares + kC1) * (mean[2][x] - squares + kC2));
    }
    for (const double s : similarity) sum += s;
  }
  return sum / (double(count) * (a.height + 1 - rows));
}

}  // namespace smokebox
