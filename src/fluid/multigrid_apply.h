// What the links of a multigrid level make of values, row by row: the sums over the links of every unknown,
// and the residual; see multigrid_kernels.h for the vectors.
#pragma once
#include "fluid/multigrid_kernels.h"

namespace smokebox::multigrid {

/// In each chunk of row j that is not empty, in order: use(offset into the level's arrays, sum over the links
/// of weight (value here - value there)).
template <class Use>
SMOKEBOX_INLINE void applyRow(const Level& level, const Floats& values, int j, Use&& use) {
  const std::ptrdiff_t stride = level.stride, row = level.at(0, j);
  const float *x = values.data(), *ax = level.ax.data(), *ay = level.ay.data(), *id = level.id.data();
  const Level::Run* run = level.runs.data() + level.runBegin[j];
  const Level::Run* const end = level.runs.data() + level.runBegin[j + 1];
  const bool tellsWhole = level.tellsWhole;
  const Lanes zero = {}, one = zero + 1.0f;
  while (run != end) {
    std::ptrdiff_t i = row + run->begin;
    Along along(x + i);
    for (int done = run->begin; run != end && run->begin == done; ++run) {
      done = run->end;
      const std::ptrdiff_t last = row + done;
      const auto wholeSum = [&] {
        return (4.0f * along.here - (along.left + along.right)) -
               (load(x + i - stride) + load(x + i + stride));
      };
      if (run->kind & kRegular) {
        for (; i < last; i += kLanes) {
          along.at(x + i);
          use(i, wholeSum());
        }
      } else if (run->kind & (kLeftSide | kRightSide)) {
        along.at(x + i);
        const LaneMask side = laneAtSide(run->kind);
        const Lanes v = along.here, link = select(side, zero + sideCell(level, run->kind, j).link, one);
        const Lanes byX = run->kind & kLeftSide ? link * (v - along.left) + (v - along.right)
                                                : (v - along.left) + link * (v - along.right);
        const Lanes sum = byX + ((v - load(x + i - stride)) + (v - load(x + i + stride)));
        use(i, tellsWhole ? select(side, sum, wholeSum()) : sum);
        i = last;
      } else {
        for (; i < last; i += kLanes) {
          along.at(x + i);
          const Lanes v = along.here, left = load(ax + i), right = load(ax + i + 1), below = load(ay + i),
                      above = load(ay + i + stride);
          Lanes sum = (left * (v - along.left) + right * (v - along.right)) +
                      (below * (v - load(x + i - stride)) + above * (v - load(x + i + stride)));
          if (tellsWhole) {
            const LaneMask whole = ((left == 1.0f) & (right == 1.0f)) & ((below == 1.0f) & (above == 1.0f));
            sum = select(whole, wholeSum(), sum);
          }
          use(i, select(load(id + i) > 0.0f, sum, zero));
        }
      }
    }
  }
}

/// The same for a special unknown, in the same order.
inline float applySpecial(const Level& level, int s) {
  const float* values = level.x.data();
  const float v = values[level.specialAt[s]];
  if (level.starred[s]) {
    const Level::Star& star = level.star[s];
    if (level.starred[s] == Level::kWholeStar)
      return (4.0f * v - (values[star.to[0]] + values[star.to[2]])) -
             (values[star.to[4]] + values[star.to[6]]);
    const auto side = [&](int k) __attribute__((always_inline)) {
      return star.weight[k] * (v - values[star.to[k]]) + star.weight[k + 1] * (v - values[star.to[k + 1]]);
    };
    return (side(0) + side(2)) + (side(4) + side(6));
  }
  double side[4] = {};
  for (int e = level.entryBegin[s]; e < level.entryBegin[s + 1]; ++e) {
    const Level::Entry& entry = level.entries[e];
    side[static_cast<int>(entry.towards)] += static_cast<double>(entry.weight * (v - values[entry.to]));
  }
  return (static_cast<float>(side[0]) + static_cast<float>(side[1])) +
         (static_cast<float>(side[2]) + static_cast<float>(side[3]));
}

/// b - A x of row j into its residual row.
inline void residualOfRow(Level& level, int j) {
  float* r = level.residualRow(j);
  const float* b = level.b.data();
  const std::ptrdiff_t row = level.at(0, j);
  if (level.rowKind[j] & Level::kGaps) std::fill_n(r, level.chunks * kLanes, 0.0f);
  applyRow(
      level, level.x, j, [&](std::ptrdiff_t i, const Lanes& sum) __attribute__((always_inline)) {
        store(r + (i - row), load(b + i) - sum);
      });
  for (int s = level.specialBegin[2 * j]; s < level.specialBegin[2 * j + 2]; ++s) {
    const int at = level.specialAt[s];
    const float sum = level.b[at] - applySpecial(level, s);
    if (at >= level.extrasBegin)
      level.residualExtra[at - level.extrasBegin] = sum;
    else
      r[at - level.at(0, j)] = sum;
  }
}

}  // namespace smokebox::multigrid
