// Coarse blocks and their parts: which unknowns of the finer level make which of the coarser one.
#include <algorithm>
#include <bit>

#include "fluid/multigrid_build.h"
#include "fluid/multigrid_kernels.h"

namespace smokebox::multigrid {

namespace {

/// A bit for each block of chunk `c` that is inside the grid.
unsigned columnsOf(const Level& level, int c) { return (1u << std::min(kLanes, level.nx - c * kLanes)) - 1; }

int firstExtra(const Level& level, int i, int j) {
  return level.extras ? level.extraBase[j * level.nx + i] : -1;
}

// The blocks of a chunk's columns I to I + 15, paired from fine column i on, that cover more than one part.
// Bit k: block I + k.
unsigned dividedPairs(const Level& fine, int i, int j, bool upper) {
  // Rows end with room for one more chunk only: the second half of the last pair may lie beyond it.
  const bool pair = i + kLanes < fine.chunks * kLanes;
  const Lanes zero = {};
  const LaneMask none = {};
  const auto evenOf = [&](const Floats& f, int row) __attribute__((always_inline)) {
    const float* p = fine.row(f, row) + i;
    return evenLanes(load(p), pair ? load(p + kLanes) : zero);
  };
  const auto oddOf = [&](const Floats& f, int row) __attribute__((always_inline)) {
    const float* p = fine.row(f, row) + i;
    return oddLanes(load(p), pair ? load(p + kLanes) : zero);
  };
  // Trees that the blocks' cells and the links inside them make: cells minus links, one more for a closed
  // ring.
  LaneMask count = (evenOf(fine.id, j) != 0.0f) + (oddOf(fine.id, j) != 0.0f);
  const LaneMask lower = (oddOf(fine.id, j) != 0.0f) & (oddOf(fine.ax, j) > 0.0f);
  LaneMask links = lower, ring = none;
  if (upper) {
    const LaneMask topRight = oddOf(fine.id, j + 1) != 0.0f;
    count += (evenOf(fine.id, j + 1) != 0.0f) + topRight;
    const LaneMask top = topRight & (oddOf(fine.ax, j + 1) > 0.0f);
    const LaneMask left = evenOf(fine.ay, j + 1) > 0.0f, right = topRight & (oddOf(fine.ay, j + 1) > 0.0f);
    links += top + left + right;
    ring = lower & top & left & right;
  }
  return bitsOf((links - count) - ring > 1);  // a true lane is -1
}

}  // namespace

void Builder::findParts(Level& fine, Level& coarse) {
  coarse.extraCell.clear();
  coarse.extras = 0;
  coarse.extraBase.assign(static_cast<std::size_t>(coarse.nx) * coarse.ny, -1);
  fine.part.resize(static_cast<std::size_t>(fine.nx) * fine.ny + fine.extras);
  fine.prolong.clear();
  fine.split.clear();
  fine.child.clear();
  fine.splitBegin.assign(coarse.ny + 1, 0);
  splitBlocks_.assign(coarse.chunk.size(), 0);
  regularChunk_.assign(coarse.chunk.size(), 0);
  if (slot_.size() < fine.x.size()) slot_.resize(fine.x.size(), -1);

  for (int J = 0; J < coarse.ny; ++J) {
    const int j0 = fine.joinY.begin(J), j1 = fine.joinY.begin(J + 1);
    fine.splitBegin[J] = static_cast<int>(fine.split.size());
    for (auto& list : prolong_) list.clear();
    for (int C = 0; C < coarse.chunks; ++C) {
      const int i0 = fine.joinX.begin(C * kLanes),
                i1 = fine.joinX.begin(std::min((C + 1) * kLanes, coarse.nx));
      std::uint8_t all = kRegular | kEmpty;
      for (int j = j0; j < j1; ++j)
        for (int c = i0 / kLanes; c * kLanes < i1; ++c) all &= fine.chunkRow(j)[c];
      if (all & kEmpty) continue;
      if (all & kRegular) {
        regularChunk_[J * coarse.chunks + C] = j1 - j0 == 2 && i1 - i0 == 2 * kLanes;
        if (regularChunk_[J * coarse.chunks + C]) continue;
      }
      unsigned split = 0;
      for (unsigned left = suspects(fine, coarse, C, J); left != 0; left &= left - 1) {
        const int k = std::countr_zero(left), before = coarse.extras;
        splitBlock(fine, coarse, C * kLanes + k, J);
        split |= static_cast<unsigned>(coarse.extras > before) << k;
      }
      splitBlocks_[J * coarse.chunks + C] = static_cast<std::uint16_t>(split);
    }
    for (int j = j0; j < j1; ++j) {
      fine.prolongBegin[j] = static_cast<int>(fine.prolong.size());
      fine.prolong.insert(fine.prolong.end(), prolong_[j - j0].begin(), prolong_[j - j0].end());
    }
  }
  fine.splitBegin[coarse.ny] = static_cast<int>(fine.split.size());
  fine.prolongBegin[fine.ny] = static_cast<int>(fine.prolong.size());
  coarse.x.resize(coarse.extrasBegin + coarse.extras, 0);
  coarse.b.resize(coarse.extrasBegin + coarse.extras, 0);
  coarse.residualExtra.assign(coarse.extras, 0);
}

// The blocks of a chunk that may cover more than one part, or cover extra unknowns. Bit k: block k of the
// chunk.
unsigned Builder::suspects(const Level& fine, const Level& coarse, int C, int J) {
  const Joining& join = fine.joinX;
  const int j = fine.joinY.begin(J), rows = fine.joinY.begin(J + 1) - j, I = C * kLanes;
  const unsigned columns = columnsOf(coarse, C);
  if (rows > 2) return columns;
  unsigned bits = 0;
  if (I + kLanes <= join.middle) {
    bits = dividedPairs(fine, 2 * I, j, rows > 1);
  } else if (I > join.middle) {
    bits = dividedPairs(fine, 2 * I + join.shift, j, rows > 1);
  } else {
    const unsigned middle = 1u << (join.middle - I);
    bits = middle | (dividedPairs(fine, 2 * I, j, rows > 1) & (middle - 1)) |
           (dividedPairs(fine, 2 * I + join.shift, j, rows > 1) & ~(middle | (middle - 1)));
  }
  if (fine.extras) {
    const int last = join.begin(std::min(I + kLanes, coarse.nx));
    for (int q = j; q < j + rows; ++q)
      for (int i = join.begin(I); i < last; ++i)
        bits |= static_cast<unsigned>(fine.extraBase[q * fine.nx + i] >= 0) << (join.coarse(i) - I);
  }
  return bits & columns;
}

int Builder::findRoot(int member) {
  while (members_[member].root != member)
    member = members_[member].root = members_[members_[member].root].root;
  return member;
}

// The parts of the block (I, J): members are joined along every link between two of them.
void Builder::splitBlock(Level& fine, Level& coarse, int I, int J) {
  const int i0 = fine.joinX.begin(I), j0 = fine.joinY.begin(J);
  const int width = fine.joinX.begin(I + 1) - i0, height = fine.joinY.begin(J + 1) - j0;
  const std::ptrdiff_t origin = fine.at(i0, j0);
  const auto at = [&](int p, int q) { return origin + q * fine.stride + p; };
  const auto linkedRight = [&](int p, int q) { return p + 1 < width && fine.ax[at(p, q) + 1] > 0; };
  const auto linkedUp = [&](int p, int q) { return q + 1 < height && fine.ay[at(p, q) + fine.stride] > 0; };
  int active = 0, links = 0;
  bool hasExtras = false;
  for (int q = 0; q < height; ++q)
    for (int p = 0; p < width; ++p) {
      active += fine.id[at(p, q)] != 0;
      links += linkedRight(p, q) + linkedUp(p, q);
      hasExtras |= firstExtra(fine, i0 + p, j0 + q) >= 0;
    }
  const bool whole = links == (width - 1) * height + width * (height - 1);
  // No more cells than links and one: in blocks of 2x2 and in lines those are connected.
  const bool small = width * height == 4 || width == 1 || height == 1;
  if (!hasExtras && (whole || (small && active - links <= 1))) return;

  // Members are listed from the far corner towards the middle of the grid, so that mirrored blocks make
  // mirrored choices.
  members_.clear();
  const auto add = [&](int unknown, int offset, int child, int row) {
    slot_[offset] = static_cast<int>(members_.size());
    members_.push_back({unknown, offset, child, row, static_cast<int>(members_.size())});
  };
  const auto join = [&](int a, int b) {
    const int ra = findRoot(a), rb = findRoot(b);
    members_[std::max(ra, rb)].root = std::min(ra, rb);
  };
  const bool fromRight = 2 * I + 1 > coarse.nx, fromTop = 2 * J + 1 > coarse.ny;
  const auto forCells = [&](auto&& body) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) body(fromRight ? width - 1 - x : x, fromTop ? height - 1 - y : y);
  };
  forCells([&](int p, int q) {
    if (fine.id[at(p, q)] != 0)
      add((j0 + q) * fine.nx + i0 + p, static_cast<int>(at(p, q)), 4 * (i0 + p) + q, q);
  });
  const int primaries = static_cast<int>(members_.size());
  if (hasExtras)
    forCells([&](int p, int q) {
      const int cell = (j0 + q) * fine.nx + i0 + p;
      const int base = fine.extraBase[cell];
      for (int k = base; k >= 0 && k < fine.extras && fine.extraCell[k] == cell; ++k)
        if (fine.specialInverse[labels_[k]] > 0)
          add(fine.nx * fine.ny + k, static_cast<int>(fine.extrasBegin) + k, ~k, q);
    });
  const auto joinAt = [&](std::ptrdiff_t a, std::ptrdiff_t b) {
    if (slot_[a] >= 0 && slot_[b] >= 0) join(slot_[a], slot_[b]);
  };
  for (int q = 0; q < height; ++q)
    for (int p = 0; p < width; ++p) {
      if (linkedRight(p, q)) joinAt(at(p, q), at(p, q) + 1);
      if (linkedUp(p, q)) joinAt(at(p, q), at(p, q) + fine.stride);
    }
  // Where the block covers a whole period, what meets across the seam is one part too.
  if (fine.periodicX && width == fine.nx)
    for (int q = 0; q < height; ++q)
      if (fine.ax[at(0, q)] > 0) joinAt(at(0, q), at(width - 1, q));
  if (fine.periodicY && height == fine.ny)
    for (int p = 0; p < width; ++p)
      if (fine.ay[at(p, 0)] > 0) joinAt(at(p, 0), at(p, height - 1));
  for (int m = primaries; m < static_cast<int>(members_.size()); ++m) {
    const int s = labels_[members_[m].at - fine.extrasBegin];
    for (int e = fine.entryBegin[s]; e < fine.entryBegin[s + 1]; ++e)
      if (slot_[fine.entries[e].to] >= 0) join(m, slot_[fine.entries[e].to]);
  }
  for (const Member& m : members_) slot_[m.at] = -1;

  // The part with the most members becomes the primary one.
  const int count = static_cast<int>(members_.size());
  sizes_.assign(count, 0);
  for (int m = 0; m < count; ++m) ++sizes_[members_[m].root = findRoot(m)];
  order_.clear();
  for (int m = 0; m < count; ++m)
    if (members_[m].root == m) order_.push_back(m);
  if (order_.empty() || (order_.size() == 1 && !hasExtras)) return;
  const auto largest =
      std::max_element(order_.begin(), order_.end(), [&](int a, int b) { return sizes_[a] < sizes_[b]; });
  std::rotate(order_.begin(), largest, largest + 1);

  const int cell = J * coarse.nx + I;
  if (order_.size() > 1) coarse.extraBase[cell] = coarse.extras;
  for (int p = 0; p < static_cast<int>(order_.size()); ++p) {
    int parent = static_cast<int>(coarse.at(I, J));
    if (p > 0) {
      parent = static_cast<int>(coarse.extrasBegin) + coarse.extras++;
      coarse.extraCell.push_back(cell);
    }
    const int begin = static_cast<int>(fine.child.size());
    for (const Member& m : members_) {
      if (m.root != order_[p]) continue;
      fine.part[m.unknown] = static_cast<std::uint16_t>(p);
      fine.child.push_back(m.child);
      if (p > 0 || m.child < 0) prolong_[m.row].push_back({m.at, parent, 0});
    }
    fine.split.push_back({parent, begin, static_cast<int>(fine.child.size())});
  }
}

}  // namespace smokebox::multigrid
