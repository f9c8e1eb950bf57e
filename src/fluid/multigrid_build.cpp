#include "fluid/multigrid_build.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "fluid/multigrid_kernels.h"

namespace smokebox::multigrid {

namespace {

/// A bit for each block of chunk `c` that is inside the grid.
unsigned columnsOf(const Level& level, int c) { return (1u << std::min(kLanes, level.nx - c * kLanes)) - 1; }

Towards opposite(Towards t) { return static_cast<Towards>(static_cast<int>(t) ^ 1); }

struct Cell {
  int i, j;
};

/// The block of an unknown, or of a ghost beyond a side.
Cell cellOf(const Level& level, int at) {
  if (at >= level.extrasBegin) {
    const int cell = level.extraCell[at - level.extrasBegin];
    return {cell % level.nx, cell / level.nx};
  }
  const int shifted = static_cast<int>(at - level.origin + level.stride + 1);  // ghosts at -1 become 0
  const int j = shifted / static_cast<int>(level.stride);
  return {shifted - j * static_cast<int>(level.stride) - 1, j - 1};
}

int firstExtra(const Level& level, int i, int j) {
  return level.extras ? level.extraBase[j * level.nx + i] : -1;
}

/// Offset into the coarse x of the unknown that block (i, j)'s unknown number `unknown` belongs to.
int parentOf(const Level& fine, const Level& coarse, int i, int j, int unknown) {
  const int base = coarse.extraBase[(j / 2) * coarse.nx + i / 2];
  const int part = base < 0 ? 0 : fine.part[unknown];
  return static_cast<int>(part == 0 ? coarse.at(i / 2, j / 2) : coarse.extrasBegin + base + part - 1);
}

int parentOf(const Level& fine, const Level& coarse, int i, int j) {
  return parentOf(fine, coarse, i, j, j * fine.nx + i);
}

void clear(Level& level) {
  std::fill(level.x.begin(), level.x.end(), 0.0f);
  std::fill(level.b.begin(), level.b.end(), 0.0f);
}

}  // namespace

int parentOf(const Level& fine, const Level& coarse, int at) {
  const Cell c = cellOf(fine, at);
  const int unknown = at >= fine.extrasBegin ? static_cast<int>(fine.nx * fine.ny + (at - fine.extrasBegin))
                                             : c.j * fine.nx + c.i;
  return parentOf(fine, coarse, c.i, c.j, unknown);
}

void Builder::finest(const Boundary& boundary, Level& level) {
  clear(level);
  const int nx = level.nx, ny = level.ny;
  for (int j = 0; j <= ny; ++j) {
    float* ay = level.row(level.ay, j);
    std::copy_n(boundary.openY.row(level.periodicY && j == ny ? 0 : j), nx, ay);
    if (j == ny) break;
    float* ax = level.row(level.ax, j);
    std::copy_n(boundary.openX.row(j), nx + 1, ax);
    if (level.periodicX) ax[nx] = ax[0];
  }
  raw_.clear();
  chooseColours(level);
  listSpecials(level);
  classify(level);
}

void Builder::coarsen(Level& fine, Level& coarse) {
  clear(coarse);
  findParts(fine, coarse);
  linkGrid(fine, coarse);
  linkLists(fine, coarse);
  chooseColours(coarse);
  listSpecials(coarse);
  classify(coarse);
}

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
    fine.splitBegin[J] = static_cast<int>(fine.split.size());
    for (auto& list : prolong_) list.clear();
    for (int C = 0; C < coarse.chunks; ++C) {
      std::uint8_t all = kRegular | kEmpty;
      for (int q = 0; q < 2 && 2 * J + q < fine.ny; ++q)
        for (int c = 2 * C; c < 2 * C + 2 && c < fine.chunks; ++c) all &= fine.chunkRow(2 * J + q)[c];
      if (all & kEmpty) continue;
      if ((all & kRegular) && 2 * J + 1 < fine.ny && 2 * C + 1 < fine.chunks) {
        regularChunk_[J * coarse.chunks + C] = 1;
        continue;
      }
      unsigned split = 0;
      for (unsigned left = suspects(fine, coarse, C, J); left != 0; left &= left - 1) {
        const int k = std::countr_zero(left), before = coarse.extras;
        splitBlock(fine, coarse, C * kLanes + k, J);
        split |= static_cast<unsigned>(coarse.extras > before) << k;
      }
      splitBlocks_[J * coarse.chunks + C] = static_cast<std::uint16_t>(split);
    }
    for (int q = 0; q < 2 && 2 * J + q < fine.ny; ++q) {
      fine.prolongBegin[2 * J + q] = static_cast<int>(fine.prolong.size());
      fine.prolong.insert(fine.prolong.end(), prolong_[q].begin(), prolong_[q].end());
    }
  }
  fine.splitBegin[coarse.ny] = static_cast<int>(fine.split.size());
  fine.prolongBegin[fine.ny] = static_cast<int>(fine.prolong.size());
  coarse.x.resize(coarse.extrasBegin + coarse.extras, 0);
  coarse.b.resize(coarse.extrasBegin + coarse.extras, 0);
  coarse.residualExtra.assign(coarse.extras, 0);
}

// The blocks of a chunk that cover more than one part, or extra unknowns. Bit k: block k of the chunk.
unsigned Builder::suspects(const Level& fine, const Level& coarse, int C, int J) {
  const LaneMask even = {0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30};
  const LaneMask odd = even + 1;
  const bool pair = 2 * C + 1 < fine.chunks;
  const int i = 2 * C * kLanes, j = 2 * J;
  const Lanes zero = {};
  const LaneMask none = {};
  const auto of = [&](const Floats& f, int row, const LaneMask& which) __attribute__((always_inline)) {
    const float* p = fine.row(f, row) + i;
    return __builtin_shuffle(load(p), pair ? load(p + kLanes) : zero, which);
  };
  // Trees that the blocks' cells and the links inside them make: cells minus links, one more for a closed
  // ring.
  const bool upper = j + 1 < fine.ny;
  LaneMask count = (of(fine.id, j, even) != 0.0f) + (of(fine.id, j, odd) != 0.0f);
  const LaneMask lower = (of(fine.id, j, odd) != 0.0f) & (of(fine.ax, j, odd) > 0.0f);
  LaneMask links = lower, ring = none;
  if (upper) {
    const LaneMask topRight = of(fine.id, j + 1, odd) != 0.0f;
    count += (of(fine.id, j + 1, even) != 0.0f) + topRight;
    const LaneMask top = topRight & (of(fine.ax, j + 1, odd) > 0.0f);
    const LaneMask left = of(fine.ay, j + 1, even) > 0.0f,
                   right = topRight & (of(fine.ay, j + 1, odd) > 0.0f);
    links += top + left + right;
    ring = lower & top & left & right;
  }
  unsigned bits = bitsOf((links - count) - ring > 1);  // a true lane is -1
  if (fine.extras) {
    const int columns = std::min(2 * kLanes, fine.nx - i);
    for (int q = 0; q < (upper ? 2 : 1); ++q) {
      const int* base = fine.extraBase.data() + (j + q) * fine.nx + i;
      for (int k = 0; k < columns; ++k) bits |= static_cast<unsigned>(base[k] >= 0) << (k / 2);
    }
  }
  return bits & columnsOf(coarse, C);
}

int Builder::findRoot(int member) {
  while (members_[member].root != member)
    member = members_[member].root = members_[members_[member].root].root;
  return member;
}

// The parts of the block (I, J): members are joined along every link between two of them.
void Builder::splitBlock(Level& fine, Level& coarse, int I, int J) {
  const int i0 = 2 * I, j0 = 2 * J;
  const bool right = i0 + 1 < fine.nx, upper = j0 + 1 < fine.ny;
  const std::ptrdiff_t o = fine.at(i0, j0), above = o + fine.stride;
  const int active = (fine.id[o] != 0 ? 1 : 0) | (right && fine.id[o + 1] != 0 ? 2 : 0) |
                     (upper && fine.id[above] != 0 ? 4 : 0) |
                     (right && upper && fine.id[above + 1] != 0 ? 8 : 0);
  const int links = (right && fine.ax[o + 1] > 0 ? 1 : 0) | (upper && fine.ay[above] > 0 ? 2 : 0) |
                    (right && upper && fine.ax[above + 1] > 0 ? 4 : 0) |
                    (right && upper && fine.ay[above + 1] > 0 ? 8 : 0);
  bool hasExtras = false;
  if (fine.extras)
    for (int q = 0; q < (upper ? 2 : 1); ++q)
      for (int p = 0; p < (right ? 2 : 1); ++p) hasExtras |= firstExtra(fine, i0 + p, j0 + q) >= 0;
  const int trees =
      std::popcount(static_cast<unsigned>(active)) - std::popcount(static_cast<unsigned>(links));
  if (!hasExtras && (links == 15 || trees <= 1)) return;

  members_.clear();
  const auto add = [&](int unknown, int at, int child, int up) {
    slot_[at] = static_cast<int>(members_.size());
    members_.push_back({unknown, at, child, up, static_cast<int>(members_.size())});
  };
  const auto join = [&](int a, int b) {
    const int ra = findRoot(a), rb = findRoot(b);
    members_[std::max(ra, rb)].root = std::min(ra, rb);
  };
  for (int q = 0; q < 2; ++q)
    for (int p = 0; p < 2; ++p)
      if (active & (1 << (2 * q + p)))
        add((j0 + q) * fine.nx + i0 + p, static_cast<int>(fine.at(i0 + p, j0 + q)), 2 * (i0 + p) + q, q);
  const int primaries = static_cast<int>(members_.size());
  if (hasExtras) {
    for (int q = 0; q < (upper ? 2 : 1); ++q)
      for (int p = 0; p < (right ? 2 : 1); ++p) {
        const int cell = (j0 + q) * fine.nx + i0 + p;
        const int base = fine.extraBase[cell];
        for (int k = base; k >= 0 && k < fine.extras && fine.extraCell[k] == cell; ++k)
          if (fine.specialInverse[labels_[k]] > 0)
            add(fine.nx * fine.ny + k, static_cast<int>(fine.extrasBegin) + k, ~k, q);
      }
  }
  const auto joinAt = [&](std::ptrdiff_t a, std::ptrdiff_t b) {
    if (slot_[a] >= 0 && slot_[b] >= 0) join(slot_[a], slot_[b]);
  };
  if (links & 1) joinAt(o, o + 1);
  if (links & 2) joinAt(o, above);
  if (links & 4) joinAt(above, above + 1);
  if (links & 8) joinAt(o + 1, above + 1);
  // Where the block covers a whole period, what meets across the seam is one part too.
  if (fine.periodicX && fine.nx == 2)
    for (int q = 0; q < (upper ? 2 : 1); ++q)
      if (fine.ax[o + q * fine.stride] > 0) joinAt(o + q * fine.stride, o + q * fine.stride + 1);
  if (fine.periodicY && fine.ny == 2)
    for (int p = 0; p < (right ? 2 : 1); ++p)
      if (fine.ay[o + p] > 0) joinAt(o + p, above + p);
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
  if (order_.empty()) return;
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
      if (p > 0 || m.child < 0) prolong_[m.upper].push_back({m.at, parent, 0});
    }
    fine.split.push_back({parent, begin, static_cast<int>(fine.child.size())});
  }
}

void Builder::linkLeft(const Level& fine, Level& coarse, int I, int J) {
  const bool atLeft = I == 0, atRight = I == coarse.nx;
  float* target = coarse.row(coarse.ax, J) + I;
  *target = 0;
  if (coarse.periodicX && (atRight || coarse.nx == 1)) return;  // copied from the left side; a link to itself
  const int i = atRight ? fine.nx : 2 * I;
  const float factor = static_cast<float>(fine.distanceX[i] / coarse.distanceX[I]);
  const int leftColumn = atLeft ? (coarse.periodicX ? fine.nx - 1 : -1) : i - 1;
  float sum = 0;
  for (int j = 2 * J; j < std::min(2 * J + 2, fine.ny); ++j) {
    const float w = fine.row(fine.ax, j)[i];
    if (!(w > 0)) continue;
    const int a = atRight ? static_cast<int>(coarse.at(I, J)) : parentOf(fine, coarse, i, j);
    const int b = leftColumn < 0 ? static_cast<int>(coarse.at(-1, J)) : parentOf(fine, coarse, leftColumn, j);
    if (a < coarse.extrasBegin && b < coarse.extrasBegin)
      sum += w;
    else if (atRight)
      raw_.push_back({b, a, w * factor, Towards::right, true});
    else
      raw_.push_back({a, b, w * factor, Towards::left, leftColumn < 0});
  }
  *target = sum * factor;
}

void Builder::linkBelow(const Level& fine, Level& coarse, int I, int J) {
  const bool atBottom = J == 0, atTop = J == coarse.ny;
  float* target = coarse.row(coarse.ay, J) + I;
  *target = 0;
  if (coarse.periodicY && (atTop || coarse.ny == 1)) return;
  const int j = atTop ? fine.ny : 2 * J;
  const float factor = static_cast<float>(fine.distanceY[j] / coarse.distanceY[J]);
  const int rowBelow = atBottom ? (coarse.periodicY ? fine.ny - 1 : -1) : j - 1;
  float sum = 0;
  for (int i = 2 * I; i < std::min(2 * I + 2, fine.nx); ++i) {
    const float w = fine.row(fine.ay, j)[i];
    if (!(w > 0)) continue;
    const int a = atTop ? static_cast<int>(coarse.at(I, J)) : parentOf(fine, coarse, i, j);
    const int b = rowBelow < 0 ? static_cast<int>(coarse.at(I, -1)) : parentOf(fine, coarse, i, rowBelow);
    if (a < coarse.extrasBegin && b < coarse.extrasBegin)
      sum += w;
    else if (atTop)
      raw_.push_back({b, a, w * factor, Towards::up, true});
    else
      raw_.push_back({a, b, w * factor, Towards::down, rowBelow < 0});
  }
  *target = sum * factor;
}

void Builder::fillRegular(Level& coarse, int C, int J) {
  const Lanes zero = {};
  store(coarse.row(coarse.ax, J) + C * kLanes, zero + 1.0f);
  store(coarse.row(coarse.ay, J) + C * kLanes, zero + 1.0f);
}

// The left and lower faces of a chunk, as they are where neither it nor its neighbours have extra unknowns.
void Builder::linkWhole(const Level& fine, Level& coarse, int C, int J) {
  const LaneMask even = {0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30};
  const LaneMask odd = even + 1;
  const int I = C * kLanes, i = 2 * I, j = 2 * J;
  const float* ax = fine.row(fine.ax, j) + i;
  const float* ay = fine.row(fine.ay, j) + i;
  // Rows end with room for one more chunk only: the second half of the last pair may lie beyond it.
  const bool pair = 2 * C + 1 < fine.chunks;
  const Lanes zero = {};
  Lanes first = load(ax), second = pair ? load(ax + kLanes) : zero;
  if (j + 1 < fine.ny) {
    first += load(ax + fine.stride);
    if (pair) second += load(ax + fine.stride + kLanes);
  }
  const Lanes below = load(ay), belowNext = pair ? load(ay + kLanes) : zero;
  const Lanes left = __builtin_shuffle(first, second, even) * load(factorX_.data() + I);
  const bool self = coarse.periodicY && coarse.ny == 1;
  const float factorY = self ? 0.0f : static_cast<float>(fine.distanceY[j] / coarse.distanceY[J]);
  const Lanes down =
      (__builtin_shuffle(below, belowNext, even) + __builtin_shuffle(below, belowNext, odd)) * factorY;
  store(coarse.row(coarse.ax, J) + I, left);
  store(coarse.row(coarse.ay, J) + I, down);
}

// Links that cross a face of the coarse grid and are kept in the fine grid.
void Builder::linkGrid(const Level& fine, Level& coarse) {
  raw_.clear();
  factorX_.assign(static_cast<std::size_t>(coarse.chunks) * kLanes, 0);
  for (int I = 0; I < coarse.nx; ++I)
    factorX_[I] = static_cast<float>(fine.distanceX[2 * I] / coarse.distanceX[I]);
  if (coarse.periodicX && coarse.nx == 1) factorX_[0] = 0;  // a link to itself
  for (int J = 0; J < coarse.ny; ++J) {
    const std::uint16_t* split = splitBlocks_.data() + J * coarse.chunks;
    const std::uint16_t* below = J > 0              ? split - coarse.chunks
                                 : coarse.periodicY ? splitBlocks_.data() + (coarse.ny - 1) * coarse.chunks
                                                    : nullptr;
    for (int C = 0; C < coarse.chunks; ++C) {
      if (C > 0 && J > 0 && regularChunk_[J * coarse.chunks + C])
        fillRegular(coarse, C, J);
      else
        linkWhole(fine, coarse, C, J);
      // Faces beside a split block are done one by one.
      unsigned beforeFirst = 0;
      if (C > 0)
        beforeFirst = split[C - 1] >> (kLanes - 1);
      else if (coarse.periodicX)
        beforeFirst = coarse.extraBase[J * coarse.nx + coarse.nx - 1] >= 0;
      const unsigned here = split[C], columns = columnsOf(coarse, C);
      for (unsigned left = (here | (here << 1) | beforeFirst) & columns; left != 0; left &= left - 1)
        linkLeft(fine, coarse, C * kLanes + std::countr_zero(left), J);
      for (unsigned left = (here | (below ? below[C] : 0u)) & columns; left != 0; left &= left - 1)
        linkBelow(fine, coarse, C * kLanes + std::countr_zero(left), J);
    }
    linkLeft(fine, coarse, coarse.nx, J);
  }
  for (int I = 0; I < coarse.nx; ++I) linkBelow(fine, coarse, I, coarse.ny);
}

// Links that cross a face of the coarse grid and are kept in the fine level's lists.
void Builder::linkLists(const Level& fine, Level& coarse) {
  for (int s = 0; s < static_cast<int>(fine.specialAt.size()); ++s) {
    const int i = fine.specialCell[s] % fine.nx, j = fine.specialCell[s] / fine.nx;
    for (int e = fine.entryBegin[s]; e < fine.entryBegin[s + 1]; ++e) {
      const Level::Entry& entry = fine.entries[e];
      if (!entry.listed) continue;
      // Each link once: from its right or upper end; those to a ghost have no other end.
      const Towards t = entry.towards;
      bool ghost = false, crosses = false;
      int face = 0, ghostAt = 0;
      double factor = 0;
      if (t == Towards::left) {
        ghost = i == 0 && !fine.periodicX;
        crosses = i % 2 == 0 && !(coarse.periodicX && coarse.nx == 1);
        face = i / 2;
        factor = fine.distanceX[i] / coarse.distanceX[face];
        ghostAt = static_cast<int>(coarse.at(-1, j / 2));
      } else if (t == Towards::down) {
        ghost = j == 0 && !fine.periodicY;
        crosses = j % 2 == 0 && !(coarse.periodicY && coarse.ny == 1);
        face = j / 2;
        factor = fine.distanceY[j] / coarse.distanceY[face];
        ghostAt = static_cast<int>(coarse.at(i / 2, -1));
      } else if (t == Towards::right) {
        ghost = crosses = i == fine.nx - 1 && !fine.periodicX;
        face = coarse.nx;
        factor = fine.distanceX[fine.nx] / coarse.distanceX[face];
        ghostAt = static_cast<int>(coarse.at(coarse.nx, j / 2));
      } else {
        ghost = crosses = j == fine.ny - 1 && !fine.periodicY;
        face = coarse.ny;
        factor = fine.distanceY[fine.ny] / coarse.distanceY[face];
        ghostAt = static_cast<int>(coarse.at(i / 2, coarse.ny));
      }
      if (!crosses) continue;
      const int a = parentOf(fine, coarse, fine.specialAt[s]);
      const int b = ghost ? ghostAt : parentOf(fine, coarse, entry.to);
      const float weight = entry.weight * static_cast<float>(factor);
      if (a >= coarse.extrasBegin || b >= coarse.extrasBegin)
        raw_.push_back({a, b, weight, t, ghost});
      else if (t == Towards::left || t == Towards::right)
        coarse.row(coarse.ax, j / 2)[face] += weight;
      else
        coarse.row(coarse.ay, face)[i / 2] += weight;
    }
  }
  if (coarse.periodicX)
    for (int J = 0; J < coarse.ny; ++J) coarse.row(coarse.ax, J)[coarse.nx] = coarse.row(coarse.ax, J)[0];
  if (coarse.periodicY) std::copy_n(coarse.row(coarse.ay, 0), coarse.nx, coarse.row(coarse.ay, coarse.ny));
}

// In the middle of mirrored colours two columns, or two rows, have one colour; a sweep solves each such pair
// as one. Where a pair has no other link, and where blocks are split there, the colours go on as everywhere.
void Builder::chooseColours(Level& level) {
  const int column = level.nx / 2, row = level.ny / 2;
  bool mirrorX = level.nx % 2 == 0 && !level.periodicX, mirrorY = level.ny % 2 == 0 && !level.periodicY;
  const auto split = [&](int at) {
    if (at >= level.extrasBegin)
      at = static_cast<int>(level.at(level.extraCell[at - level.extrasBegin] % level.nx,
                                     level.extraCell[at - level.extrasBegin] / level.nx));
    const Cell c = cellOf(level, at);
    mirrorX &= c.i != column && c.i != column - 1;
    mirrorY &= c.j != row && c.j != row - 1;
  };
  for (const Raw& link : raw_) {
    split(link.a);
    if (!link.ghost) split(link.b);
  }
  const auto linkedElsewhere = [&](std::ptrdiff_t a, std::ptrdiff_t b, float link) {
    constexpr float kMost = 0.99f;
    const auto sum = [&](std::ptrdiff_t at) {
      return (level.ax[at] + level.ax[at + 1]) + (level.ay[at] + level.ay[at + level.stride]);
    };
    return !(link > 0) || (link <= kMost * sum(a) && link <= kMost * sum(b));
  };
  for (int j = 0; j < level.ny && mirrorX; ++j) {
    const std::ptrdiff_t b = level.at(column, j);
    mirrorX = linkedElsewhere(b - 1, b, level.ax[b]);
  }
  for (int i = 0; i < level.nx && mirrorY; ++i) {
    const std::ptrdiff_t b = level.at(i, row);
    mirrorY = linkedElsewhere(b - level.stride, b, level.ay[b]);
  }
  level.swapsAt = mirrorX ? column : level.chunks * kLanes + kLanes;
  level.swapsAtRow = mirrorY ? row : level.ny + 1;
}

// Sorts the special unknowns by row and colour, and gathers their links; parallel links become one.
void Builder::listSpecials(Level& level) {
  if (slot_.size() < level.x.size()) slot_.resize(level.x.size(), -1);
  specials_.clear();
  const auto mark = [&](int at) {
    if (slot_[at] >= 0) return;
    slot_[at] = 0;
    specials_.push_back(at);
  };
  for (int k = 0; k < level.extras; ++k) mark(static_cast<int>(level.extrasBegin) + k);
  for (const Raw& link : raw_) {
    mark(link.a);
    if (!link.ghost) mark(link.b);
  }
  const int count = static_cast<int>(specials_.size());
  level.specialAt.resize(count);
  level.specialCell.resize(count);
  level.specialInverse.assign(count, 0);
  level.specialValue.assign(count, 0);
  level.specialBegin.assign(2 * level.ny + 1, 0);
  const auto key = [&](int at) {
    const Cell c = cellOf(level, at);
    return 2 * c.j + level.colourOf(c.i, c.j);
  };
  for (int at : specials_) ++level.specialBegin[key(at) + 1];
  for (int k = 0; k < 2 * level.ny; ++k) level.specialBegin[k + 1] += level.specialBegin[k];
  counts_.assign(level.specialBegin.begin(), level.specialBegin.end());
  for (int at : specials_) {
    const int s = counts_[key(at)]++;
    const Cell c = cellOf(level, at);
    slot_[at] = s;
    level.specialAt[s] = at;
    level.specialCell[s] = c.j * level.nx + c.i;
  }

  // Room for every link, then without the gaps.
  counts_.assign(count + 1, 0);
  for (const Raw& link : raw_) {
    ++counts_[slot_[link.a] + 1];
    if (!link.ghost) ++counts_[slot_[link.b] + 1];
  }
  for (int s = 0; s < count; ++s) counts_[s + 1] += counts_[s];
  entries_.resize(counts_[count]);
  used_.assign(count, 0);
  const auto insert = [&](int s, int to, float weight, Towards towards) {
    Level::Entry* begin = entries_.data() + counts_[s];
    for (int k = 0; k < used_[s]; ++k)
      if (begin[k].to == to && begin[k].towards == towards) {
        begin[k].weight += weight;
        return;
      }
    begin[used_[s]++] = {to, weight, towards, true};
  };
  for (const Raw& link : raw_) {
    insert(slot_[link.a], link.b, link.weight, link.towards);
    if (!link.ghost) insert(slot_[link.b], link.a, link.weight, opposite(link.towards));
  }
  level.entryBegin.resize(count + 1);
  level.entries.clear();
  for (int s = 0; s < count; ++s) {
    level.entryBegin[s] = static_cast<int>(level.entries.size());
    level.entries.insert(level.entries.end(), entries_.begin() + counts_[s],
                         entries_.begin() + counts_[s] + used_[s]);
    const int at = level.specialAt[s];
    if (at < level.extrasBegin) {
      const auto fromGrid = [&](std::ptrdiff_t to, float weight, Towards towards) {
        if (weight > 0) level.entries.push_back({static_cast<int>(to), weight, towards, false});
      };
      fromGrid(at - 1, level.ax[at], Towards::left);
      fromGrid(at + 1, level.ax[at + 1], Towards::right);
      fromGrid(at - level.stride, level.ay[at], Towards::down);
      fromGrid(at + level.stride, level.ay[at + level.stride], Towards::up);
    }
    float diagonal = 0;
    for (std::size_t e = level.entryBegin[s]; e < level.entries.size(); ++e)
      diagonal += level.entries[e].weight;
    level.specialInverse[s] = diagonal > 0 ? 1 / diagonal : 0;
  }
  level.entryBegin[count] = static_cast<int>(level.entries.size());

  labels_.resize(level.extras);
  for (int at : specials_) {
    if (at >= level.extrasBegin) labels_[at - level.extrasBegin] = slot_[at];
    slot_[at] = -1;
  }
}

std::size_t Builder::bytes() const {
  const auto of = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return of(members_) + of(order_) + of(sizes_) + of(labels_) + of(prolong_[0]) + of(prolong_[1]) + of(raw_) +
         of(slot_) + of(specials_) + of(counts_) + of(entries_) + of(used_) + of(splitBlocks_) +
         of(regularChunk_) + of(disturbed_);
}

}  // namespace smokebox::multigrid
