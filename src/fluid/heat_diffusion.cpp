#include "fluid/heat_diffusion.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

namespace {

constexpr int kRowGrain = 16;
constexpr int kFewestIterations = 2, kMostIterations = 5000;
// What the iteration may leave over, against the spread of the temperatures and the change of this step.
constexpr double kOfSpread = 1e-5, kOfChange = 1e-4, kRounding = 1e-7;
constexpr float kHalfLink = 2;  // weight of a link to a wall half a cell away

/// A side's cells, from the wall inwards.
struct SideCells {
  int i0, j0, di, dj, count;  // first cell; direction inwards; how many along the side
  int i(int k) const { return di != 0 ? i0 : k; }
  int j(int k) const { return di != 0 ? k : j0; }
};
SideCells cellsOf(int side, int nx, int ny) {
  constexpr int kInwards[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  return {side == 1 ? nx - 1 : 0, side == 3 ? ny - 1 : 0, kInwards[side][0], kInwards[side][1],
          side < 2 ? ny : nx};
}

}  // namespace

HeatDiffusion::HeatDiffusion(const Boundary& boundary, ThreadPool& pool)
    : pool_(pool),
      nx_(boundary.grid.nx),
      ny_(boundary.grid.ny),
      wrapX_(boundary.periodicX()),
      wrapY_(boundary.periodicY()) {
  for (Field* f : {&linkX_, &linkY_, &wall_, &capacity_, &inverse_, &right_, &next_}) *f = Field(nx_, ny_);
  for (int side = 0; side < 4; ++side) bend_[side].assign(side < 2 ? ny_ : nx_, 0.0f);
}

void HeatDiffusion::rebuild(const Boundary& boundary, const HeatSides& sides, const Field& perCapacity) {
  inverseOf_ = -1;
  pool_.blocks(0, ny_ + 1, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      std::copy_n(boundary.openY.row(j), nx_, linkY_.row(j));
      if (!wrapY_ && (j == 0 || j == ny_)) std::fill_n(linkY_.row(j), nx_, 0.0f);
      if (wrapY_ && j == ny_) std::copy_n(boundary.openY.row(0), nx_, linkY_.row(j));
      if (j == ny_) continue;
      std::copy_n(boundary.openX.row(j), nx_ + 1, linkX_.row(j));
      linkX_(0, j) = wrapX_ ? boundary.openX(0, j) : 0;
      linkX_(nx_, j) = linkX_(0, j);
      std::fill_n(wall_.row(j), nx_, 0.0f);
      for (int i = 0; i < nx_; ++i) capacity_(i, j) = perCapacity(i, j) > 0 ? 1 / perCapacity(i, j) : 1;
    }
  });
  for (int side = 0; side < 4; ++side) {
    if (!sides.keeps[side]) continue;
    const SideCells cells = cellsOf(side, nx_, ny_);
    // As much of the wall as the cell holds: what a solid covers of the side is not told apart.
    for (int k = 0; k < cells.count; ++k) {
      const int i = cells.i(k), j = cells.j(k);
      if (perCapacity(i, j) > 0) wall_(i, j) += kHalfLink * capacity_(i, j);
    }
  }
  mostLinks_ = pool_.max(0, ny_, kRowGrain, 0, [&](int begin, int end) {
    float most = 0;
    for (int j = begin; j < end; ++j) {
      const float *x = linkX_.row(j), *y = linkY_.row(j), *above = linkY_.row(j + 1), *c = capacity_.row(j);
#pragma omp simd reduction(max : most)
      for (int i = 0; i < nx_; ++i) most = std::max(most, ((x[i] + x[i + 1]) + (y[i] + above[i])) / c[i]);
    }
    return static_cast<double>(most);
  });
}

void HeatDiffusion::wrap(Field& f) const {
  if (wrapX_)
    for (int j = 0; j < ny_; ++j) {
      f(-1, j) = f(nx_ - 1, j);
      f(nx_, j) = f(0, j);
    }
  if (wrapY_) {
    std::copy_n(f.row(ny_ - 1), nx_, f.row(-1));
    std::copy_n(f.row(0), nx_, f.row(ny_));
  }
}

void HeatDiffusion::findInverse(float c) {
  if (c == inverseOf_) return;
  inverseOf_ = c;
  pool_.blocks(0, ny_, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const float *x = linkX_.row(j), *y = linkY_.row(j), *above = linkY_.row(j + 1), *w = wall_.row(j),
                  *capacity = capacity_.row(j);
      float* inverse = inverse_.row(j);
#pragma omp simd
      for (int i = 0; i < nx_; ++i)
        inverse[i] = 1 / (capacity[i] + c * (((x[i] + x[i + 1]) + (y[i] + above[i])) + w[i]));
    }
  });
}

void HeatDiffusion::findRightSide(const HeatSides& sides, const Field& before, float c, float lowest,
                                  float highest) {
  pool_.blocks(0, ny_, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const float *capacity = capacity_.row(j), *b = before.row(j);
      float* right = right_.row(j);
#pragma omp simd
      for (int i = 0; i < nx_; ++i) right[i] = capacity[i] * b[i];
    }
  });
  auto eachWallCell = [&](auto&& body) {
    for (int side = 0; side < 4; ++side) {
      if (!sides.keeps[side]) continue;
      const SideCells cells = cellsOf(side, nx_, ny_);
      for (int k = 0; k < cells.count; ++k)
        if (wall_(cells.i(k), cells.j(k)) > 0) body(side, k, cells.i(k), cells.j(k));
    }
  };
  // Held within the bounds, so that the solution is too: in a huge step the bend would overshoot.
  eachWallCell([&](int side, int k, int i, int j) {
    if (bend_[side][k] != 0) right_(i, j) = std::clamp(right_(i, j) + c * bend_[side][k], lowest, highest);
  });
  eachWallCell([&](int side, int k, int i, int j) {
    right_(i, j) += c * kHalfLink * capacity_(i, j) * sides.value[side][k];
  });
}

void HeatDiffusion::bendAtWalls(const HeatSides& sides, const Field& t) {
  for (int side = 0; side < 4; ++side) {
    if (!sides.keeps[side]) continue;
    const SideCells cells = cellsOf(side, nx_, ny_);
    for (int k = 0; k < cells.count; ++k) {
      const int i = cells.i(k), j = cells.j(k), p = i + cells.di, q = j + cells.dj;
      const float link = cells.di != 0 ? linkX_(std::max(i, p), j) : linkY_(i, std::max(j, q));
      // The second difference of links of 1/2 and 1 is 3/4 of the second derivative: a third of it is
      // missing.
      bend_[side][k] = link == 1 && capacity_(i, j) == 1
                           ? (1.0f / 3) * (kHalfLink * (sides.value[side][k] - t(i, j)) + (t(p, q) - t(i, j)))
                           : 0.0f;
    }
  }
}

HeatDiffusion::Result HeatDiffusion::solve(const HeatSides& sides, const Field& before, double coefficient,
                                           float coldest, float hottest, Field& x) {
  const auto c = static_cast<float>(coefficient);
  findInverse(c);
  const double scale = static_cast<double>(hottest) - coldest;  // what an error is small against
  findRightSide(sides, before, c, coldest, hottest);
  const double lowest = 1 / (1 + coefficient * mostLinks_), radius = 1 - lowest;
  if (!(radius > 0)) return {};
  const double root = std::sqrt((1 + radius) / lowest), q = (root - 1) / (root + 1);
  Field *now = &x, *next = &next_;
  double rho = radius;
  float momentum = 0, step = 1;  // the first step is Jacobi's
  int count = kFewestIterations;
  for (int k = 0; k < count; ++k) {
    wrap(*now);
    const double change = pool_.max(0, ny_, kRowGrain, 0, [&](int begin, int end) {
      float largest = 0;
      for (int j = begin; j < end; ++j) {
        const float *t = now->row(j), *above = now->row(j + 1), *below = now->row(j - 1),
                    *right = right_.row(j), *inverse = inverse_.row(j), *lx = linkX_.row(j),
                    *ly = linkY_.row(j), *up = linkY_.row(j + 1);
        float* o = next->row(j);
#pragma omp simd reduction(max : largest)
        for (int i = 0; i < nx_; ++i) {
          const float links =
              (lx[i] * t[i - 1] + lx[i + 1] * t[i + 1]) + (ly[i] * below[i] + up[i] * above[i]);
          const float r = inverse[i] * (right[i] + c * links) - t[i];
          o[i] = (t[i] + momentum * (t[i] - o[i])) + step * r;
          largest = std::max(largest, std::fabs(r));
        }
      }
      return static_cast<double>(largest);
    });
    std::swap(now, next);
    if (k == 0) {
      const double enough =
          std::max(kRounding * scale, lowest * std::min(kOfSpread * scale, kOfChange * change));
      double bound = 2 * change * q * q;
      while (bound > enough && bound > 0 && count < kMostIterations) {
        bound *= q;
        ++count;
      }
    }
    const double rhoNext = 1 / (2 / radius - rho);
    momentum = static_cast<float>(rhoNext * rho);
    step = static_cast<float>(2 * rhoNext / radius);
    rho = rhoNext;
  }
  if (now != &x)
    pool_.blocks(0, ny_, kRowGrain, [&](int begin, int end) {
      for (int j = begin; j < end; ++j) std::copy_n(now->row(j), nx_, x.row(j));
    });
  return {count, count < kMostIterations};
}

std::size_t HeatDiffusion::bytes() const {
  std::size_t total = 0;
  for (const Field* f : {&linkX_, &linkY_, &wall_, &capacity_, &inverse_, &right_, &next_})
    total += f->bytes();
  return total;
}

}  // namespace smokebox
