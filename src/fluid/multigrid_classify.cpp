#include <algorithm>

#include "fluid/multigrid_build.h"
#include "fluid/multigrid_kernels.h"

namespace smokebox::multigrid {

namespace {

constexpr float kSlack = 1e-4f, kAnything = 1e9f;

/// The side that a chunk lies beside, if all its links but those over it are 1 (and the values there 0).
std::uint8_t sideOf(const Level& level, int c, bool whole, Lanes left, Lanes right, const Lanes& below,
                    const Lanes& above) {
  const bool first = c == 0, last = c + 1 == level.chunks;
  if (!whole || first == last || level.periodicX) return kGeneral;
  if (first) setLane(left, 0, 1.0f);
  if (last) setLane(right, kLanes - 1, 1.0f);
  const LaneMask ones = ((left == 1.0f) & (right == 1.0f)) & ((below == 1.0f) & (above == 1.0f));
  return !allLanes(ones) ? kGeneral : first ? kLeftSide : kRightSide;
}

/// Cells a and b, linked over the left face of b.
Level::Pair linkedPair(const Level& level, std::ptrdiff_t a, std::ptrdiff_t b) {
  return pairOf(level.ax[b] * level.id[a], level.ax[b] * level.id[b]);
}

/// Joins a chunk of row j to the run before, if it goes on in the same way.
void addToRuns(const Level& level, int j, const Level::Run& chunk, const std::vector<int>& begin,
               std::vector<Level::Run>& runs) {
  const int middle = level.swapsAt;
  const bool swaps = middle < level.nx && (chunk.begin == middle / kLanes * kLanes ||
                                           chunk.begin == (middle + kLanes - 1) / kLanes * kLanes);
  if (begin[j] < static_cast<int>(runs.size()) && runs.back().end == chunk.begin &&
      runs.back().kind == chunk.kind && !swaps)
    runs.back().end = chunk.end;
  else
    runs.push_back(chunk);
}

std::uint8_t rowKindOf(const Level& level, int j) {
  const auto noBand = [&](int row) { return level.bandBegin[row] == level.bandBegin[row + 1]; };
  const bool pair = level.inMiddleRows(j) && level.hasMiddleRows(), seam = level.inSeamRows(j);
  const int other = pair ? 2 * level.swapsAtRow - 1 - j : seam ? level.ny - 1 - j : j;
  const std::uint8_t band = noBand(j) && noBand(other) ? Level::kNoBand : 0;
  const std::uint8_t* kind = level.chunkRow(j);
  bool plain = !pair && !seam && level.chunks > 1 && level.nx % kLanes == 0 &&
               (level.swapsAt >= level.nx || level.swapsAt % kLanes == 0) && (kind[0] & kLeftSide) &&
               (kind[level.chunks - 1] & kRightSide) &&
               level.specialBegin[2 * j] == level.specialBegin[2 * j + 2];
  unsigned empty = 0;
  for (int c = 0; c < level.chunks; ++c) {
    if (c > 0 && c + 1 < level.chunks) plain = plain && (kind[c] & kRegular);
    empty |= kind[c] & kEmpty;
  }
  return static_cast<std::uint8_t>(band | (plain ? Level::kPlain : 0) | (empty ? Level::kGaps : 0));
}

}  // namespace

// The cells of chunk c that lie in a chunk near a solid, if chunks are counted from the right end of the row.
std::uint16_t Builder::bandCellsOf(const Level& level, int c) const {
  unsigned any = 0, bits = 0;
  for (int k = std::max(0, c - 2); k <= std::min(level.chunks - 1, c + 2); ++k) any |= near_[k];
  if (!any) return 0;
  const int begin = c * kLanes;
  for (int last = level.nx - (level.nx - begin - 1) / kLanes * kLanes; last - kLanes < begin + kLanes;
       last += kLanes) {
    const int first = last - kLanes;
    bool near = false;
    for (int i = std::max(0, first - 2); i < std::min(level.nx, last + 2) && !near; ++i)
      near = (near_[i / kLanes] >> (i % kLanes)) & 1;
    if (!near) continue;
    for (int i = std::max(begin, first); i < std::min({begin + kLanes, last, level.nx}); ++i)
      bits |= 1u << (i - begin);
  }
  return static_cast<std::uint16_t>(bits);
}

// Inverse diagonal, kind of each chunk, and the band along solids.
void Builder::classify(Level& level) {
  disturbed_.assign(level.chunk.size(), 0);
  for (int j = 0; j < level.ny; ++j) {
    const float* ax = level.row(level.ax, j);
    const float* ay = level.row(level.ay, j);
    const float* ayAbove = ay + level.stride;
    float* id = level.row(level.id, j);
    const float high = level.high[j], nearBelow = level.nearY[j], nearAbove = level.nearY[j + 1];
    const float slackBelow = j > 0 ? kSlack : kAnything, slackAbove = j + 1 < level.ny ? kSlack : kAnything;
    for (int c = 0; c < level.chunks; ++c) {
      const int i = c * kLanes, k = j * level.chunks + c;
      const Lanes left = load(ax + i), right = load(ax + i + 1), below = load(ay + i),
                  above = load(ayAbove + i);
      const bool whole = i + kLanes <= level.nx;
      if (whole && allLanes((left == 1.0f) & (right == 1.0f) & (below == 1.0f) & (above == 1.0f))) {
        level.chunk[k] = kRegular;
        std::fill(id + i, id + i + kLanes, 0.25f);
        continue;
      }
      Lanes diagonal = (left + right) + (below + above);
      if (!whole)
        for (int q = level.nx - i; q < kLanes; ++q) setLane(diagonal, q, 0.0f);
      const LaneMask used = diagonal > 0.0f;
      const Lanes zero = {}, one = zero + 1.0f;
      store(id + i, select(used, one / select(used, diagonal, one), zero));
      // Compared with what the links would be without solids; sides of the domain do not count.
      const Lanes wide = load(level.wide.data() + i);
      const auto off =
          [](const Lanes& weight, const Lanes& nominal, const Lanes& slack) __attribute__((always_inline)) {
        return magnitude(weight - nominal) > slack;
      };
      const LaneMask beside =
          off(left, high * load(level.nearX.data() + i), load(level.slackX.data() + i)) |
          off(right, high * load(level.nearX.data() + i + 1), load(level.slackX.data() + i + 1)) |
          off(below, wide * nearBelow, zero + slackBelow) | off(above, wide * nearAbove, zero + slackAbove);
      level.chunk[k] =
          bitsOf(used) ? sideOf(level, c, whole, left, right, below, above) : std::uint8_t{kEmpty};
      disturbed_[k] = static_cast<std::uint16_t>(bitsOf(beside));
    }
  }
  const auto disturb = [&](int i, int j) {
    if (i < 0 || i >= level.nx || j < 0 || j >= level.ny) return;
    std::uint16_t& bits = disturbed_[j * level.chunks + i / kLanes];
    bits = static_cast<std::uint16_t>(bits | (1u << (i % kLanes)));
  };
  for (int cell : level.extraCell) {
    const int i = cell % level.nx, j = cell / level.nx;
    disturb(i, j);
    disturb(i - 1, j);
    disturb(i + 1, j);
    disturb(i, j - 1);
    disturb(i, j + 1);
  }
  for (int s = 0; s < static_cast<int>(level.specialAt.size()); ++s) {
    const int i = level.specialCell[s] % level.nx, j = level.specialCell[s] / level.nx;
    level.chunk[j * level.chunks + i / kLanes] = kGeneral;
    disturb(i, j);
    const int at = level.specialAt[s];
    if (at < level.extrasBegin)
      level.id[at] = -level.specialInverse[s];  // in use, but not by the rows' loops
  }
  near_.assign(level.chunks, 0);
  // Where three columns, or rows, make one, there is more to smooth: the two outer ones as beside solids.
  if (level.joinX.shift > 0 && level.nx > 3)
    for (int j = 0; j < level.ny; ++j) {
      disturb(level.joinX.begin(level.joinX.middle), j);
      disturb(level.joinX.begin(level.joinX.middle + 1) - 1, j);
    }
  if (level.joinY.shift > 0 && level.ny > 3)
    for (int i = 0; i < level.nx; ++i) {
      disturb(i, level.joinY.begin(level.joinY.middle));
      disturb(i, level.joinY.begin(level.joinY.middle + 1) - 1);
    }
  // So do neighbours of one colour where there is no side that the error there would be small against:
  // drifting vortices of 128 cells came out five times less exact without.
  if (level.hasSeamColumns())
    for (int j = 0; j < level.ny; ++j)
      for (const int i : {0, level.swapsAt - 1, level.swapsAt, level.nx - 1}) disturb(i, j);
  if (level.hasSeamRows())
    for (int i = 0; i < level.nx; ++i)
      for (const int j : {0, level.swapsAtRow - 1, level.swapsAtRow, level.ny - 1}) disturb(i, j);
  level.runs.clear();
  level.bandRuns.clear();
  for (int j = 0; j < level.ny; ++j) {
    level.runBegin[j] = static_cast<int>(level.runs.size());
    level.bandBegin[j] = static_cast<int>(level.bandRuns.size());
    for (int c = 0; c < level.chunks; ++c) {
      const int k = j * level.chunks + c;
      unsigned near = disturbed_[k];
      if (j > 0) near |= disturbed_[k - level.chunks];
      if (j + 1 < level.ny) near |= disturbed_[k + level.chunks];
      near_[c] = static_cast<std::uint16_t>(near);
    }
    for (int c = 0; c < level.chunks; ++c) {
      const int k = j * level.chunks + c, i = c * kLanes;
      if (level.chunk[k] & kEmpty) continue;
      const auto kind = static_cast<std::uint8_t>(level.chunk[k] & (kRegular | kLeftSide | kRightSide));
      addToRuns(level, j, {i, i + kLanes, kind}, level.runBegin, level.runs);

      unsigned near = near_[c];
      if (c > 0) near |= near_[c - 1] & 0xc000u;
      if (c + 1 < level.chunks) near |= near_[c + 1] & 0x3u;
      if (!level.bandCells.empty()) {
        level.bandCells[k] = near ? 0xffffu : bandCellsOf(level, c);
        near = level.bandCells[k];
      }
      if (!near) continue;
      level.chunk[k] |= kBand;
      addToRuns(level, j, {i, i + kLanes, kGeneral}, level.bandBegin, level.bandRuns);
    }
    const std::ptrdiff_t first = level.at(0, j), last = level.at(level.nx - 1, j),
                         middle = level.at(level.swapsAt, j);
    level.sideCells[2 * j] = {level.ax[first], level.id[first]};
    level.sideCells[2 * j + 1] = {level.ax[last + 1], level.id[last]};
    if (level.swapsAt < level.nx) level.middlePairs[j] = linkedPair(level, middle - 1, middle);
    if (level.hasSeamColumns()) level.seamPairs[j] = linkedPair(level, last, first);
  }
  level.runBegin[level.ny] = static_cast<int>(level.runs.size());
  level.bandBegin[level.ny] = static_cast<int>(level.bandRuns.size());
  for (int j = 0; j < level.ny; ++j) level.rowKind[j] = rowKindOf(level, j);
}

}  // namespace smokebox::multigrid
