#include "fluid/smoke_volumes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace smokebox {
namespace {
constexpr int kMostAttempts = 6;
constexpr int kReach = 4;          // rows and columns of margin that the sweeps read
constexpr float kMostOut = 0.95f;  // as in smoke_merge.cpp
constexpr float kLargest = 4096;   // cells per step; faster ones, infinities and NaNs count as 0
constexpr float kLeastVolume =
    0.1f;  // of a full cell after the step; cells with less are looked after one by one
// What a cell may carry too much or too little of what it holds and yet be settled: the flow's divergence.
constexpr float kSettled = 2e-6f, kSettledAtRest = 2e-5f;
// By value: see sweep.cpp.
inline float larger(float a, float b) { return a > b ? a : b; }
inline float smaller(float a, float b) { return a < b ? a : b; }
}  // namespace

void wrapMargin(Field& f, Axis axis, int nx, int ny) {
  if (axis == Axis::x) {
    for (int j = 0; j < ny; ++j) {
      float* row = f.row(j);
      for (int k = 1; k <= kReach + 1; ++k) {
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
  windows_.resize((cells_.ny + kWindowRows) / kWindowRows);  // row ny of faces, too
  smoky_.resize(windows_.size());
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
  pool.blocks(0, static_cast<int>(windows_.size()), 1, [&](int begin, int) {
    const Window own = windows_[begin];
    Window both = own;  // the faces between two blocks are of both
    if (begin > 0) both.join(windows_[begin - 1]);
    for (int j = begin * kWindowRows; j <= std::min(ny, begin * kWindowRows + kWindowRows - 1); ++j) {
      const int from = both.begin, to = both.end;
      flow(to - from, b.openY.row(j) + from, v.row(j) + from, courantY_.row(j) + from);
      if (j == ny || own.begin >= own.end) continue;
      float* c = courantX_.row(j);
      flow(own.end - own.begin + 1, b.openX.row(j) + own.begin, u.row(j) + own.begin, c + own.begin);
      if (left) c[0] = driven(b.openX(0, j), u(0, j), b.wallU(0, j));
      if (right) c[nx] = driven(b.openX(nx, j), u(nx, j), b.wallU(nx, j));
      if (cells_.periodicX) c[nx] = c[0];
    }
  });
  for (int j : {0, ny})
    if (b.side(j == 0 ? Side::bottom : Side::top).kind == WallKind::inflow)
      for (int i = 0; i < nx; ++i) courantY_(i, j) = driven(b.openY(i, j), v(i, j), b.wallV(i, j));
  if (cells_.periodicY) std::copy_n(courantY_.row(0), nx, courantY_.row(ny));

  std::fill(drained_.begin(), drained_.end(), 0.0f);
  const double parts = pool.max(0, static_cast<int>(windows_.size()), 1, 0, [&](int block, int) {
    float most = 0;
    const Window w = windows_[block];
    for (int j = block * kWindowRows; w.begin < w.end && j < std::min(ny, (block + 1) * kWindowRows); ++j) {
      const float *x = courantX_.row(j), *low = courantY_.row(j), *high = courantY_.row(j + 1),
                  *vol = start_.row(j);
      const float* after = b.volume.row(j);
      // Non-negative floats are ordered as their bits are, and integers reduce in vectors.
      std::int32_t needs = 0, nets = 0;
#pragma omp simd reduction(max : needs, nets)
      for (int i = w.begin; i < w.end; ++i) {
        const float netX = x[i + 1] - x[i], netY = high[i] - low[i];
        const float outX = larger(x[i + 1], 0) - smaller(x[i], 0);
        const float outY = larger(high[i], 0) - smaller(low[i], 0);
        const float least = smaller(1, larger(1 - netX - netY, kLeastVolume));
        const float need =
            larger(outX * (1 / kMostOut) + larger(netY, 0), outY * (1 / kMostOut) + larger(netX, 0)) / least;
        const bool full = vol[i] == 1 && after[i] == 1;
        needs = std::max(needs, std::bit_cast<std::int32_t>(full ? need : 0.0f));
        nets = std::max(nets, std::bit_cast<std::int32_t>(full ? larger(netX + netY, 0) : 0.0f));
      }
      most = std::max(most, std::bit_cast<float>(needs));
      drained_[j] = std::bit_cast<float>(nets);
    }
    return static_cast<double>(most);
  });
  return static_cast<float>(parts);
}

void SmokeVolumes::scale(float factor, ThreadPool& pool) {
  pool.blocks(0, static_cast<int>(windows_.size()), 1, [&](int block, int) {
    const Window own = windows_[block];
    Window both = own;
    if (block > 0) both.join(windows_[block - 1]);
    for (int j = block * kWindowRows; j <= std::min(cells_.ny, (block + 1) * kWindowRows - 1); ++j) {
      float *x = courantX_.row(j), *y = courantY_.row(j);
      for (int i = both.begin; i < both.end; ++i) y[i] *= factor;
      if (j == cells_.ny || own.begin >= own.end) continue;
      for (int i = own.begin; i <= own.end; ++i) x[i] *= factor;
      if (own.end < cells_.nx && cells_.periodicX) x[cells_.nx] *= factor;
      if (own.begin > 0 && cells_.periodicX) x[0] *= factor;
    }
  });
}

// Where smoke can come in a step of `reach` parts, with all that the sweeps work on beside it: these take the
// strips next to smoke and whole tiles of rows.
void SmokeVolumes::findWindows(const Activity& active, int reach) {
  const int nx = cells_.nx, ny = cells_.ny, count = (ny + kWindowRows - 1) / kWindowRows;
  if (carries()) {
    std::fill(windows_.begin(), windows_.end(), Window{0, nx});
    return;
  }
  constexpr int kColumns = 64;  // windows begin and end at multiples of these
  const int beyond = reach + 8, margin = kColumns + (beyond + kColumns - 1) / kColumns * kColumns;
  for (int k = 0; k < count; ++k) {
    Window& w = smoky_[k];
    w = {};
    for (int j = k * kWindowRows; j < std::min(ny, (k + 1) * kWindowRows); ++j)
      for (int s = active.next(0, j); s < active.strips(); s = active.next(s + 1, j)) {
        const int column = s * Activity::kStrip / kColumns * kColumns;
        w.join({column - margin, column + kColumns + margin});
      }
    if (w.begin >= w.end) continue;
    // Through a periodic side: all columns.
    if (cells_.periodicX && (w.begin < 0 || w.end > nx)) w = {0, nx};
    w = {std::max(w.begin, 0), std::min(w.end, nx)};
  }
  const int blocks = 2 + beyond / kWindowRows;
  for (int k = 0; k < static_cast<int>(windows_.size()); ++k) {
    windows_[k] = {};
    for (int m = k - blocks; m <= k + blocks; ++m) {
      const int from = cells_.periodicY ? (m % count + count) % count : m;
      if (from >= 0 && from < count) windows_[k].join(smoky_[from]);
    }
  }
}

void SmokeVolumes::listNodes() {
  near_.clear();
  for (int c : cut_)
    if (inWindow(cells_.i(c), cells_.j(c))) near_.push_back(c);
  nodes_ = near_;
  bool drained = false;
  for (int j = 0; j < cells_.ny; ++j) drained |= drained_[j] > 1 - kLeastVolume;
  if (plan_.handedOver().empty() && plan_.drawnOn().empty() && !drained) return;
  listed_.resize(cells_.count(), 0);
  for (int c : near_) listed_[c] = 1;
  auto add = [&](int c) {
    if (c < 0 || listed_[c]) return;
    listed_[c] = 1;
    nodes_.push_back(c);
  };
  for (const SmokeTransfer& t : plan_.handedOver()) add(t.from), add(t.to);
  for (int c : plan_.drawnOn()) add(c);
  // A velocity that is far from free of divergence would empty a cell.
  for (int j = 0; j < cells_.ny; ++j)
    for (int i = windows_[j / kWindowRows].begin;
         drained_[j] > 1 - kLeastVolume && i < windows_[j / kWindowRows].end; ++i)
      if (courantX_(i + 1, j) - courantX_(i, j) + courantY_(i, j + 1) - courantY_(i, j) > 1 - kLeastVolume)
        add(cells_.cell(i, j));
  for (int c : nodes_) listed_[c] = 0;
}

void SmokeVolumes::prepare(const Boundary& b, const Field& u, const Field& v, double dt,
                           const Activity& active, ThreadPool& pool) {
  moved_ = b.version != version_;
  if (carries() || stale_) irregular_.find(cells_, b, volumeBefore_, start_, cut_);
  stale_ = carries();
  // Smoke moves by a cell in a part: if the flows near it need more parts than were thought, look further.
  for (int reach = std::max(4, parts_);; reach = 2 * parts_) {
    findWindows(active, reach);
    parts_ = plan(b, u, v, dt, pool);
    if (parts_ <= reach || carries()) break;
  }
  if (parts_ > 1) scale(1.0f / parts_, pool);
  for (Field* f : {&courantX_, &courantY_, &start_}) wrapMargins(*f);
}

// All margins beyond periodic sides, with the columns and rows of faces that repeat the first ones.
void SmokeVolumes::wrapMargins(Field& f) const {
  const int nx = cells_.nx, ny = cells_.ny;
  if (cells_.periodicY)
    for (int k = 0; k < kReach; ++k) {
      std::copy_n(f.row(k), nx + 1, f.row(ny + k));
      std::copy_n(f.row(ny - 1 - k), nx + 1, f.row(-1 - k));
    }
  if (!cells_.periodicX) return;
  const int first = cells_.periodicY ? -kReach : 0, last = cells_.periodicY ? ny + kReach : ny + 1;
  for (int j = first; j < last; ++j) {
    float* row = f.row(j);
    for (int k = 0; k < kReach; ++k) {
      row[nx + k] = row[k];
      row[-1 - k] = row[nx - 1 - k];
    }
  }
}

SweptVolumes SmokeVolumes::swept() const {
  SweptVolumes volume;
  volume.nx = cells_.nx;
  volume.ny = cells_.ny;
  volume.periodicX = cells_.periodicX;
  volume.periodicY = cells_.periodicY;
  volume.start = &start_;
  volume.courantX = &courantX_;
  volume.courantY = &courantY_;
  volume.keepDivergence = carries();
  return volume;
}

// Flows, transfers and clusters; into how many parts the step has to be cut.
int SmokeVolumes::plan(const Boundary& b, const Field& u, const Field& v, double dt, ThreadPool& pool) {
  const float parts = flows(b, u, v, dt, pool);
  float full = std::max(1.0f, parts);
  if (full > kMostParts) {
    scale(kMostParts / full, pool);
    full = kMostParts;
  }
  const int needed = static_cast<int>(std::ceil(full));
  int whole = needed;
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
    for (int attempt = 0;; ++attempt) {
      whole = clusters_.build(cells_, near_, nodes_, b, volumeBefore_, start_, courantX_, courantY_, needed,
                              kMostParts);
      if (whole > 0) break;
      scale(attempt < kMostAttempts ? 0.25f : 0.0f, pool);
    }
    if (carries()) nodes_ = clusters_.nodes();
    irregular_.choose(cells_, b, clusters_);
  } else {
    clusters_.clear(cells_);
    irregular_.choose(cells_, b, clusters_);
  }
  return whole;
}

void SmokeVolumes::settle(const Boundary& b, Axis axis, const SweptVolumes& volume) {
  looseAfter_ = false;
  clusterCarried_.assign(clusters_.count(), 0);
  if (nodes_.empty()) return;
  if (measure_.empty()) measure_ = Field(cells_.nx, cells_.ny, 1);
  const Field& flow = courant(axis);
  const int di = axis == Axis::x, dj = 1 - di;
  // Where nothing moves, what the step ends with is what the cells hold.
  auto after = [&](int i, int j) {
    return carries() ? volume.at(i, j) - (flow(i + di, j + dj) - flow(i, j)) : b.volume(i, j);
  };
  ends_.resize(nodes_.size());
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const int i = cells_.i(nodes_[k]), j = cells_.j(nodes_[k]);
    const bool open = b.volume(i, j) > 0;
    ends_[k] = open ? after(i, j) : 1.0f;
    measure_(i, j) = open ? ends_[k] : 0.0f;
  }
  for (int k = 0; k < clusters_.count(); ++k)
    for (const int* m = clusters_.begin(k); m != clusters_.end(k); ++m) {
      const int i = cells_.i(*m), j = cells_.j(*m);
      clusterCarried_[k] += after(i, j);
      measure_(i, j) = 0;
    }
}

void SmokeVolumes::commit(const Boundary& b) {
  for (std::size_t k = 0; k < nodes_.size(); ++k) start_(cells_.i(nodes_[k]), cells_.j(nodes_[k])) = ends_[k];
  // The cells of a cluster share its volume as they share its smoke.
  for (int k = 0; k < clusters_.count(); ++k) {
    double open = 0;
    for (const int* m = clusters_.begin(k); m != clusters_.end(k); ++m)
      open += b.volume(cells_.i(*m), cells_.j(*m));
    for (const int* m = clusters_.begin(k); m != clusters_.end(k); ++m) {
      const int i = cells_.i(*m), j = cells_.j(*m);
      start_(i, j) =
          !carries() ? b.volume(i, j) : static_cast<float>(clusterCarried_[k] * b.volume(i, j) / open);
    }
  }
  if (!carries() || nodes_.empty()) return;
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

}  // namespace smokebox
