// The loops over one row of a multigrid level, in explicit vectors of 16 lanes: compilers do not vectorise
// red-black rows in place. Every lane does the same operations whatever the instruction set, so the results
// are the same too.
//
// Sums of a row go into 16 lanes, which are then added in a fixed order in float64.
#pragma once
#include <algorithm>
#include <bit>
#include <cstring>

#include "base/lanes.h"
#include "fluid/multigrid_level.h"

namespace smokebox::multigrid {

SMOKEBOX_INLINE double sumOfLanes(const Lanes& v) {
  float lanes[kLanes];
  store(lanes, v);
  const auto at = [&](int k) { return static_cast<double>(lanes[k]); };
  double four[4];
  for (int k = 0; k < 4; ++k) four[k] = (at(k) + at(k + 8)) + (at(k + 4) + at(k + 12));
  return (four[0] + four[2]) + (four[1] + four[3]);
}

/// The larger one of each lane, of magnitudes. Compared by their bits: a NaN is larger than any number, and
/// stays.
SMOKEBOX_INLINE Lanes larger(const Lanes& a, const Lanes& b) {
  const LaneMask x = bitsOfFloats(a), y = bitsOfFloats(b);
  return floatsOfBits(select(x > y, x, y));
}

/// Of magnitudes.
SMOKEBOX_INLINE float largestLane(const Lanes& v) {
#ifdef __AVX512F__
  const LaneMask place = laneNumbers();
  Lanes m = larger(v, __builtin_shuffle(v, place ^ 8));
  m = larger(m, __builtin_shuffle(m, place ^ 4));
  m = larger(m, __builtin_shuffle(m, place ^ 2));
  return larger(m, __builtin_shuffle(m, place ^ 1))[0];
#else
  int bits[kLanes];
  std::memcpy(bits, &v, sizeof(bits));
  for (int half = kLanes / 2; half > 0; half /= 2)
    for (int k = 0; k < half; ++k) bits[k] = std::max(bits[k], bits[k + half]);
  return std::bit_cast<float>(bits[0]);
#endif
}

/// Are all lanes true?
SMOKEBOX_INLINE bool allLanes(const LaneMask& m) {
  long long pairs[kLanes / 2];
  std::memcpy(pairs, &m, sizeof(pairs));
  long long all = -1;
  for (const long long pair : pairs) all &= pair;
  return all == -1;
}

/// A bit for each lane that is true.
SMOKEBOX_INLINE unsigned bitsOf(const LaneMask& m) {
  int lanes[kLanes];
  std::memcpy(lanes, &m, sizeof(lanes));
  unsigned sum = 0;
  for (int k = 0; k < kLanes; ++k) sum |= static_cast<unsigned>(lanes[k]) & (1u << k);
  return sum;
}

/// Lanes of columns i to i + 15 of row j that have the given colour (0 red: i + j even; where the level is
/// mirrored, the right and the upper half have their colours the other way round).
SMOKEBOX_INLINE LaneMask lanesOfColour(const Level& level, std::ptrdiff_t i, int j, int colour) {
  const LaneMask place = laneNumbers(), even = (place & 1) - 1;
  const LaneMask mask = even ^ -((level.colourOfRow(j) + colour) & 1);
  return mask ^ (place >= level.swapsAt - static_cast<int>(i));
}

/// What stands for a quarter in the chunk beside a side, and for the links to the left and to the right of
/// its cells.
SMOKEBOX_INLINE LaneMask laneAtSide(int kind) { return laneNumbers() == (kind & kLeftSide ? 0 : kLanes - 1); }
SMOKEBOX_INLINE const Level::SideCell& sideCell(const Level& level, int kind, int j) {
  return level.sideCells[2 * j + (kind & kLeftSide ? 0 : 1)];
}
SMOKEBOX_INLINE Lanes inverseDiagonal(const Level& level, int kind, int j) {
  const Lanes quarter = Lanes{} + 0.25f;
  if (kind & kRegular) return quarter;
  return select(laneAtSide(kind), Lanes{} + sideCell(level, kind, j).inverse, quarter);
}

/// Goes along a row, chunk by chunk: the values of one, and those to the left and to the right of them. What
/// lies to the left of the next chunk is known before this one is stored: the store would stall the load, and
/// two columns of one colour, in the middle, see each other's old values.
class Along {
 public:
  Lanes left = {}, here = {}, right = {};

#ifdef __AVX512F__
  // From what is loaded already: loads across two lines of the cache take twice as long.
  SMOKEBOX_INLINE explicit Along(const float* x) : here(load(x - kLanes)), ahead_(load(x)) {}
  SMOKEBOX_INLINE void at(const float* x) {
    const LaneMask next = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
    left = __builtin_shuffle(here, ahead_, next + (kLanes - 2));
    here = ahead_;
    ahead_ = load(x + kLanes);
    right = __builtin_shuffle(here, ahead_, next);
  }

 private:
  Lanes ahead_;
#else
  SMOKEBOX_INLINE explicit Along(const float* x) : nextLeft_(load(x - 1)) {}
  SMOKEBOX_INLINE void at(const float* x) {
    left = nextLeft_, here = load(x), right = load(x + 1);
    nextLeft_ = load(x + kLanes - 1);
  }

 private:
  Lanes nextLeft_;
#endif
};

/// Sweeps the cells of `lanes` in the chunks [begin, end) of a row whose links are 1, or lead to values that
/// are 0.
SMOKEBOX_INLINE void sweepRegular(Along& along, float* x, const float* b, std::ptrdiff_t stride, int begin,
                                  int end, const LaneMask& lanes, const Lanes& inverse) {
  for (int i = begin; i < end; i += kLanes) {
    along.at(x + i);
    const Lanes value =
        (((along.left + along.right) + (load(x + i - stride) + load(x + i + stride))) + load(b + i)) *
        inverse;
    store(x + i, select(lanes, value, along.here));
  }
}

/// Any chunk: its cells of `lanes`.
SMOKEBOX_INLINE void sweepGeneral(const Along& along, float* x, const float* b, const float* ax,
                                  const float* ay, const float* id, std::ptrdiff_t stride,
                                  const LaneMask& lanes) {
  const Lanes value = (((load(ax) * along.left + load(ax + 1) * along.right) +
                        (load(ay) * load(x - stride) + load(ay + stride) * load(x + stride))) +
                       load(b)) *
                      load(id);
  store(x, select(lanes, value, along.here));
}

/// Where two cells have next to no link but that between them, they cannot be solved as one.
constexpr float kMostOfPair = 0.98f;

inline Level::Pair pairOf(float overA, float overB) {
  if (!(overA > 0 && overB > 0)) return {overA, overB, 0};
  const float both = overA * overB;
  return {overA, overB, both > kMostOfPair ? -1 : 1 / (1 - both)};
}

/// Two linked cells of one colour are solved as one, from what a sweep has made of each with the old value of
/// the other. What is none of the sweeps' over rows (special) is left as it is.
SMOKEBOX_INLINE void solvePair(float& a, float& b, const Level::Pair& pair, float wasA, float wasB) {
  if (pair.scale == 0) return;
  if (pair.scale < 0) {
    a = 0.5f * (a + wasA);
    b = 0.5f * (b + wasB);
    return;
  }
  const float p = a - pair.overA * wasB, q = b - pair.overB * wasA;
  a = (p + pair.overA * q) * pair.scale;
  b = (q + pair.overB * p) * pair.scale;
}

/// Two cells of a row, of one colour and linked: in the middle, or across the seam.
class ColumnPair {
 public:
  /// Cells a and b = a + 1, or the last and the first of the row. `swept`: both are.
  ColumnPair(const Level::Pair* pair, float* a, float* b, bool swept)
      : pair_(swept && pair->scale != 0 ? pair : nullptr), a_(a), b_(b) {}
  void keep() {
    if (pair_) wasA_ = *a_, wasB_ = *b_;
  }
  void solve() const {
    if (pair_) solvePair(*a_, *b_, *pair_, wasA_, wasB_);
  }

 private:
  const Level::Pair* pair_;
  float *a_, *b_;
  float wasA_ = 0, wasB_ = 0;  // before the sweep
};

/// Row j's pair in the middle, if it is of this colour and swept. Those of two rows of one colour make four.
template <bool bandOnly>
SMOKEBOX_INLINE ColumnPair middlePair(Level& level, int j, int colour) {
  const int b = level.swapsAt, a = b - 1;
  float* x = level.row(level.x, j);
  return ColumnPair(&level.middlePairs[j], x + a, x + b,
                    b < level.nx && !level.inMiddleRows(j) && !level.inSeamRows(j) &&
                        level.colourOf(b, j) == colour &&
                        (!bandOnly || (level.inBand(a, j) && level.inBand(b, j))));
}

/// The same across the seam; two rows of one colour have none.
template <bool bandOnly>
SMOKEBOX_INLINE ColumnPair seamPair(Level& level, int j, int colour) {
  const int a = level.nx - 1, b = 0;
  float* x = level.row(level.x, j);
  return ColumnPair(&level.seamPairs[j], x + a, x + b,
                    level.hasSeamColumns() && !level.inMiddleRows(j) && !level.inSeamRows(j) &&
                        level.colourOf(b, j) == colour &&
                        (!bandOnly || (level.inBand(a, j) && level.inBand(b, j))));
}

/// What a special unknown's neighbours add up to: along x, then along y, and more than two to one side in
/// float64, so that mirror images (which may keep the same link in a list or in the grid) add up in one
/// order.
struct SpecialSum {
  float x, y;
};

SMOKEBOX_INLINE SpecialSum sumOfStar(const Level::Star& star, const float* values) {
  const auto side = [&](int k) __attribute__((always_inline)) {
    return star.weight[k] * values[star.to[k]] + star.weight[k + 1] * values[star.to[k + 1]];
  };
  return {side(0) + side(2), side(4) + side(6)};
}

inline SpecialSum sumOfLinks(const Level& level, int s) {
  if (level.starred[s]) return sumOfStar(level.star[s], level.x.data());
  double value[4] = {};
  for (int e = level.entryBegin[s]; e < level.entryBegin[s + 1]; ++e) {
    const Level::Entry& entry = level.entries[e];
    value[static_cast<int>(entry.towards)] += static_cast<double>(entry.weight) * level.x[entry.to];
  }
  return {static_cast<float>(value[0]) + static_cast<float>(value[1]),
          static_cast<float>(value[2]) + static_cast<float>(value[3])};
}

/// The values that a sweep gives the special unknowns of a row and colour, into specialValue.
inline void relaxSpecials(Level& level, int j, int colour) {
  const int end = level.specialBegin[2 * j + colour + 1];
  for (int s = level.specialBegin[2 * j + colour]; s < end; ++s) {
    const SpecialSum sum = sumOfLinks(level, s);
    const int at = level.specialAt[s];
    const float value = ((sum.x + sum.y) + level.b[at]) * level.specialInverse[s];
    const float share = level.specialShare[s];
    level.specialValue[s] = share < 1 ? level.x[at] + share * (value - level.x[at]) : value;
  }
}

/// Solves the pairs of a row and colour as one, once both values are found. `start`: the first sweep.
template <bool start>
inline void solveSpecialPairs(Level& level, int j, int colour) {
  const int end = level.specialPairBegin[2 * j + colour + 1];
  for (int k = level.specialPairBegin[2 * j + colour]; k < end; ++k) {
    const Level::SpecialPair& pair = level.specialPairs[k];
    float &a = level.x[level.specialAt[pair.a]], &b = level.x[level.specialAt[pair.b]];
    if (start)
      solvePair(a, b, pairOf(pair.overA, pair.overB), 0, 0);
    else
      solvePair(level.specialValue[pair.a], level.specialValue[pair.b], pairOf(pair.overA, pair.overB), a, b);
  }
}

inline void storeSpecials(Level& level, int j, int colour) {
  for (int s = level.specialBegin[2 * j + colour]; s < level.specialBegin[2 * j + colour + 1]; ++s)
    level.x[level.specialAt[s]] = level.specialValue[s];
}

/// A Gauss-Seidel sweep over one colour of row j, but for the special unknowns in it. bandOnly: only the
/// cells near solids.
template <bool bandOnly>
inline void sweepGrid(Level& level, int j, int colour) {
  const std::vector<int>& begin = bandOnly ? level.bandBegin : level.runBegin;
  float* x = level.row(level.x, j);
  const float* b = level.row(level.b, j);
  const float* ax = level.row(level.ax, j);
  const float* ay = level.row(level.ay, j);
  const float* id = level.row(level.id, j);
  const std::ptrdiff_t stride = level.stride;
  const Level::Run* run = (bandOnly ? level.bandRuns : level.runs).data() + begin[j];
  const Level::Run* end = (bandOnly ? level.bandRuns : level.runs).data() + begin[j + 1];
  ColumnPair middle = middlePair<bandOnly>(level, j, colour), seam = seamPair<bandOnly>(level, j, colour);
  middle.keep();
  seam.keep();
  const std::uint16_t* cells = bandOnly && !level.bandCells.empty()
                                   ? level.bandCells.data() + static_cast<std::size_t>(j) * level.chunks
                                   : nullptr;
  for (; run != end;) {
    Along along(x + run->begin);
    int done = run->begin;
    for (; run != end && run->begin == done; done = run++->end) {
      const LaneMask lanes = lanesOfColour(level, done, j, colour);
      if (!bandOnly && run->kind != kGeneral) {
        sweepRegular(along, x, b, stride, done, run->end, lanes, inverseDiagonal(level, run->kind, j));
        continue;
      }
      for (std::ptrdiff_t i = done, last = run->end; i < last; i += kLanes) {
        along.at(x + i);
        sweepGeneral(along, x + i, b + i, ax + i, ay + i, id + i, stride,
                     cells ? lanes & lanesOfBits(cells[i / kLanes]) : lanes);
      }
    }
  }
  middle.solve();
  seam.solve();
}

/// The same in a plain row.
inline void sweepPlainRow(Level& level, int j, int colour) {
  float* x = level.row(level.x, j);
  const float* b = level.row(level.b, j);
  const std::ptrdiff_t stride = level.stride;
  const int last = level.nx - kLanes, middle = std::min(level.swapsAt, last);
  const Lanes quarter = Lanes{} + 0.25f;
  const LaneMask lanes = lanesOfColour(level, 0, j, colour),
                 beyond = lanesOfColour(level, level.nx - kLanes, j, colour);
  ColumnPair pair = middlePair<false>(level, j, colour);
  pair.keep();
  Along along(x);
  sweepRegular(along, x, b, stride, 0, kLanes, lanes, inverseDiagonal(level, kLeftSide, j));
  sweepRegular(along, x, b, stride, kLanes, middle, lanes, quarter);
  sweepRegular(along, x, b, stride, std::max(middle, kLanes), last, beyond, quarter);
  sweepRegular(along, x, b, stride, last, last + kLanes, beyond, inverseDiagonal(level, kRightSide, j));
  pair.solve();
}

/// The same with the special unknowns: those and the others of their colour see each other's old values.
template <bool bandOnly>
inline void sweepRow(Level& level, int j, int colour) {
  if (!bandOnly && (level.rowKind[j] & Level::kPlain)) {
    sweepPlainRow(level, j, colour);
    return;
  }
  const std::vector<int>& begin = bandOnly ? level.bandBegin : level.runBegin;
  if (begin[j] == begin[j + 1]) return;  // special unknowns are in the band
  relaxSpecials(level, j, colour);
  solveSpecialPairs<false>(level, j, colour);
  sweepGrid<bandOnly>(level, j, colour);
  storeSpecials(level, j, colour);
  level.wrapRow(level.row(level.x, j));
}

/// The first sweep (red) from the value 0 everywhere: sets the whole row.
inline void startRow(Level& level, int j) {
  float* x = level.row(level.x, j);
  const float* b = level.row(level.b, j);
  const float* id = level.row(level.id, j);
  const bool large = level.large();
  const Lanes zero = {};
  for (int r = level.runBegin[j]; r < level.runBegin[j + 1]; ++r) {
    const Level::Run& run = level.runs[r];
    const LaneMask lanes = lanesOfColour(level, run.begin, j, 0);
    if (large)
      for (int i = run.begin; i < run.end; i += kLanes)
        expect(b + i + level.stride), expect(x + i + level.stride);
    if (run.kind != kGeneral) {
      const Lanes inverse = inverseDiagonal(level, run.kind, j);
      for (int i = run.begin; i < run.end; i += kLanes)
        store(x + i, select(lanes, load(b + i) * inverse, zero));
    } else {
      for (int i = run.begin; i < run.end; i += kLanes)
        store(x + i, select(lanes, load(b + i) * load(id + i), zero));
    }
  }
  middlePair<false>(level, j, 0).solve();
  seamPair<false>(level, j, 0).solve();
  for (int s = level.specialBegin[2 * j]; s < level.specialBegin[2 * j + 1]; ++s)
    level.x[level.specialAt[s]] =
        level.b[level.specialAt[s]] * level.specialInverse[s] * level.specialShare[s];
  for (int s = level.specialBegin[2 * j + 1]; s < level.specialBegin[2 * j + 2]; ++s)
    level.x[level.specialAt[s]] = 0;
  level.wrapRow(x);
}

/// Two rows of one colour that are neighbours, in the middle of mirrored colours or across the seam: what
/// they held before a sweep of one colour, and its end: each pair of cells above each other is solved as one,
/// from what the sweep made of each with the old value of the other; and so are the four cells in the middle
/// of the rows, all of one colour.
class RowPair {
 public:
  static RowPair middle(Level& level) { return RowPair(level, level.swapsAtRow - 1, level.swapsAtRow, 0); }
  static RowPair seam(Level& level) { return RowPair(level, level.ny - 1, 0, 3); }

  /// Both rows in one sweep. `start`: the first sweep, from the value 0.
  template <bool bandOnly, bool start = false>
  void sweep(int colour) {
    if constexpr (start) {
      startRow(level_, lower_);
      startRow(level_, upper_);
      solveSpecialPairs<true>(level_, lower_, 0);
      solveSpecialPairs<true>(level_, upper_, 0);
      std::fill_n(old(0), width(), 0.0f);
      std::fill_n(old(1), width(), 0.0f);
    } else {
      float *below = level_.row(level_.x, lower_) - 1, *above = level_.row(level_.x, upper_) - 1;
      std::copy_n(below, width(), old(0));
      std::copy_n(above, width(), old(1));
      relaxSpecials(level_, lower_, colour);
      relaxSpecials(level_, upper_, colour);
      solveSpecialPairs<false>(level_, lower_, colour);
      solveSpecialPairs<false>(level_, upper_, colour);
      sweepGrid<bandOnly>(level_, lower_, colour);
      std::copy_n(below, width(), old(2));
      std::copy_n(old(0), width(), below);
      sweepGrid<bandOnly>(level_, upper_, colour);
      std::copy_n(old(2), width(), below);
      storeSpecials(level_, lower_, colour);
      storeSpecials(level_, upper_, colour);
    }
    join<bandOnly>(colour);
  }

 private:
  RowPair(Level& level, int lower, int upper, int scratch)
      : level_(level), upper_(upper), lower_(lower), scratch_(scratch) {}
  int width() const { return level_.nx + 2; }
  /// Scratch of the level: a row with its copies beyond the sides.
  float* old(int k) { return level_.middle.data() + (scratch_ + k) * (width() + kLanes); }

  template <bool bandOnly>
  void join(int colour) {
    float *below = level_.row(level_.x, lower_), *above = level_.row(level_.x, upper_);
    const float *wasBelow = old(0) + 1, *wasAbove = old(1) + 1, *link = level_.row(level_.ay, upper_);
    const float *idBelow = level_.row(level_.id, lower_), *idAbove = level_.row(level_.id, upper_);
    const std::uint8_t *kindBelow = level_.chunkRow(lower_), *kindAbove = level_.chunkRow(upper_);
    for (int c = 0; c < level_.chunks; ++c) {
      if (bandOnly ? !(kindBelow[c] & kindAbove[c] & kBand) : ((kindBelow[c] | kindAbove[c]) & kEmpty) != 0)
        continue;
      const int first = c * kLanes, last = std::min(level_.nx, first + kLanes);
      for (int i = first; i < last; ++i) {
        if (level_.colourOf(i, lower_) != colour) continue;
        if (i == level_.swapsAt || i == level_.swapsAt - 1) continue;
        if (bandOnly && !(level_.inBand(i, lower_) && level_.inBand(i, upper_))) continue;
        solvePair(below[i], above[i], pairOf(link[i] * idBelow[i], link[i] * idAbove[i]), wasBelow[i],
                  wasAbove[i]);
      }
    }
    if (level_.swapsAt < level_.nx && level_.colourOf(level_.swapsAt, lower_) == colour) {
      bool swept = true;
      for (int k = 0; k < 4 && bandOnly; ++k)
        swept &= level_.inBand(level_.swapsAt - (k & 1), k < 2 ? lower_ : upper_);
      if (swept) solveFour(below, above, wasBelow, wasAbove);
    }
    level_.wrapRow(below);
    level_.wrapRow(above);
  }

  /// The four cells 0 1 / 2 3 (below, above) in the middle, in a ring, from what Jacobi's step has made of
  /// each. Two that are not linked are found by eliminating the other two, and those by eliminating these:
  /// mirror images do the same.
  void solveFour(float* below, float* above, const float* wasBelow, const float* wasAbove) const {
    // Just off the diagonal, so that four cells without another link (then their sum is 0) can be solved.
    constexpr float kOff = 1 / (1 + 1.0f / 64);
    const int b = level_.swapsAt, a = b - 1;
    float* const cell[4] = {below + a, below + b, above + a, above + b};
    const float was[4] = {wasBelow[a], wasBelow[b], wasAbove[a], wasAbove[b]};
    const std::ptrdiff_t low = level_.at(a, lower_), high = level_.at(a, upper_);
    const float id[4] = {level_.id[low], level_.id[low + 1], level_.id[high], level_.id[high + 1]};
    if (id[0] < 0 || id[1] < 0 || id[2] < 0 || id[3] < 0) {  // special ones: half way is safe for the others
      for (int k = 0; k < 4; ++k)
        if (id[k] > 0) *cell[k] = 0.5f * (*cell[k] + was[k]);
      return;
    }
    const float under = level_.ax[low + 1], over = level_.ax[high + 1], left = level_.ay[high],
                right = level_.ay[high + 1];
    float change[4], along[4], up[4];  // Jacobi's; the link to the cell beside it, and above or below it
    for (int k = 0; k < 4; ++k) {
      change[k] = kOff * (*cell[k] - was[k]);
      along[k] = kOff * (k < 2 ? under : over) * id[k];
      up[k] = kOff * (k % 2 == 0 ? left : right) * id[k];
    }
    for (int p = 0; p < 2; ++p) {
      // q lies across from p; r beside p and above or below q, s the other way round.
      const int q = 3 - p, r = p ^ 1, s = p ^ 2;
      const float ownP = 1 - (along[p] * along[r] + up[p] * up[s]),
                  ownQ = 1 - (along[q] * along[s] + up[q] * up[r]);
      const float pq = along[p] * up[r] + up[p] * along[s], qp = along[q] * up[s] + up[q] * along[r];
      const float rightP = change[p] + (along[p] * change[r] + up[p] * change[s]),
                  rightQ = change[q] + (along[q] * change[s] + up[q] * change[r]);
      const float scale = 1 / (ownP * ownQ - pq * qp);
      *cell[p] = was[p] + (ownQ * rightP + pq * rightQ) * scale;
      *cell[q] = was[q] + (ownP * rightQ + qp * rightP) * scale;
    }
  }

  Level& level_;
  int upper_, lower_, scratch_;
};

}  // namespace smokebox::multigrid
