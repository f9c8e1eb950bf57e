#include "fluid/semi_lagrangian.h"

#include <algorithm>
#include <cmath>

#include "fluid/paths_beside_solids.h"

namespace smokebox {

namespace {

constexpr int kRowGrain = 8;
constexpr int kTile = 32;  // faces of a row that are worked on together
constexpr int kRun = 16;   // of these, those that are looked at for places side by side
constexpr int kBlock = 4;  // cells along a side of the blocks that are looked through for solids

// The 4 samples of a row that an interpolation reads, or their weights.
typedef float Quad __attribute__((vector_size(16), aligned(4), may_alias));

typedef float Pair __attribute__((vector_size(8), aligned(4), may_alias));

inline Pair pairAt(const float* p) { return *reinterpret_cast<const Pair*>(p); }
inline Quad quadAt(const float* p) { return *reinterpret_cast<const Quad*>(p); }

/// Catmull-Rom: b (-a b/2), b (1 + a - 3/2 a^2) with b = 1 - a, and those with a and b exchanged, so that 1 -
/// a has the same weights the other way round.
inline Quad weights(float a) {
  constexpr Quad c0 = {0, 1, 1, 0}, c1 = {-0.5f, 1, 1, -0.5f}, c2 = {0.5f, -1.5f, -1.5f, 0.5f};
  const float b = 1 - a;
  const Quad outer = {b, b, a, a}, inner = {a, a, b, b};
  return outer * (c0 + inner * (c1 + inner * c2));
}

inline Quad smaller(const Quad& a, const Quad& b) { return a < b ? a : b; }
inline Quad larger(const Quad& a, const Quad& b) { return a > b ? a : b; }

/// Between the 16 samples around p + (a, b), 0 <= a, b < 1, and within the range of the nearest four; on a
/// line of samples within that of the nearest two.
inline float limitedCubic(const float* p, std::ptrdiff_t stride, float a, float b) {
  const Quad wx = weights(a), wy = weights(b);
  const Quad r0 = quadAt(p - stride - 1), r1 = quadAt(p - 1), r2 = quadAt(p + stride - 1),
             r3 = quadAt(p + 2 * stride - 1);
  const Quad product = wx * ((wy[1] * r1 + wy[2] * r2) + (wy[0] * r0 + wy[3] * r3));
  const float sum = (product[1] + product[2]) + (product[0] + product[3]);
  const Quad second = b > 0 ? r2 : r1, low = smaller(r1, second), high = larger(r1, second);
  const int right = a > 0 ? 2 : 1;
  return std::min(std::max(sum, std::min(low[1], low[right])), std::max(high[1], high[right]));
}

struct Sample {
  float below, share;  // the sample below a place, and how far the place is beyond it
};

/// A place `offset` from sample `from`, whose own place is `shift` past the domain's begin: kept inside the
/// `size` cells, or wrapped. What is not a number goes to a side.
template <bool Periodic>
inline Sample sampleAt(float size, float from, float shift, float offset) {
  const float lowest = Periodic ? -size : -(from + shift), highest = Periodic ? size : size - (from + shift);
  offset = offset > lowest ? offset : lowest;
  offset = offset < highest ? offset : highest;
  const float whole = std::floor(offset);
  float sample = from + whole;
  if (Periodic) {
    sample += sample < 0 ? size : 0.0f;
    sample -= sample < size ? 0.0f : size;
  }
  return {sample, offset - whole};
}

/// Whether places are side by side, as they are where the flow hardly changes: then their samples are, too.
inline bool sideBySide(const int* at) {
  int apart = 0;
#pragma omp simd reduction(| : apart)
  for (int k = 0; k < kRun; ++k) apart |= at[k] - at[0] - k;
  return apart == 0;
}

/// The feet of the paths that lead to some faces of a row, as samples of the same component.
struct Feet {
  alignas(64) int at[kTile];                       // the sample below and to the left
  alignas(64) float shareX[kTile], shareY[kTile];  // how far beyond it
  // How far the paths lead to either side, cells: each of them, and all.
  alignas(64) float left[kTile], right[kTile], down[kTile], up[kTile];
  float mostLeft = 0, mostRight = 0, mostDown = 0, mostUp = 0;
};

/// Paths far from solids, many at a time.
class OpenPaths {
 public:
  OpenPaths(const Boundary& boundary, const Field& u, const Field& v, double dt)
      : u_(u), v_(v), boundary_(boundary), scale_(static_cast<float>(dt / boundary.grid.h)) {}

  void feetOfU(int begin, int count, int j, Feet& feet) const {
    const float *below = v_.row(j) + begin, *above = v_.row(j + 1) + begin, *along = u_.row(j) + begin;
    alignas(64) float across[kTile];
#pragma omp simd
    for (int k = 0; k < count; ++k)
      across[k] = 0.25f * ((below[k - 1] + below[k]) + (above[k - 1] + above[k]));
    findFeet(begin, count, j, 0.0f, 0.5f, along, across, feet);
  }
  void feetOfV(int begin, int count, int j, Feet& feet) const {
    const float *below = u_.row(j - 1) + begin, *above = u_.row(j) + begin, *along = v_.row(j) + begin;
    alignas(64) float across[kTile];
#pragma omp simd
    for (int k = 0; k < count; ++k)
      across[k] = 0.25f * ((below[k] + below[k + 1]) + (above[k] + above[k + 1]));
    findFeet(begin, count, j, 0.5f, 0.0f, across, along, feet);
  }

 private:
  /// Where samples are to be read: the first of four, and the shares of the others along x and y.
  struct Places {
    alignas(64) int at[kTile];
    alignas(64) float a[kTile], b[kTile];
  };
  static void place(Places& places, int k, int stride, const Sample& x, const Sample& y) {
    places.at[k] = static_cast<int>(y.below) * stride + static_cast<int>(x.below);
    places.a[k] = x.share;
    places.b[k] = y.share;
  }
  /// Where places are not side by side samples are fetched one by one, two at a time (to gather in vectors
  /// takes twice as long), and worked on together.
  static void bilinear(const Field& f, const Places& places, int count, float* __restrict out) {
    const float* samples = f.row(0);
    const std::ptrdiff_t stride = f.stride();
    for (int begin = 0; begin < count; begin += kRun) {
      const int* at = places.at + begin;
      const float *shareX = places.a + begin, *shareY = places.b + begin;
      float* to = out + begin;
      if (count - begin >= kRun && sideBySide(at)) {
        const float *p = samples + at[0], *q = p + stride;
#pragma omp simd
        for (int k = 0; k < kRun; ++k) {
          const float a = shareX[k], b = shareY[k];
          to[k] = (1 - b) * ((1 - a) * p[k] + a * p[k + 1]) + b * ((1 - a) * q[k] + a * q[k + 1]);
        }
        continue;
      }
      const int here = std::min(kRun, count - begin);
      alignas(64) Pair lower[kRun], upper[kRun];
      for (int k = 0; k < here; ++k) {
        const float* p = samples + at[k];
        lower[k] = pairAt(p);
        upper[k] = pairAt(p + stride);
      }
      const float *p = &lower[0][0], *q = &upper[0][0];
#pragma omp simd
      for (int k = 0; k < here; ++k) {
        const float a = shareX[k], b = shareY[k];
        to[k] =
            (1 - b) * ((1 - a) * p[2 * k] + a * p[2 * k + 1]) + b * ((1 - a) * q[2 * k] + a * q[2 * k + 1]);
      }
    }
  }

  /// (shiftX, shiftY): of the faces from the grid's nodes; vx, vy: velocity at the faces.
  void findFeet(int begin, int count, int j, float shiftX, float shiftY, const float* vx, const float* vy,
                Feet& feet) const {
    const bool px = boundary_.periodicX(), py = boundary_.periodicY();
    const auto find = px && py ? &OpenPaths::find<true, true>
                      : px     ? &OpenPaths::find<true, false>
                      : py     ? &OpenPaths::find<false, true>
                               : &OpenPaths::find<false, false>;
    (this->*find)(begin, count, j, shiftX, shiftY, vx, vy, feet);
  }

  template <bool PeriodicX, bool PeriodicY>
  void find(int begin, int count, int j, float shiftX, float shiftY, const float* vx, const float* vy,
            Feet& feet) const {
    const int stride = static_cast<int>(u_.stride());
    const float half = -0.5f * scale_, whole = -scale_;
    const auto row = static_cast<float>(j), sizeX = static_cast<float>(boundary_.grid.nx),
               sizeY = static_cast<float>(boundary_.grid.ny);
    Places inU, inV;
#pragma omp simd
    for (int k = 0; k < count; ++k) {
      const auto column = static_cast<float>(begin + k);
      const float dx = inWholeParts(half * vx[k]), dy = inWholeParts(half * vy[k]);
      // The samples of u are (0, 1/2) from the nodes, those of v (1/2, 0).
      place(inU, k, stride, sampleAt<PeriodicX>(sizeX, column, 0.0f, dx + shiftX),
            sampleAt<PeriodicY>(sizeY, row, 0.5f, dy + (shiftY - 0.5f)));
      place(inV, k, stride, sampleAt<PeriodicX>(sizeX, column, 0.5f, dx + (shiftX - 0.5f)),
            sampleAt<PeriodicY>(sizeY, row, 0.0f, dy + shiftY));
      feet.left[k] = dx < 0 ? -dx : 0.0f, feet.right[k] = dx > 0 ? dx : 0.0f;
      feet.down[k] = dy < 0 ? -dy : 0.0f, feet.up[k] = dy > 0 ? dy : 0.0f;
    }
    alignas(64) float ux[kTile], uy[kTile];
    bilinear(u_, inU, count, ux);
    bilinear(v_, inV, count, uy);
    float left = 0, right = 0, down = 0, up = 0;
    const auto larger = [](float a, float b) { return a > b ? a : b; };
#pragma omp simd reduction(max : left, right, down, up)
    for (int k = 0; k < count; ++k) {
      const auto column = static_cast<float>(begin + k);
      const float dx = inWholeParts(whole * ux[k]), dy = inWholeParts(whole * uy[k]);
      const Sample x = sampleAt<PeriodicX>(sizeX, column, shiftX, dx),
                   y = sampleAt<PeriodicY>(sizeY, row, shiftY, dy);
      feet.at[k] = static_cast<int>(y.below) * stride + static_cast<int>(x.below);
      feet.shareX[k] = x.share;
      feet.shareY[k] = y.share;
      feet.left[k] = larger(-dx, feet.left[k]), feet.right[k] = larger(dx, feet.right[k]);
      feet.down[k] = larger(-dy, feet.down[k]), feet.up[k] = larger(dy, feet.up[k]);
      left = larger(feet.left[k], left), right = larger(feet.right[k], right);
      down = larger(feet.down[k], down), up = larger(feet.up[k], up);
    }
    feet.mostLeft = left, feet.mostRight = right;
    feet.mostDown = down, feet.mostUp = up;
  }

  const Field &u_, &v_;
  const Boundary& boundary_;
  const float scale_;  // cells per m/s
};

/// The weights of some places, kRun at most; see weights().
struct Weights {
  alignas(64) float w[4][kRun];
  Weights(const float* share, int count) {
#pragma omp simd
    for (int k = 0; k < count; ++k) {
      const float a = share[k], b = 1 - a;
      w[0][k] = b * (0 + a * (-0.5f + a * 0.5f));
      w[1][k] = b * (1 + a * (1 + a * -1.5f));
      w[2][k] = a * (1 + b * (1 + b * -1.5f));
      w[3][k] = a * (0 + b * (-0.5f + b * 0.5f));
    }
  }
};

/// limitedCubic() at places side by side, where faces are open; p: the sample below and to the left of the
/// first.
void takeSideBySide(const float* __restrict p, std::ptrdiff_t stride, const float* shareX,
                    const float* shareY, const float* open, float* __restrict out) {
  const Weights x(shareX, kRun), y(shareY, kRun);
#pragma omp simd
  for (int k = 0; k < kRun; ++k) {
    const float *r0 = p + k - stride, *r1 = p + k, *r2 = p + k + stride, *r3 = p + k + 2 * stride;
    const float w0 = y.w[0][k], w1 = y.w[1][k], w2 = y.w[2][k], w3 = y.w[3][k];
    const float before = (w1 * r1[-1] + w2 * r2[-1]) + (w0 * r0[-1] + w3 * r3[-1]);
    const float left = (w1 * r1[0] + w2 * r2[0]) + (w0 * r0[0] + w3 * r3[0]);
    const float right = (w1 * r1[1] + w2 * r2[1]) + (w0 * r0[1] + w3 * r3[1]);
    const float after = (w1 * r1[2] + w2 * r2[2]) + (w0 * r0[2] + w3 * r3[2]);
    const float sum = (x.w[1][k] * left + x.w[2][k] * right) + (x.w[0][k] * before + x.w[3][k] * after);
    const bool between = shareX[k] > 0, above = shareY[k] > 0;
    const float a1 = r1[0], a2 = above ? r2[0] : a1, b1 = r1[1], b2 = above ? r2[1] : b1;
    const float least1 = a1 < a2 ? a1 : a2, most1 = a1 > a2 ? a1 : a2;
    const float least2 = between ? (b1 < b2 ? b1 : b2) : least1,
                most2 = between ? (b1 > b2 ? b1 : b2) : most1;
    const float lowest = least2 < least1 ? least2 : least1, highest = most1 < most2 ? most2 : most1;
    const float raised = sum < lowest ? lowest : sum, value = highest < raised ? highest : raised;
    out[k] = open[k] > 0 ? value : out[k];
  }
}

/// The same at `count` places anywhere: along y one by one, the rest together.
void takeApart(const float* samples, std::ptrdiff_t stride, const int* at, const float* shareX,
               const float* shareY, const float* open, int count, float* __restrict out) {
  const Weights x(shareX, count), y(shareY, count);
  alignas(64) Quad along[kRun], low[kRun], high[kRun];
  for (int k = 0; k < count; ++k) {
    const float* p = samples + at[k] - 1;
    const Quad r0 = quadAt(p - stride), r1 = quadAt(p), r2 = quadAt(p + stride), r3 = quadAt(p + 2 * stride);
    const Quad second = quadAt(shareY[k] > 0 ? p + stride : p);
    along[k] = (y.w[1][k] * r1 + y.w[2][k] * r2) + (y.w[0][k] * r0 + y.w[3][k] * r3);
    low[k] = smaller(r1, second);
    high[k] = larger(r1, second);
  }
  const float *q = &along[0][0], *least = &low[0][0], *most = &high[0][0];
#pragma omp simd
  for (int k = 0; k < count; ++k) {
    const float sum = (x.w[1][k] * q[4 * k + 1] + x.w[2][k] * q[4 * k + 2]) +
                      (x.w[0][k] * q[4 * k] + x.w[3][k] * q[4 * k + 3]);
    const bool between = shareX[k] > 0;
    const float least1 = least[4 * k + 1], least2 = between ? least[4 * k + 2] : least1;
    const float most1 = most[4 * k + 1], most2 = between ? most[4 * k + 2] : most1;
    const float lowest = least2 < least1 ? least2 : least1, highest = most1 < most2 ? most2 : most1;
    const float raised = sum < lowest ? lowest : sum, value = highest < raised ? highest : raised;
    out[k] = open[k] > 0 ? value : out[k];
  }
}

void takeAtFeet(const Field& f, const Feet& feet, const float* open, int count, float* out) {
  for (int k = 0; k < count; k += kRun) {
    if (count - k >= kRun && sideBySide(feet.at + k))
      takeSideBySide(f.row(0) + feet.at[k], f.stride(), feet.shareX + k, feet.shareY + k, open + k, out + k);
    else
      takeApart(f.row(0), f.stride(), feet.at + k, feet.shareX + k, feet.shareY + k, open + k,
                std::min(kRun, count - k), out + k);
  }
}

float takeAt(const Field& f, double x, double y) {
  const double fx = std::floor(x), fy = std::floor(y);
  return limitedCubic(f.row(static_cast<int>(fy)) + static_cast<int>(fx), f.stride(),
                      static_cast<float>(x - fx), static_cast<float>(y - fy));
}

}  // namespace

void SemiLagrangian::findShutBlocks(const Boundary& boundary) {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  blocksX_ = (nx + kBlock - 1) / kBlock;
  blocksY_ = (ny + kBlock - 1) / kBlock;
  const int row = blocksX_ + 1;
  shutBlocks_.assign(static_cast<std::size_t>(row) * (blocksY_ + 1), 0);
  pool_.blocks(0, blocksY_, 1, [&](int begin, int end) {
    for (int b = begin; b < end; ++b)
      for (int j = b * kBlock; j < std::min(ny, (b + 1) * kBlock); ++j) {
        const float *openX = boundary.openX.row(j), *openY = boundary.openY.row(j);
        for (int a = 0; a < blocksX_; ++a) {
          int shut = 0;
          for (int i = a * kBlock; i < std::min(nx, (a + 1) * kBlock); ++i)
            shut |= (i > 0 && !(openX[i] > 0)) | (j > 0 && !(openY[i] > 0));
          shutBlocks_[static_cast<std::size_t>(b + 1) * row + a + 1] |= shut;
        }
      }
  });
  for (int b = 1; b <= blocksY_; ++b)
    for (int a = 1; a <= blocksX_; ++a) {
      int* at = &shutBlocks_[static_cast<std::size_t>(b) * row + a];
      *at += at[-1] + at[-row] - at[-row - 1];
    }
}

bool SemiLagrangian::anyShut(int i0, int i1, int j0, int j1) const {
  // A block's faces are those on its left and its lower sides: one more on the others.
  const int row = blocksX_ + 1;
  const int a0 = std::clamp(i0 / kBlock, 0, blocksX_), a1 = std::clamp(i1 / kBlock + 1, 0, blocksX_);
  const int b0 = std::clamp(j0 / kBlock, 0, blocksY_), b1 = std::clamp(j1 / kBlock + 1, 0, blocksY_);
  const int* table = shutBlocks_.data();
  return table[b1 * row + a1] - table[b0 * row + a1] - table[b1 * row + a0] + table[b0 * row + a0] > 0;
}

void SemiLagrangian::carry(const Boundary& boundary, const Field& u, const Field& v, double dt, bool anySolid,
                           Field& outU, Field& outV, const std::function<void(int begin, int end)>& after) {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  const int columns = boundary.periodicX() ? nx : nx + 1, rows = boundary.periodicY() ? ny : ny + 1;
  if (anySolid && shutBlocks_.empty()) findShutBlocks(boundary);
  // Whether a solid is where paths from columns [i0, i1) of row j may have been. What is not a number counts
  // as far.
  auto nearSolid = [&](int i0, int i1, int j, float left, float right, float down, float up) {
    const auto cells = [](float reach) { return reach < 1e6f ? static_cast<int>(reach) + 2 : 1000000; };
    i0 -= cells(left), i1 += cells(right);
    int j0 = j - cells(down), j1 = j + cells(up);
    // On a periodic grid a path may come in on the other side: then all of the grid is within reach.
    if (boundary.periodicX() && (i0 < 0 || i1 > nx)) i0 = 0, i1 = nx;
    if (boundary.periodicY() && (j0 < 0 || j1 > ny)) j0 = 0, j1 = ny;
    return anyShut(i0, i1, j0, j1);
  };
  // Calls careful(i) for the faces [begin, begin + count) of row j that a solid may be in the way of.
  auto besideSolids = [&](int begin, int count, int j, const Feet& f, auto&& careful) {
    if (!anySolid || !nearSolid(begin, begin + count, j, f.mostLeft, f.mostRight, f.mostDown, f.mostUp))
      return;
    for (int k = 0; k < count; ++k)
      if (nearSolid(begin + k, begin + k + 1, j, f.left[k], f.right[k], f.down[k], f.up[k]))
        careful(begin + k);
  };
  const OpenPaths open(boundary, u, v, dt);
  const PathsBesideSolids careful(boundary, u, v, dt);
  pool_.blocks(0, rows, kRowGrain, [&](int begin, int end) {
    Feet feet;
    for (int j = begin; j < end; ++j) {
      for (int x0 = 0; j < ny && x0 < columns; x0 += kTile) {
        const int count = std::min(kTile, columns - x0);
        open.feetOfU(x0, count, j, feet);
        takeAtFeet(u, feet, boundary.openX.row(j) + x0, count, outU.row(j) + x0);
        besideSolids(x0, count, j, feet, [&](int i) {
          if (!(boundary.openX(i, j) > 0)) return;
          const auto foot = careful.footOfU(i, j);
          outU(i, j) = takeAt(u, foot.x, foot.y - 0.5);
        });
      }
      for (int x0 = 0; x0 < nx; x0 += kTile) {
        const int count = std::min(kTile, nx - x0);
        open.feetOfV(x0, count, j, feet);
        takeAtFeet(v, feet, boundary.openY.row(j) + x0, count, outV.row(j) + x0);
        besideSolids(x0, count, j, feet, [&](int i) {
          if (!(boundary.openY(i, j) > 0)) return;
          const auto foot = careful.footOfV(i, j);
          outV(i, j) = takeAt(v, foot.x - 0.5, foot.y);
        });
      }
    }
    after(begin, end);
  });
}

}  // namespace smokebox
