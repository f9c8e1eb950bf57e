// One directional sweep of a conserved quantity over the grid: mass and volume through each face, the value
// of the carried mass from a single-step semi-Lagrangian reconstruction of 7th order (the mean, over the
// swept part of the upwind cell, of the polynomial that has the right means in seven cells), and flux
// correction between the donor flux and this one so that values stay in [0, highest] (Zalesak 1979, with
// global bounds).
//
// All masses and fluxes are whole multiples of one quantum, a power of two: as long as they stay under 2^24
// quanta, every addition of float32 is exact, and so mass is conserved to the last bit. Fluxes are rounded so
// that no cell is overdrawn.
//
// The caller guarantees that at most 95% of a cell's volume leaves it in one sweep. Faces near cut cells come
// as a list with a stencil of 5th or 3rd order, or the donor flux alone; merged cells share one value, see
// smoke_merge.h.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/field.h"
#include "base/threads.h"

namespace smokebox {

enum class Axis { x, y };

struct Quantum {
  float size = 0, inverse = 0;
};

/// Items by row j = -1 .. ny + 1, sorted by i within a row.
template <class Item>
struct RowList {
  std::vector<Item> items;
  std::vector<int> start;  // start[j + 1] .. start[j + 2] are the items of row j

  const Item* begin(int j) const { return items.data() + start[j + 1]; }
  const Item* end(int j) const { return items.data() + start[j + 2]; }
};

/// A face whose 7th-order stencil meets a cut cell or a face that is not open.
struct IrregularFace {
  int i = 0, j = 0;
  bool five = false;                           // the 5th-order stencil does not; else:
  bool donor = true;                           // no correction at all: it touches a merged or closed cell
  bool behindLow = false, behindHigh = false;  // the cell behind the low (high) cell can be used
};

/// The cell of a cluster of merged cells that has corrected fluxes; its limits come from the whole cluster.
struct ClusterRoot {
  int i = 0;
  int cluster = 0;
};

/// Which parts of the rows hold any smoke at all: rows -4 .. ny + 3, strips of kStrip columns.
class Activity {
 public:
  static constexpr int kStrip = 16;
  Activity() = default;
  Activity(int nx, int ny)
      : strips_((nx + kStrip - 1) / kStrip),
        stride_(strips_ + kWord),
        flags_(static_cast<std::size_t>(stride_) * (ny + 8), 0) {}
  int strips() const { return strips_; }
  std::uint8_t& at(int strip, int j) { return flags_[place(strip, j)]; }
  std::uint8_t at(int strip, int j) const { return flags_[place(strip, j)]; }
  /// The first strip of a row from this one on that is marked, or strips().
  int next(int strip, int j) const {
    for (; strip < strips_; strip += kWord) {
      std::uint64_t word;
      std::memcpy(&word, flags_.data() + place(strip, j), kWord);
      if (word) return strip + std::countr_zero(word) / 8;
    }
    return strips_;
  }
  /// Whether any is marked in strips [begin, end), 8 at most, of rows [j0, j1).
  bool any(int begin, int end, int j0, int j1) const {
    std::uint64_t marked = 0, word;
    for (int j = j0; j < j1; ++j) {
      std::memcpy(&word, flags_.data() + place(begin, j), kWord);
      marked |= word;
    }
    return marked << 8 * (kWord - (end - begin)) != 0;
  }
  void clear() { std::fill(flags_.begin(), flags_.end(), 0); }
  /// Marks what is marked in one of the same shape.
  void add(const Activity& other) {
    for (std::size_t k = 0; k < flags_.size(); ++k) flags_[k] |= other.flags_[k];
  }
  void swap(Activity& other) noexcept {
    std::swap(strips_, other.strips_);
    std::swap(stride_, other.stride_);
    flags_.swap(other.flags_);
  }

 private:
  static constexpr int kWord = 8;  // bytes; as many zeros after each row
  std::size_t place(int strip, int j) const { return static_cast<std::size_t>(j + 4) * stride_ + strip; }
  int strips_ = 0, stride_ = 0;
  std::vector<std::uint8_t> flags_;
};

/// The volumes of the cells before a sweep: those at the start of the step less what the sweeps so far have
/// carried out of them. Nothing is stored: a row is worked out where a sweep needs it.
struct SweptVolumes {
  int nx = 0, ny = 0;
  bool periodicX = false, periodicY = false;
  const Field* start = nullptr;                          // margins filled where periodic, else 1
  const Field *courantX = nullptr, *courantY = nullptr;  // through the low faces; margins as above
  /// Sweeps along both axes leave what the flow's divergence makes of it. If not, they leave what there was:
  /// where no solid moves, that divergence is the pressure solver's tolerance.
  bool keepDivergence = true;
  // How often along both axes, and whether once more along one of them.
  float both = 0;
  bool onlyX = false, onlyY = false;

  void swept(Axis axis);
  float at(int i, int j) const {
    const float netX = (*courantX)(i + 1, j) - (*courantX)(i, j);
    const float netY = (*courantY)(i, j + 1) - (*courantY)(i, j);
    const float once = onlyX ? netX : onlyY ? netY : 0.0f;
    return (*start)(i, j) - (both > 0 ? both * (netX + netY) + once : once);
  }
  /// Those of cells first .. first + n - 1 of row j, in `buffer` or in place; 1 beyond sides that are not
  /// periodic.
  const float* row(int first, int n, int j, float* buffer) const;
};

struct SweepJob {
  Axis axis = Axis::x;
  int nx = 0, ny = 0;
  bool periodic = false;           // along the axis
  const Field* courant = nullptr;  // volume through the low face of each cell, in cells; margins filled
  SweptVolumes volume;             // before the sweep
  const Field* divisor = nullptr;  // if set: the volume that the values out are measured by (0: value 0)
  const Field* mass = nullptr;     // margins filled if periodic
  const Field* value = nullptr;    // margins filled
  Field* massOut = nullptr;
  Field* valueOut = nullptr;
  float highest = 0;  // upper bound of the values
  Quantum quantum;
  const RowList<IrregularFace>* irregular = nullptr;
  const RowList<ClusterRoot>* roots = nullptr;
  const float* clusterMass = nullptr;    // of each cluster after the donor fluxes
  const float* clusterVolume = nullptr;  // of each cluster after the sweep
  const Activity* active = nullptr;
  Activity* activeOut = nullptr;  // in: which parts of massOut and valueOut are not all 0
};

struct SweepResult {
  double throughLow = 0,
         throughHigh = 0;  // mass through the low and the high side of the domain, along the axis
  float highest = 0;       // largest value out
};

/// Memory for the rows that a sweep works on and for its partial results; one for all sweeps of a simulation.
class Sweeper {
 public:
  Sweeper(int nx, int ny);
  SweepResult run(const SweepJob& job, ThreadPool& pool);
  std::size_t bytes() const;

 private:
  SweepResult runX(const SweepJob& job, ThreadPool& pool);
  SweepResult runY(const SweepJob& job, ThreadPool& pool);
  std::vector<double> low_, high_;  // by row or by tile
  std::vector<float> top_;
};

/// Mean over the swept part g of the cell with mean `c`, from the 5th-order polynomial through the means a to
/// e; e lies downwind.
inline float sweptMean5(float a, float b, float c, float d, float e, float g) {
  const float t1 = d - b, t2 = (d - c) - (c - b), t3 = (e - a) - 2 * t1, t4 = ((e - c) - (c - a)) - 4 * t2;
  const float s = 1 - 2 * g, w = (2 - g) * (1 + g);
  return c + 0.25f * (1 - g) * (t1 + s * (1.0f / 3) * t2 - w * (1.0f / 12) * (t3 + s * 0.2f * t4));
}

/// Mean over the swept part g of the cell with mean `c`, from the 3rd-order polynomial through the means b,
/// c, d; d lies downwind.
inline float sweptMean3(float b, float c, float d, float g) {
  return c + 0.25f * (1 - g) * ((d - b) + (1 - 2 * g) * (1.0f / 3) * ((d - c) - (c - b)));
}

}  // namespace smokebox
