// The loops over one row that carry a multigrid level's residual to the next coarser one, and the correction
// back, or join a row of one to one of the other; see multigrid_kernels.h for the vectors.
#pragma once
#include "fluid/multigrid_kernels.h"

namespace smokebox::multigrid {

/// Lanes of the coarse blocks I to I + 15 beyond the middle one.
SMOKEBOX_INLINE LaneMask lanesBeyond(const Joining& join, int I) { return laneNumbers() > join.middle - I; }

/// Joins the columns of the coarse blocks I to I + 15: their sums, or each block's first. at(i): what the
/// fine columns i to i + 15 hold.
template <bool first, class At>
SMOKEBOX_INLINE Lanes joinColumns(const Joining& join, int I, At&& at) {
  const auto pairs = [&](int i) __attribute__((always_inline)) {
    const Lanes p = at(i), q = at(i + kLanes);
    const Lanes one = evenLanes(p, q);
    return first ? one : one + oddLanes(p, q);
  };
  if (I + kLanes <= join.middle) return pairs(2 * I);
  if (I > join.middle) return pairs(2 * I + join.shift);
  Lanes sum = select(lanesBeyond(join, I), pairs(2 * I + join.shift), pairs(2 * I));
  const Lanes middle = at(2 * join.middle);
  setLane(sum, join.middle - I, first || join.shift < 0 ? middle[0] : (middle[0] + middle[2]) + middle[1]);
  return sum;
}

/// Adds up the residual rows of row J of the coarse right-hand side.
inline void restrictRow(Level& fine, Level& coarse, int J, const float* zeroRow) {
  const int j = fine.joinY.begin(J), count = fine.joinY.begin(J + 1) - j;
  const float* rows[3] = {fine.residualRow(j), count > 1 ? fine.residualRow(j + 1) : zeroRow,
                          count > 2 ? fine.residualRow(j + 2) : zeroRow};
  float* b = coarse.row(coarse.b, J);
  for (int c = 0; c < coarse.chunks; ++c) {
    const int I = c * kLanes;
    if (count < 3)
      store(b + I, joinColumns<false>(
                       fine.joinX, I, [&](int i) __attribute__((always_inline)) {
                         return load(rows[0] + i) + load(rows[1] + i);
                       }));
    else
      store(b + I, joinColumns<false>(
                       fine.joinX, I, [&](int i) __attribute__((always_inline)) {
                         return (load(rows[0] + i) + load(rows[2] + i)) + load(rows[1] + i);
                       }));
  }
  for (int s = fine.splitBegin[J]; s < fine.splitBegin[J + 1]; ++s) {
    const Level::Split& split = fine.split[s];
    double sum = 0;  // of so few that their order hardly ever matters
    for (int k = split.childBegin; k < split.childEnd; ++k) {
      const int child = fine.child[k];
      sum += static_cast<double>(child < 0 ? fine.residualExtra[~child] : rows[child & 3][child >> 2]);
    }
    coarse.b[split.at] = static_cast<float>(sum);
  }
}

/// Adds the coarse correction to row j.
inline void prolongRow(Level& fine, const Level& coarse, int j) {
  float* x = fine.row(fine.x, j);
  const float* b = fine.row(fine.b, j);
  const float* correction = coarse.row(coarse.x, fine.joinY.coarse(j));
  const bool large = fine.large();
  const int first = fine.prolongBegin[j], last = fine.prolongBegin[j + 1];
  for (int s = first; s < last; ++s) {
    Level::Prolong& p = fine.prolong[s];
    p.value = fine.x[p.at] + coarse.x[p.parent];
  }
  const std::uint8_t* kind = fine.chunkRow(j);
  const Joining join = fine.joinX;
  for (int c = 0, i = 0; c < fine.chunks; ++c, i += kLanes) {
    if (kind[c] & kEmpty) continue;
    if (large) expect(x + i + fine.stride), expect(b + i + fine.stride);
    Lanes value = loadTwice(correction + i / 2);
    if (i + kLanes > join.from) {
      const Lanes beyond = loadTwiceFromMiddle(correction + i / 2 - (join.shift > 0 ? 1 : 0));
      value = select(laneNumbers() >= join.from - i, beyond, value);
    }
    store(x + i, load(x + i) + value);
  }
  for (int s = first; s < last; ++s) fine.x[fine.prolong[s].at] = fine.prolong[s].value;
  fine.wrapRow(x);
}

}  // namespace smokebox::multigrid
