#include "fluid/smoke_volumes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace smokebox {
namespace {
constexpr int kGrain = 16;
constexpr int kMostAttempts = 6;
constexpr int kReach = 4;          // rows and columns of margin that the sweeps read
constexpr float kMostOut = 0.95f;  // as in smoke_merge.cpp
constexpr float kLargest = 4096;   // cells per step; faster ones, infinities and NaNs count as 0
constexpr float kLeastVolume =
    0.1f;  // of a full cell after the step; cells with less are looked after one by one
// What a cell may carry too much or too little of what it holds and yet be settled: the flow's divergence.
constexpr float kSettled = 2e-6f, kSettledAtRest = 2e-5f;
}  // namespace

void wrapMargin(Field& f, Axis axis, int nx, int ny, bool faces) {
  if (axis == Axis::x) {
    for (int j = 0; j < ny; ++j) {
      float* row = f.row(j);
      if (faces) row[nx] = row[0];
      for (int k = 1; k <= kReach; ++k) {
        row[-k] = row[nx - k];
        row[nx - 1 + k] = row[k - 1];
      }
    }
  } else {
    const std::size_t size = nx * sizeof(float);
    for (int k = 1; k <= kReach; ++k) {
      std::memcpy(f.row(-k), f.row(ny - k), size);
      std::memcpy(f.row(ny - 1 + k), f.row(k - 1), size);
    }
  }
}

SmokeVolumes::SmokeVolumes(const Boundary& b)
    : cells_(b),
      courantX_(cells_.nx, cells_.ny),
      courantY_(cells_.nx, cells_.ny),
      start_(cells_.nx, cells_.ny, 1),
      openXBefore_(b.openX),
      openYBefore_(b.openY),
      volumeBefore_(b.volume),
      regionsBefore_(b.regions),
      drained_(cells_.ny, 0) {
  version_ = b.version;
  for (int j = 0; j < cells_.ny; ++j)
    for (int i = 0; i < cells_.nx; ++i) start_(i, j) = b.volume(i, j) > 0 ? b.volume(i, j) : 1.0f;
}

std::size_t SmokeVolumes::bytes() const {
  std::size_t sum = (cut_.capacity() + nodes_.capacity() + exchanging_.capacity()) * sizeof(int) +
                    listed_.capacity() + regionsBefore_.bytes() + match_.bytes() + plan_.bytes() +
                    clusters_.bytes() + irregular_.bytes();
  for (const Field* f :
       {&courantX_, &courantY_, &start_, &measure_, &openXBefore_, &openYBefore_, &volumeBefore_})
    if (!f->empty()) sum += f->bytes();
  return sum;
}

// Courant numbers of the whole step; into how many parts the full cells need it cut.
float SmokeVolumes::flows(const Boundary& b, const Field& u, const Field& v, double dt, ThreadPool& pool) {
  const int nx = cells_.nx, ny = cells_.ny;
  const float s = static_cast<float>(dt / b.grid.h);
  auto flow = [s](int n, const float* open, const float* speed, float* c) {
#pragma omp simd
    for (int i = 0; i < n; ++i) {
      const float x = open[i] * speed[i] * s;
      c[i] = std::fabs(x) <= kLargest ? x : 0.0f;
    }
  };
  // An inflow drives fluid through a closed face.
  auto driven = [s](float open, float speed, float wall) { return (open * speed + (1 - open) * wall) * s; };
  const bool left = b.side(Side::left).kind == WallKind::inflow,
             right = b.side(Side::right).kind == WallKind::inflow;
  pool.blocks(0, ny + 1, kGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      flow(nx, b.openY.row(j), v.row(j), courantY_.row(j));
      if (j == ny) break;
      float* c = courantX_.row(j);
      flow(nx + 1, b.openX.row(j), u.row(j), c);
      if (left) c[0] = driven(b.openX(0, j), u(0, j), b.wallU(0, j));
      if (right) c[nx] = driven(b.openX(nx, j), u(nx, j), b.wallU(nx, j));
      if (cells_.periodicX) c[nx] = c[0];
    }
  });
  for (int j : {0, ny})
    if (b.side(j == 0 ? Side::bottom : Side::top).kind == WallKind::inflow)
      for (int i = 0; i < nx; ++i) courantY_(i, j) = driven(b.openY(i, j), v(i, j), b.wallV(i, j));
  if (cells_.periodicY) std::copy_n(courantY_.row(0), nx, courantY_.row(ny));

  const double parts = pool.max(0, ny, kGrain, 0, [&](int begin, int end) {
    float most = 0;
    for (int j = begin; j < end; ++j) {
      const float *x = courantX_.row(j), *low = courantY_.row(j), *high = courantY_.row(j + 1),
                  *vol = start_.row(j);
      const float* after = b.volume.row(j);
      // Non-negative floats are ordered as their bits are, and integers reduce in vectors.
      std::int32_t needs = 0, nets = 0;
#pragma omp simd reduction(max : needs, nets)
      for (int i = 0; i < nx; ++i) {
        const float netX = x[i + 1] - x[i], netY = high[i] - low[i];
        const float outX = std::max(x[i + 1], 0.0f) - std::min(x[i], 0.0f);
        const float outY = std::max(high[i], 0.0f) - std::min(low[i], 0.0f);
        const float least = std::min(1.0f, std::max(1 - netX - netY, kLeastVolume));
        const float need = std::max(outX * (1 / kMostOut) + std::max(netY, 0.0f),
                                    outY * (1 / kMostOut) + std::max(netX, 0.0f)) /
                           least;
        const bool full = vol[i] == 1 && after[i] == 1;
        needs = std::max(needs, std::bit_cast<std::int32_t>(full ? need : 0.0f));
        nets = std::max(nets, std::bit_cast<std::int32_t>(full ? std::max(netX + netY, 0.0f) : 0.0f));
      }
      most = std::max(most, std::bit_cast<float>(needs));
      drained_[j] = std::bit_cast<float>(nets);
    }
    return static_cast<double>(most);
  });
  return static_cast<float>(parts);
}

void SmokeVolumes::scale(float factor, ThreadPool& pool) {
  pool.blocks(0, cells_.ny + 1, kGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      float *x = courantX_.row(j), *y = courantY_.row(j);
      for (int i = 0; i < cells_.nx; ++i) y[i] *= factor;
      if (j < cells_.ny)
        for (int i = 0; i <= cells_.nx; ++i) x[i] *= factor;
    }
  });
}

void SmokeVolumes::listNodes() {
  nodes_ = cut_;
  bool drained = false;
  for (int j = 0; j < cells_.ny; ++j) drained |= drained_[j] > 1 - kLeastVolume;
  if (plan_.handedOver().empty() && plan_.drawnOn().empty() && !drained) return;
  listed_.resize(cells_.count(), 0);
  for (int c : cut_) listed_[c] = 1;
  auto add = [&](int c) {
    if (c < 0 || listed_[c]) return;
    listed_[c] = 1;
    nodes_.push_back(c);
  };
  for (const SmokeTransfer& t : plan_.handedOver()) add(t.from), add(t.to);
  for (int c : plan_.drawnOn()) add(c);
  // A velocity that is far from free of divergence would empty a cell.
  for (int j = 0; j < cells_.ny; ++j)
    for (int i = 0; drained_[j] > 1 - kLeastVolume && i < cells_.nx; ++i)
      if (courantX_(i + 1, j) - courantX_(i, j) + courantY_(i, j + 1) - courantY_(i, j) > 1 - kLeastVolume)
        add(cells_.cell(i, j));
  for (int c : nodes_) listed_[c] = 0;
}

void SmokeVolumes::prepare(const Boundary& b, const Field& u, const Field& v, double dt, ThreadPool& pool) {
  moved_ = b.version != version_;
  if (carries() || stale_) irregular_.find(cells_, b, volumeBefore_, start_, cut_);
  stale_ = carries();
  const float parts = flows(b, u, v, dt, pool);
  float full = std::max(1.0f, parts);
  if (full > kMostParts) {
    scale(kMostParts / full, pool);
    full = kMostParts;
  }
  parts_ = static_cast<int>(std::ceil(full));
  plan_.clear();
  if (moved_) {
    match_.find(cells_, cut_, regionsBefore_, b, dt);
    const std::size_t cut = cut_.size();
    match_.addChanged(cells_, regionsBefore_, b.regions, cut_);
    if (cut_.size() > cut) {
      std::sort(cut_.begin(), cut_.end());
      cut_.erase(std::unique(cut_.begin(), cut_.end()), cut_.end());
    }
    plan_.handOver(cells_, cut_, match_, {&openXBefore_, &openYBefore_, &volumeBefore_, &regionsBefore_},
                   {&b.openX, &b.openY, &b.volume, &b.regions}, courantX_, courantY_, start_);
  }
  listNodes();
  mostCarried_ = 1;
  for (int c : nodes_) mostCarried_ = std::max(mostCarried_, start_(cells_.i(c), cells_.j(c)));
  if (!nodes_.empty()) {
    // Where the flows cannot be made safe one by one (a velocity that is no solution), all are slowed down.
    const int needed = parts_;
    for (int attempt = 0;; ++attempt) {
      parts_ = clusters_.build(cells_, cut_, nodes_, b, volumeBefore_, start_, courantX_, courantY_, needed,
                               kMostParts);
      if (parts_ > 0) break;
      scale(attempt < kMostAttempts ? 0.25f : 0.0f, pool);
    }
    if (carries()) nodes_ = clusters_.nodes();
    irregular_.choose(cells_, b, clusters_);
  } else {
    clusters_.clear(cells_);
    irregular_.choose(cells_, b, clusters_);
  }
  if (parts_ > 1) scale(1.0f / parts_, pool);
  if (cells_.periodicX) wrapMargin(courantX_, Axis::x, cells_.nx, cells_.ny, true);
  if (cells_.periodicY) wrapMargin(courantY_, Axis::y, cells_.nx, cells_.ny, true);
}

void SmokeVolumes::settle(const Boundary& b, Axis axis, const Field& volume) {
  looseAfter_ = false;
  clusterCarried_.assign(clusters_.count(), 0);
  if (nodes_.empty()) return;
  if (measure_.empty()) measure_ = Field(cells_.nx, cells_.ny, 1);
  if (!carries()) {
    for (int c : nodes_) {
      const int i = cells_.i(c), j = cells_.j(c);
      measure_(i, j) = b.volume(i, j);
      start_(i, j) = b.volume(i, j) > 0 ? b.volume(i, j) : 1.0f;
    }
    for (int k = 0; k < clusters_.count(); ++k)
      for (const int* m = clusters_.begin(k); m != clusters_.end(k); ++m) {
        const int i = cells_.i(*m), j = cells_.j(*m);
        clusterCarried_[k] += b.volume(i, j);
        measure_(i, j) = 0;
        start_(i, j) = b.volume(i, j) > 0 ? b.volume(i, j) : 1.0f;
      }
    return;
  }
  const Field& flow = courant(axis);
  const int di = axis == Axis::x, dj = 1 - di;
  auto after = [&](int i, int j) { return volume(i, j) - (flow(i + di, j + dj) - flow(i, j)); };
  for (int c : nodes_) {
    const int i = cells_.i(c), j = cells_.j(c);
    const bool open = b.volume(i, j) > 0;
    start_(i, j) = open ? after(i, j) : 1.0f;
    measure_(i, j) = open ? start_(i, j) : 0.0f;
  }
  // The cells of a cluster share its volume as they share its smoke.
  for (int k = 0; k < clusters_.count(); ++k) {
    double carried = 0, open = 0;
    for (const int* m = clusters_.begin(k); m != clusters_.end(k); ++m) {
      const int i = cells_.i(*m), j = cells_.j(*m);
      carried += after(i, j);
      open += b.volume(i, j);
    }
    clusterCarried_[k] = carried;
    for (const int* m = clusters_.begin(k); m != clusters_.end(k); ++m) {
      const int i = cells_.i(*m), j = cells_.j(*m);
      start_(i, j) = static_cast<float>(carried * b.volume(i, j) / open);
      measure_(i, j) = 0;
    }
  }
  exchanging_.assign(nodes_.begin(), nodes_.end());
  for (int k = 0; k < clusters_.count(); ++k) exchanging_.push_back(*clusters_.begin(k));
  plan_.exchange(cells_, exchanging_, {&b.openX, &b.openY, &b.volume, &b.regions}, start_);
}

void SmokeVolumes::finish(const Boundary& b) {
  auto rest = [&](int c) {
    const int i = cells_.i(c), j = cells_.j(c);
    const float open = b.volume(i, j);
    measure_(i, j) = open;
    if (!(open > 0)) {
      start_(i, j) = 1;
      return;
    }
    const float settled = moved_ ? (open == 1 ? kSettled : 0.0f) : kSettledAtRest * open;
    if (std::fabs(start_(i, j) - open) <= settled) start_(i, j) = open;
    if (start_(i, j) != open) looseAfter_ = true;
  };
  if (carries() && !nodes_.empty()) {
    for (int c : exchanging_) rest(c);
    for (int k = 0; k < clusters_.count(); ++k)
      for (const int* m = clusters_.begin(k); m != clusters_.end(k); ++m) rest(*m);
    for (const SmokeTransfer& t : plan_.exchanged()) rest(t.from), rest(t.to);
  } else if (!measure_.empty()) {
    // The next step may merge other cells: these are measured by themselves again.
    for (int k = 0; k < clusters_.count(); ++k)
      for (const int* m = clusters_.begin(k); m != clusters_.end(k); ++m)
        measure_(cells_.i(*m), cells_.j(*m)) = b.volume(cells_.i(*m), cells_.j(*m));
  }
  loose_ = looseAfter_;
  if (moved_) {
    openXBefore_ = b.openX;
    openYBefore_ = b.openY;
    volumeBefore_ = b.volume;
    regionsBefore_ = b.regions;
    version_ = b.version;
  }
}

void SmokeVolumes::advance(Axis axis, const Field& volume, Field& next, ThreadPool& pool) const {
  const int nx = cells_.nx;
  pool.blocks(0, cells_.ny, kGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const float* low = courant(axis).row(j);
      const float *high = axis == Axis::x ? low + 1 : courant(axis).row(j + 1), *from = volume.row(j);
      float* to = next.row(j);
#pragma omp simd
      for (int i = 0; i < nx; ++i) to[i] = from[i] - (high[i] - low[i]);
    }
  });
}

}  // namespace smokebox
