// The links of a coarse level: those of the finer one that cross its faces, added up.
#include <algorithm>
#include <bit>
#include <tuple>

#include "fluid/multigrid_build.h"
#include "fluid/multigrid_transfer.h"
#include "fluid/multigrid_parents.h"

namespace smokebox::multigrid {

namespace {

unsigned columnsOf(const Level& level, int c) { return (1u << std::min(kLanes, level.nx - c * kLanes)) - 1; }

float factorOfX(const Level& fine, const Level& coarse, int I) {
  return static_cast<float>(fine.distanceX[fine.joinX.begin(I)] / coarse.distanceX[I]);
}

float factorOfY(const Level& fine, const Level& coarse, int J) {
  return static_cast<float>(fine.distanceY[fine.joinY.begin(J)] / coarse.distanceY[J]);
}

void fillRegular(Level& coarse, int C, int J) {
  const Lanes zero = {};
  store(coarse.row(coarse.ax, J) + C * kLanes, zero + 1.0f);
  store(coarse.row(coarse.ay, J) + C * kLanes, zero + 1.0f);
}

}  // namespace

// What the fine grid's links between primary unknowns across the left face of block (I, J) add up to; raws(a,
// b, weight, towards, ghost) is called for those that touch an extra unknown.
template <class Raws>
double Builder::sumLeft(const Level& fine, const Level& coarse, int I, int J, Raws&& raws) {
  const bool atLeft = I == 0, atRight = I == coarse.nx;
  const int i = fine.joinX.begin(I), leftColumn = atLeft ? (coarse.periodicX ? fine.nx - 1 : -1) : i - 1;
  double sum = 0;
  for (int j = fine.joinY.begin(J); j < fine.joinY.begin(J + 1); ++j) {
    const float w = fine.row(fine.ax, j)[i];
    if (!(w > 0)) continue;
    const int a = atRight ? static_cast<int>(coarse.at(I, J)) : parentOf(fine, coarse, i, j);
    const int b = leftColumn < 0 ? static_cast<int>(coarse.at(-1, J)) : parentOf(fine, coarse, leftColumn, j);
    if (a < coarse.extrasBegin && b < coarse.extrasBegin)
      sum += static_cast<double>(w);
    else if (atRight)
      raws(b, a, w, Towards::right, true);
    else
      raws(a, b, w, Towards::left, leftColumn < 0);
  }
  return sum;
}

/// The same across the lower face.
template <class Raws>
double Builder::sumBelow(const Level& fine, const Level& coarse, int I, int J, Raws&& raws) {
  const bool atBottom = J == 0, atTop = J == coarse.ny;
  const int j = fine.joinY.begin(J), rowBelow = atBottom ? (coarse.periodicY ? fine.ny - 1 : -1) : j - 1;
  double sum = 0;
  for (int i = fine.joinX.begin(I); i < fine.joinX.begin(I + 1); ++i) {
    const float w = fine.row(fine.ay, j)[i];
    if (!(w > 0)) continue;
    const int a = atTop ? static_cast<int>(coarse.at(I, J)) : parentOf(fine, coarse, i, j);
    const int b = rowBelow < 0 ? static_cast<int>(coarse.at(I, -1)) : parentOf(fine, coarse, i, rowBelow);
    if (a < coarse.extrasBegin && b < coarse.extrasBegin)
      sum += static_cast<double>(w);
    else if (atTop)
      raws(b, a, w, Towards::up, true);
    else
      raws(a, b, w, Towards::down, rowBelow < 0);
  }
  return sum;
}

void Builder::linkLeft(const Level& fine, Level& coarse, int I, int J) {
  float* target = coarse.row(coarse.ax, J) + I;
  *target = 0;
  if (coarse.periodicX && (I == coarse.nx || coarse.nx == 1)) return;  // copied from the left; to itself
  const float factor = factorOfX(fine, coarse, I);
  const double sum =
      sumLeft(fine, coarse, I, J, [&](int a, int b, float weight, Towards towards, bool ghost) {
        raw_.push_back({a, b, static_cast<double>(weight), factor, towards, ghost});
      });
  *target = static_cast<float>(sum) * factor;
}

void Builder::linkBelow(const Level& fine, Level& coarse, int I, int J) {
  float* target = coarse.row(coarse.ay, J) + I;
  *target = 0;
  if (coarse.periodicY && (J == coarse.ny || coarse.ny == 1)) return;
  const float factor = factorOfY(fine, coarse, J);
  const double sum =
      sumBelow(fine, coarse, I, J, [&](int a, int b, float weight, Towards towards, bool ghost) {
        raw_.push_back({a, b, static_cast<double>(weight), factor, towards, ghost});
      });
  *target = static_cast<float>(sum) * factor;
}

// The left and lower faces of a chunk, as they are where neither it nor its neighbours have extra unknowns.
void Builder::linkWhole(const Level& fine, Level& coarse, int C, int J) {
  const int I = C * kLanes, j = fine.joinY.begin(J), rows = fine.joinY.begin(J + 1) - j;
  const float *ax = fine.row(fine.ax, j), *ay = fine.row(fine.ay, j);
  const std::ptrdiff_t second = rows > 1 ? fine.stride : 0, third = 2 * fine.stride;
  // Rows end with room for one more chunk only: the second half of the last pair may lie beyond it.
  const int end = fine.chunks * kLanes;
  const Lanes zero = {};
  const Lanes left = joinColumns<true>(
      fine.joinX, I, [&](int i) __attribute__((always_inline)) {
        if (i >= end) return zero;
        if (rows == 1) return load(ax + i);
        if (rows == 2) return load(ax + i) + load(ax + i + second);
        return (load(ax + i) + load(ax + i + third)) + load(ax + i + second);
      });
  const Lanes down = joinColumns<false>(
      fine.joinX, I, [&](int i) __attribute__((always_inline)) { return i < end ? load(ay + i) : zero; });
  const bool self = coarse.periodicY && coarse.ny == 1;
  store(coarse.row(coarse.ax, J) + I, left * load(factorX_.data() + I));
  store(coarse.row(coarse.ay, J) + I, down * (self ? 0.0f : factorOfY(fine, coarse, J)));
}

// Links that cross a face of the coarse grid and are kept in the fine grid.
void Builder::linkGrid(const Level& fine, Level& coarse) {
  raw_.clear();
  factorX_.assign(static_cast<std::size_t>(coarse.chunks) * kLanes, 0);
  for (int I = 0; I < coarse.nx; ++I) factorX_[I] = factorOfX(fine, coarse, I);
  if (coarse.periodicX && coarse.nx == 1) factorX_[0] = 0;  // a link to itself
  halves_.assign(coarse.chunks, 0);
  for (int C = 0; C < coarse.chunks; ++C)
    halves_[C] = std::all_of(factorX_.begin() + C * kLanes, factorX_.begin() + (C + 1) * kLanes,
                             [](float f) { return f == 0.5f; });
  for (int J = 0; J < coarse.ny; ++J) {
    const std::uint16_t* split = splitBlocks_.data() + J * coarse.chunks;
    const std::uint16_t* below = J > 0              ? split - coarse.chunks
                                 : coarse.periodicY ? splitBlocks_.data() + (coarse.ny - 1) * coarse.chunks
                                                    : nullptr;
    const bool half = J > 0 && factorOfY(fine, coarse, J) == 0.5f;
    for (int C = 0; C < coarse.chunks; ++C) {
      if (half && C > 0 && halves_[C] && regularChunk_[J * coarse.chunks + C])
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
  late_.clear();
  const Joining &joinX = fine.joinX, &joinY = fine.joinY;
  for (int s = 0; s < static_cast<int>(fine.specialAt.size()); ++s) {
    const int i = fine.specialCell[s] % fine.nx, j = fine.specialCell[s] / fine.nx;
    const int I = joinX.coarse(i), J = joinY.coarse(j);
    for (int e = fine.entryBegin[s]; e < fine.entryBegin[s + 1]; ++e) {
      const Level::Entry& entry = fine.entries[e];
      if (!entry.listed) continue;
      // Each link once: from its right or upper end; those to a ghost have no other end.
      const Towards t = entry.towards;
      bool ghost = false, crosses = false;
      int face = 0, ghostAt = 0;
      if (t == Towards::left) {
        ghost = i == 0 && !fine.periodicX;
        crosses = i == joinX.begin(I) && !(coarse.periodicX && coarse.nx == 1);
        face = I;
        ghostAt = static_cast<int>(coarse.at(-1, J));
      } else if (t == Towards::down) {
        ghost = j == 0 && !fine.periodicY;
        crosses = j == joinY.begin(J) && !(coarse.periodicY && coarse.ny == 1);
        face = J;
        ghostAt = static_cast<int>(coarse.at(I, -1));
      } else if (t == Towards::right) {
        ghost = crosses = i == fine.nx - 1 && !fine.periodicX;
        face = coarse.nx;
        ghostAt = static_cast<int>(coarse.at(coarse.nx, J));
      } else {
        ghost = crosses = j == fine.ny - 1 && !fine.periodicY;
        face = coarse.ny;
        ghostAt = static_cast<int>(coarse.at(I, coarse.ny));
      }
      if (!crosses) continue;
      const bool alongX = t == Towards::left || t == Towards::right;
      const int a = parentOf(fine, coarse, fine.specialAt[s]);
      const int b = ghost ? ghostAt : parentOf(fine, coarse, entry.to);
      const double weight = static_cast<double>(entry.weight);
      if (a >= coarse.extrasBegin || b >= coarse.extrasBegin)
        raw_.push_back(
            {a, b, weight, alongX ? factorOfX(fine, coarse, face) : factorOfY(fine, coarse, face), t, ghost});
      else
        late_.push_back({alongX, alongX ? face : I, alongX ? J : face, weight});
    }
  }
  linkLate(fine, coarse);
  if (coarse.periodicX)
    for (int J = 0; J < coarse.ny; ++J) coarse.row(coarse.ax, J)[coarse.nx] = coarse.row(coarse.ax, J)[0];
  if (coarse.periodicY) std::copy_n(coarse.row(coarse.ay, 0), coarse.nx, coarse.row(coarse.ay, coarse.ny));
}

// Adds the lists' links between primary unknowns to the grid's, face by face.
void Builder::linkLate(const Level& fine, Level& coarse) {
  std::sort(late_.begin(), late_.end(), [](const Late& a, const Late& b) {
    return std::tie(a.x, a.J, a.I, a.weight) < std::tie(b.x, b.J, b.I, b.weight);
  });
  const auto none = [](int, int, float, Towards, bool) {};
  for (std::size_t k = 0; k < late_.size();) {
    const Late& face = late_[k];
    double sum =
        face.x ? sumLeft(fine, coarse, face.I, face.J, none) : sumBelow(fine, coarse, face.I, face.J, none);
    for (; k < late_.size() && late_[k].x == face.x && late_[k].I == face.I && late_[k].J == face.J; ++k)
      sum += late_[k].weight;
    if (face.x)
      coarse.row(coarse.ax, face.J)[face.I] = static_cast<float>(sum) * factorOfX(fine, coarse, face.I);
    else
      coarse.row(coarse.ay, face.J)[face.I] = static_cast<float>(sum) * factorOfY(fine, coarse, face.J);
  }
}

}  // namespace smokebox::multigrid
