#include "fluid/multigrid.h"

#include <algorithm>
#include <numeric>

#include "fluid/multigrid_apply.h"
#include "fluid/multigrid_kernels.h"
#include "fluid/multigrid_parents.h"
#include "fluid/multigrid_transfer.h"

namespace smokebox {

using multigrid::Joining;
using multigrid::Level;

namespace {

// Of all cells: red, black, red. Two sweeps take 6 to 7 iterations where three take 4, for a sixth more each.
constexpr int kFullSweeps = 3;
constexpr int kBandPairs = 2;  // red-black pairs along solids, beyond those
constexpr int kSweeps = kFullSweeps + 2 * kBandPairs;

template <bool bandOnly, bool start = false>
void sweepUnit(Level& level, int j, int colour) {
  if (level.hasMiddleRows() && level.inMiddleRows(j))
    multigrid::RowPair::middle(level).sweep<bandOnly, start>(colour);
  else if (level.inSeamRows(j)) {
    if (j == 0) multigrid::RowPair::seam(level).sweep<bandOnly, start>(colour);  // and the last one
  } else if constexpr (start) {
    startRow(level, j);
    multigrid::solveSpecialPairs<true>(level, j, colour);
    level.wrapRow(level.row(level.x, j));
  } else
    multigrid::sweepRow<bandOnly>(level, j, colour);
}

/// Sweep s of row j on the way down; of the two middle rows, if it is one of them.
void sweepDown(Level& level, int s, int j) {
  if (s == 0)
    sweepUnit<false, true>(level, j, 0);
  else if (s < kFullSweeps)
    sweepUnit<false>(level, j, s & 1);
  else if (!(level.rowKind[j] & Level::kNoBand))
    sweepUnit<true>(level, j, s & 1);
}

/// The same sweeps backwards, on the way up.
void sweepUp(Level& level, int s, int j) {
  const int mirrored = kSweeps - 1 - s;
  if (mirrored < kFullSweeps)
    sweepUnit<false>(level, j, mirrored & 1);
  else if (!(level.rowKind[j] & Level::kNoBand))
    sweepUnit<true>(level, j, mirrored & 1);
}

Multigrid::Products productsOfRow(const Level& level, int j) {
  Lanes slope = {}, curvature = {};
  const float *x = level.x.data(), *b = level.b.data();
  multigrid::applyRow(
      level, level.x, j, [&](std::ptrdiff_t i, const Lanes& sum) __attribute__((always_inline)) {
        const Lanes value = load(x + i);
        slope += value * load(b + i);
        curvature += value * sum;
      });
  return {multigrid::sumOfLanes(slope), multigrid::sumOfLanes(curvature)};
}

}  // namespace

Multigrid::Multigrid(const Boundary& boundary, ThreadPool& pool) : pool_(pool) { rebuild(boundary); }

void Multigrid::shape(const Boundary& boundary) {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  const bool px = boundary.periodicX(), py = boundary.periodicY();
  if (!levels_.empty()) {
    const Level& top = levels_.front();
    if (top.nx == nx && top.ny == ny && top.periodicX == px && top.periodicY == py) return;
  }
  levels_.clear();
  int m = nx, n = ny, unit = 1;
  while (true) {
    levels_.emplace_back();
    Level& level = levels_.back();
    level.shape(m, n, px, py, pool_.threads() > 1 || py);
    level.unit = unit;
    // The value beyond an open side sits half a fine cell outside. Where three blocks make one, centres are
    // taken as no more than twice as far apart as those of the finer level: see the top of the header.
    const auto measure = [&](int cells, bool periodic, const std::vector<double>* finerWidth,
                             const std::vector<double>* finerDistance, std::vector<double>& width,
                             std::vector<double>& distance) {
      const Joining join(finerWidth ? static_cast<int>(finerWidth->size()) : 0);
      width.assign(cells, 1);
      for (int k = 0; k < cells && finerWidth; ++k)
        width[k] = std::accumulate(finerWidth->begin() + join.begin(k),
                                   finerWidth->begin() + join.begin(k + 1), 0.0);
      distance.resize(cells + 1);
      for (int k = 1; k < cells; ++k) distance[k] = 0.5 * (width[k - 1] + width[k]);
      distance[0] = 0.5 * (width[0] + (periodic ? width[cells - 1] : 1));
      distance[cells] = periodic ? distance[0] : 0.5 * (width[cells - 1] + 1);
      for (int k = 0; k <= cells && finerDistance; ++k)
        distance[k] = std::min(distance[k], 2 * (*finerDistance)[join.begin(k)]);
    };
    const Level* finer = levels_.size() > 1 ? &levels_[levels_.size() - 2] : nullptr;
    measure(m, px, finer ? &finer->widthX : nullptr, finer ? &finer->distanceX : nullptr, level.widthX,
            level.distanceX);
    measure(n, py, finer ? &finer->widthY : nullptr, finer ? &finer->distanceY : nullptr, level.widthY,
            level.distanceY);
    const auto nominal = [&](const std::vector<double>& width, const std::vector<double>& distance,
                             std::vector<float>& size, std::vector<float>& near) {
      size.assign(width.size() + 2 * kLanes, 0);
      near.assign(width.size() + 2 * kLanes, 0);
      for (std::size_t k = 0; k < width.size(); ++k) size[k] = static_cast<float>(width[k] / unit);
      for (std::size_t k = 0; k < distance.size(); ++k) near[k] = static_cast<float>(unit / distance[k]);
    };
    nominal(level.widthX, level.distanceX, level.wide, level.nearX);
    nominal(level.widthY, level.distanceY, level.high, level.nearY);
    level.slackX.assign(level.nearX.size(), 1e-4f);
    for (int i = 0; i < static_cast<int>(level.slackX.size()); ++i)
      if (i == 0 || i >= m) level.slackX[i] = 1e9f;
    if (m == 1 && n == 1) break;
    m = Joining::joined(m);
    n = Joining::joined(n);
    unit *= 2;
  }
  zeroRow_.assign(levels_.front().residualStride + 2 * kLanes, 0);
  rowProducts_.assign(ny, {});
}

void Multigrid::rebuild(const Boundary& boundary) {
  shape(boundary);
  builder_.finest(boundary, levels_.front());
  for (std::size_t l = 1; l < levels_.size(); ++l) builder_.coarsen(levels_[l - 1], levels_[l]);
  listSealed();
}

// Every unknown of the balanced level that belongs to a region without an open side, region by region.
void Multigrid::listSealed() {
  constexpr long kFewCells = 1024;
  balanced_ = 0;
  while (static_cast<long>(levels_[balanced_].nx) * levels_[balanced_].ny > kFewCells) ++balanced_;

  // On some coarser level a sealed region is one unknown without a link; that is where its label comes from.
  // A region with an open side keeps a link up to the coarsest level.
  labels_.resize(levels_.size());
  int regions = 0;
  for (std::size_t l = levels_.size(); l-- > balanced_;) {
    const Level& level = levels_[l];
    labels_[l].assign(level.x.size(), -1);
    const auto label = [&](int at, bool linked) {
      if (!linked)
        labels_[l][at] = regions++;
      else if (l + 1 < levels_.size())
        labels_[l][at] = labels_[l + 1][parentOf(level, levels_[l + 1], at)];
    };
    for (int j = 0; j < level.ny; ++j)
      for (int i = 0; i < level.nx; ++i)
        label(static_cast<int>(level.at(i, j)), level.id[level.at(i, j)] != 0);
    for (std::size_t s = 0; s < level.specialAt.size(); ++s)
      if (level.specialAt[s] >= level.extrasBegin) label(level.specialAt[s], level.specialInverse[s] > 0);
  }
  const std::vector<int>& label = labels_[balanced_];
  sealedBegin_.assign(regions + 1, 0);
  for (int r : label)
    if (r >= 0) ++sealedBegin_[r + 1];
  for (int r = 0; r < regions; ++r) sealedBegin_[r + 1] += sealedBegin_[r];
  sealedAt_.resize(sealedBegin_[regions]);
  for (int at = static_cast<int>(label.size()) - 1; at >= 0; --at)
    if (label[at] >= 0) sealedAt_[--sealedBegin_[label[at] + 1]] = at;
  sealedBegin_.push_back(static_cast<int>(sealedAt_.size()));
  sealedBegin_.erase(sealedBegin_.begin());
}

void Multigrid::balance(multigrid::Floats& values) const {
  for (std::size_t r = 0; r + 1 < sealedBegin_.size(); ++r) {
    double sum = 0;
    for (int k = sealedBegin_[r]; k < sealedBegin_[r + 1]; ++k) sum += values[sealedAt_[k]];
    const float mean = static_cast<float>(sum / std::max(1, sealedBegin_[r + 1] - sealedBegin_[r]));
    for (int k = sealedBegin_[r]; k < sealedBegin_[r + 1]; ++k) values[sealedAt_[k]] -= mean;
  }
}

bool Multigrid::shared(const Level& level) const {
  return pool_.threads() > 1 && static_cast<long>(level.nx) * level.ny >= (1 << 15);
}

template <class Body>
void Multigrid::rows(const Level& level, int first, int last, Body&& body) {
  forRows(pool_, static_cast<long>(level.nx) * level.ny, first, last, body);
}

template <class Sweep, class Then>
void Multigrid::inOrder(Level& level, int sweepsBegin, int sweepsEnd, int stages, Sweep&& sweep,
                        Then&& then) {
  // The two rows in the middle of mirrored colours go together: units are rows, and one that is both.
  const int middle = level.hasMiddleRows() ? level.swapsAtRow - 1 : level.ny;
  const int units = level.hasMiddleRows() ? level.ny - 1 : level.ny;
  const auto stage = [&](int s, int unit) {
    const int j = unit <= middle ? unit : unit + 1;
    if (s >= sweepsBegin && s < sweepsEnd) {
      sweep(s, j);
      return;
    }
    then(s, j);
    if (unit == middle) then(s, j + 1);
  };
  if (level.periodicY) {
    for (int s = 0; s < stages; ++s) {
      rows(level, 0, units, [&](int j) { stage(s, j); });
      level.wrapRows(level.x);
    }
    return;
  }
  // Units of a band that a stage can do without its neighbours' last ones.
  const auto band = [&](int low, int high, bool atBottom, bool atTop) {
    for (int t = low; t < high + stages; ++t)
      for (int s = 0; s < stages; ++s) {
        const int j = t - s;
        if (j >= low + (atBottom ? 0 : s) && j < high - (atTop ? 0 : s)) stage(s, j);
      }
  };
  constexpr int kFewestRows = 32, kBandsAThread = 4;
  const int count = std::min(kBandsAThread * pool_.threads(), units / kFewestRows);
  if (!shared(level) || count < 2) return band(0, units, true, true);
  const auto border = [&](int k) { return static_cast<int>(static_cast<long>(units) * k / count); };
  pool_.blocks(0, count, 1, [&](int k, int) { band(border(k), border(k + 1), k == 0, k == count - 1); });
  pool_.blocks(1, count, 1, [&](int k, int) {
    for (int s = 1; s < stages; ++s)
      for (int j = border(k) - s; j < border(k) + s; ++j) stage(s, j);
  });
}

void Multigrid::descend(std::size_t l) {
  Level& level = levels_[l];
  Level* coarse = l + 1 < levels_.size() ? &levels_[l + 1] : nullptr;
  const bool whole = shared(level) || level.periodicY;  // all rows of the residual are kept
  inOrder(
      level, 0, kSweeps, coarse ? kSweeps + 1 : kSweeps, [&](int s, int j) { sweepDown(level, s, j); },
      [&](int, int j) {
        residualOfRow(level, j);
        const int J = level.joinY.coarse(j);
        if (!whole && j + 1 == level.joinY.begin(J + 1)) restrictRow(level, *coarse, J, zeroRow());
      });
  if (coarse && whole) rows(level, 0, coarse->ny, [&](int J) { restrictRow(level, *coarse, J, zeroRow()); });
}

void Multigrid::ascend(std::size_t l, bool measured) {
  Level& level = levels_[l];
  const Level& coarse = levels_[l + 1];
  inOrder(
      level, 1, kSweeps + 1, measured ? kSweeps + 2 : kSweeps + 1,
      [&](int s, int j) { sweepUp(level, s - 1, j); },
      [&](int s, int j) {
        if (s == 0)
          prolongRow(level, coarse, j);
        else
          rowProducts_[j] = productsOfRow(level, j);
      });
}

void Multigrid::visit(std::size_t l, bool measured) {
  if (l == balanced_) balance(levels_[l].b);
  descend(l);
  if (l + 1 == levels_.size()) return;
  visit(l + 1, false);
  ascend(l, measured);
  if (l == balanced_ && l > 0) balance(levels_[l].x);
}

Multigrid::Products Multigrid::cycle(bool measured) {
  visit(0, measured);
  Products sum;
  for (const Products& row : rowProducts_) {
    sum.withResidual += row.withResidual;
    sum.curvature += row.curvature;
  }
  return sum;
}

std::size_t Multigrid::bytes() const {
  std::size_t sum = builder_.bytes() + (sealedAt_.capacity() + sealedBegin_.capacity()) * sizeof(int) +
                    zeroRow_.size() * sizeof(float) + rowProducts_.size() * sizeof(Products);
  for (const auto& list : labels_) sum += list.capacity() * sizeof(int);
  for (const Level& level : levels_) sum += level.bytes();
  return sum;
}

}  // namespace smokebox
