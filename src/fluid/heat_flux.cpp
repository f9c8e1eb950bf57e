#include "fluid/heat_flux.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

namespace {

constexpr float kWideEnough = 0.5f;  // share of a face beside which third order may look past it

/// Through the face between p[0] and p[step].
inline float fifthOrder(float c, const float* p, std::ptrdiff_t step) {
  const float a = p[0], b = p[step], m1 = p[-step], p1 = p[2 * step], m2 = p[-2 * step], p2 = p[3 * step];
  const float even = (37 * (a + b) - 8 * (m1 + p1)) + (m2 + p2);
  const float odd = ((p2 - m2) - 5 * (p1 - m1)) + 10 * (b - a);
  return (1.0f / 60) * (c * even - std::fabs(c) * odd);
}
inline float thirdOrder(float c, const float* p, std::ptrdiff_t step) {
  const float a = p[0], b = p[step], m1 = p[-step], p1 = p[2 * step];
  const float even = 7 * (a + b) - (m1 + p1), odd = 3 * (b - a) - (p1 - m1);
  return (1.0f / 12) * (c * even - std::fabs(c) * odd);
}

/// Shares of the faces of one line, also beyond its ends: mirrored at an insulated side; past a side that
/// gives a value there is one cell more.
struct Line {
  const float* open;
  std::ptrdiff_t step;
  int count;  // cells
  bool wraps, lowGives, highGives;

  float operator()(int k) const {
    if (wraps) return open[(k + count) % count * step];
    if (k == 0 || k == count) return 1;
    if (k < 0) return lowGives ? 0.0f : open[-k * step];
    if (k > count) return highGives ? 0.0f : open[(2 * count - k) * step];
    return open[k * step];
  }
};

}  // namespace

HeatFlux::HeatFlux(const Boundary& boundary)
    : nx_(boundary.grid.nx),
      ny_(boundary.grid.ny),
      wrapX_(boundary.periodicX()),
      wrapY_(boundary.periodicY()) {
  lowX_.begin.assign(ny_ + 1, 0);
  lowY_.begin.assign(ny_ + 2, 0);
  least_.assign(ny_ + 1, 1);
  // Room for a few solids: a scene that moves them does not allocate in a step until they are many.
  for (List* list : {&lowX_, &lowY_}) list->faces.reserve(static_cast<std::size_t>(16) * (nx_ + ny_));
}

void HeatFlux::rebuild(const Boundary& boundary, const HeatSides& sides) {
  auto gives = [&](int side) {
    const WallKind kind = boundary.sides[side].kind;
    return sides.keeps[side] || kind == WallKind::inflow || kind == WallKind::open;
  };
  auto orderAt = [](const Line& open, int k) {
    if (!open.wraps && (k == 0 || k == open.count)) return donor;
    // Past a ghost that stands for a given value nothing is smooth.
    const bool nextToGiven =
        !open.wraps && ((k == 1 && open.lowGives) || (k == open.count - 1 && open.highGives));
    if (!nextToGiven && open(k - 2) >= 1 && open(k - 1) >= 1 && open(k) >= 1 && open(k + 1) >= 1 &&
        open(k + 2) >= 1)
      return fifth;
    return std::min({open(k - 1), open(k), open(k + 1)}) >= kWideEnough ? third : donor;
  };
  auto leastOf = [&](const Field& open, int j, int count) {
    const float* o = open.row(j);
    float least = 1;
#pragma omp simd reduction(min : least)
    for (int i = 0; i < count; ++i) least = std::min(least, o[i]);
    return least;
  };

  lowX_.faces.clear();
  lowY_.faces.clear();
  for (int j = 0; j < ny_; ++j) {
    lowX_.begin[j] = static_cast<int>(lowX_.faces.size());
    const Line line{boundary.openX.row(j), 1, nx_, wrapX_, gives(0), gives(1)};
    float least = 1;
    const float* o = boundary.openX.row(j);
#pragma omp simd reduction(min : least)
    for (int i = 1; i < nx_; ++i) least = std::min(least, o[i]);
    const bool allOpen = least >= 1 && (!wrapX_ || o[0] >= 1);
    for (int i = 0; i <= nx_; ++i) {
      if (allOpen && i == 3) i = std::max(i, nx_ - 2);  // only the ends can be low
      if (const Order order = orderAt(line, i); order != fifth) lowX_.faces.push_back({i, order});
    }
  }
  lowX_.begin[ny_] = static_cast<int>(lowX_.faces.size());

  for (int j = 0; j <= ny_; ++j) least_[j] = leastOf(boundary.openY, wrapY_ && j == ny_ ? 0 : j, nx_);
  const std::ptrdiff_t stride = boundary.openY.stride();
  for (int j = 0; j <= ny_; ++j) {
    lowY_.begin[j] = static_cast<int>(lowY_.faces.size());
    bool allOpen = j > 2 && j < ny_ - 2;
    for (int k = -2; k <= 2 && allOpen; ++k) allOpen = least_[j + k] >= 1;
    if (allOpen) continue;
    for (int i = 0; i < nx_; ++i) {
      const Line line{boundary.openY.row(0) + i, stride, ny_, wrapY_, gives(2), gives(3)};
      if (const Order order = orderAt(line, j); order != fifth) lowY_.faces.push_back({i, order});
    }
  }
  lowY_.begin[ny_ + 1] = static_cast<int>(lowY_.faces.size());
}

void HeatFlux::rowX(const HeatSides& sides, const Field& t, const Field& courant, int j, Field& flux) const {
  const float *p = t.row(j) - 1, *c = courant.row(j);
  float* f = flux.row(j);
#pragma omp simd
  for (int i = 0; i <= nx_; ++i) f[i] = fifthOrder(c[i], p + i, 1);
  for (int k = lowX_.begin[j]; k < lowX_.begin[j + 1]; ++k) {
    const LowFace low = lowX_.faces[k];
    f[low.i] = low.order == third ? thirdOrder(c[low.i], p + low.i, 1) : donorX(sides, t, courant, low.i, j);
  }
}

void HeatFlux::rowY(const HeatSides& sides, const Field& t, const Field& courant, int j, Field& flux) const {
  const std::ptrdiff_t stride = t.stride();
  const float *p = t.row(j - 1), *c = courant.row(j);
  float* f = flux.row(j);
  // The ghosts end three rows beyond the sides: on the sides themselves the list has all faces, unless they
  // wrap.
#pragma omp simd
  for (int i = 0; i < nx_; ++i) f[i] = fifthOrder(c[i], p + i, stride);
  for (int k = lowY_.begin[j]; k < lowY_.begin[j + 1]; ++k) {
    const LowFace low = lowY_.faces[k];
    f[low.i] =
        low.order == third ? thirdOrder(c[low.i], p + low.i, stride) : donorY(sides, t, courant, low.i, j);
  }
}

std::size_t HeatFlux::bytes() const {
  std::size_t total = least_.capacity() * sizeof(float);
  for (const List* list : {&lowX_, &lowY_})
    total += list->faces.capacity() * sizeof(LowFace) + list->begin.capacity() * sizeof(int);
  return total;
}

}  // namespace smokebox
