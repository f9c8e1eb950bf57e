#include "fluid/region_match.h"

#include <algorithm>
#include <cmath>

namespace smokebox {
namespace {

constexpr double kLeastShare = 0.5;
constexpr double kFine = 1 << 24;  // sums of whole multiples of 1 / kFine have no order

void countCells(const SmokeCells& cells, const RegionMap& map, std::vector<long>& size) {
  size.assign(map.count, 0);
  for (int j = 0; j < cells.ny; ++j)
    for (const RegionMap::Run* r = map.begin(j); r != map.end(j); ++r) size[r->region] += r->end - r->begin;
}

/// Calls both(region before, region after, begin, end) for the cells of row j that are open in both.
template <class Both>
void overlapRow(const RegionMap& before, int rowBefore, const RegionMap& after, int j, Both&& both) {
  const RegionMap::Run *a = before.begin(rowBefore), *b = after.begin(j);
  while (a != before.end(rowBefore) && b != after.end(j)) {
    const int begin = std::max(a->begin, b->begin), end = std::min(a->end, b->end);
    if (begin < end) both(a->region, b->region, begin, end);
    ++(a->end < b->end ? a : b);
  }
}

}  // namespace

// By how many cells the walls around each region have moved: the mean over the closed parts of its faces.
void RegionMatch::findShifts(const SmokeCells& cells, const std::vector<int>& cut, const Boundary& b,
                             double dt) {
  const double scale = dt / b.grid.h;
  shifts_.assign(b.regions.count, {});
  for (int c : cut) {
    const int region = b.regions.at(cells.i(c), cells.j(c));
    if (region < 0) continue;
    Shift& s = shifts_[region];
    for (int face = 0; face < 4; ++face) {
      const double closed = 1 - cells.atFace(b.openX, b.openY, c, face);
      (face < 2 ? s.x : s.y) +=
          std::nearbyint(kFine * closed * scale * cells.atFace(b.wallU, b.wallV, c, face));
      (face < 2 ? s.weightX : s.weightY) += std::nearbyint(kFine * closed);
    }
  }
  for (Shift& s : shifts_) {
    s.x = s.weightX > 0 ? std::round(s.x / s.weightX) : 0;
    s.y = s.weightY > 0 ? std::round(s.y / s.weightY) : 0;
  }
}

void RegionMatch::findOverlaps(const SmokeCells& cells, const RegionMap& before, const RegionMap& after) {
  overlaps_.clear();
  auto back = [](int k, double shift, int n, bool periodic) {
    const double place = k - shift;
    if (place >= 0 && place < n) return static_cast<int>(place);
    return periodic ? static_cast<int>(place - std::floor(place / n) * n) : -1;
  };
  for (int j = 0; j < cells.ny; ++j)
    for (const RegionMap::Run* r = after.begin(j); r != after.end(j); ++r) {
      const Shift& s = shifts_[r->region];
      const int row = back(j, s.y, cells.ny, cells.periodicY);
      if (row < 0) continue;
      // The shifted run in up to two pieces, beyond a periodic side and before it.
      const int size = r->end - r->begin, first = back(r->begin, s.x, cells.nx, cells.periodicX);
      auto count = [&](int begin, int end) {
        for (const RegionMap::Run* a = before.begin(row); a != before.end(row); ++a) {
          const int both = std::min(a->end, end) - std::max(a->begin, begin);
          if (both > 0) overlaps_.push_back({a->region, r->region, both});
        }
      };
      if (cells.periodicX) {
        count(first, std::min(first + size, cells.nx));
        if (first + size > cells.nx) count(0, first + size - cells.nx);
      } else if (std::fabs(s.x) < cells.nx) {
        count(r->begin - static_cast<int>(s.x), r->end - static_cast<int>(s.x));
      }
    }
  std::sort(overlaps_.begin(), overlaps_.end(), [](const Pair& a, const Pair& b) {
    return a.before != b.before ? a.before < b.before : a.after < b.after;
  });
}

void RegionMatch::find(const SmokeCells& cells, const std::vector<int>& cut, const RegionMap& before,
                       const Boundary& b, double dt) {
  clear();
  const RegionMap& after = b.regions;
  apart_ = !before.rowStart.empty() && !after.rowStart.empty() && (before.count > 1 || after.count > 1);
  if (!apart_) return;
  findShifts(cells, cut, b, dt);
  findOverlaps(cells, before, after);
  countCells(cells, before, sizeBefore_);
  countCells(cells, after, sizeAfter_);
  for (std::size_t k = 0; k < overlaps_.size();) {
    Pair sum{overlaps_[k].before, overlaps_[k].after, 0};
    for (; k < overlaps_.size() && overlaps_[k].before == sum.before && overlaps_[k].after == sum.after; ++k)
      sum.cells += overlaps_[k].cells;
    if (sum.cells >= kLeastShare * std::min(sizeBefore_[sum.before], sizeAfter_[sum.after]))
      pairs_.push_back(sum);
  }
}

bool RegionMatch::continues(int before, int after) const {
  if (!apart_ || before < 0 || after < 0) return true;
  const auto pair = std::lower_bound(pairs_.begin(), pairs_.end(), Pair{before, after, 0},
                                     [](const Pair& a, const Pair& b) {
                                       return a.before != b.before ? a.before < b.before : a.after < b.after;
                                     });
  return pair != pairs_.end() && pair->before == before && pair->after == after;
}

int RegionMatch::heir(int before) const {
  int best = -1;
  long most = 0;
  for (const Pair& p : pairs_)
    if (p.before == before && p.cells > most) {
      most = p.cells;
      best = p.after;
    }
  return best;
}

void RegionMatch::addChanged(const SmokeCells& cells, const RegionMap& before, const RegionMap& after,
                             std::vector<int>& changed) const {
  if (!apart_) return;
  for (int j = 0; j < cells.ny; ++j)
    overlapRow(before, j, after, j, [&](int was, int is, int begin, int end) {
      if (continues(was, is)) return;
      for (int i = begin; i < end; ++i) changed.push_back(cells.cell(i, j));
    });
}

}  // namespace smokebox
