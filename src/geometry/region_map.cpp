#include "geometry/region_map.h"

#include <algorithm>

#include "geometry/coverage.h"

namespace smokebox {
namespace {

constexpr double kLeastOpening = 1e-7;  // of h: what is narrower is rounding

class RegionMapper {
 public:
  RegionMapper(const Grid& grid, JoinedSides joined, GridCover& cover)
      : grid_(grid),
        joined_(joined),
        cover_(cover),
        work_(cover.work),
        wide_(work_.wideRuns),
        rowStart_(work_.wideRowStart),
        root_(work_.regionRoot) {}

  void run() {
    sortCutCells();
    listWideRuns();
    root_.resize(work_.partCount + wide_.size());
    for (std::size_t k = 0; k < root_.size(); ++k) root_[k] = static_cast<int>(k);
    joinWideRuns();
    for (std::size_t k = 0; k < work_.cells.size(); ++k) joinParts(static_cast<int>(k));
    number();
  }

 private:
  using Run = RegionMap::Run;

  int rootOf(int node) {
    while (root_[node] != node) node = root_[node] = root_[root_[node]];
    return node;
  }
  void join(int a, int b) {
    a = rootOf(a);
    b = rootOf(b);
    root_[std::max(a, b)] = std::min(a, b);
  }

  void sortCutCells() {
    work_.sortedCells.assign(work_.cells.begin(), work_.cells.end());
    std::sort(work_.sortedCells.begin(), work_.sortedCells.end());
  }

  /// Open cells without outlines between the cut cells of a row: all or none of a gap are open.
  void listWideRuns() {
    wide_.clear();
    rowStart_.assign(1, 0);
    auto cut = work_.sortedCells.begin();
    for (int j = 0; j < grid_.ny; ++j) {
      int from = 0;
      auto gap = [&](int to) {
        if (to > from && cover_.volume(from, j) > 0)
          wide_.push_back({from, to, work_.partCount + static_cast<int>(wide_.size())});
      };
      for (; cut != work_.sortedCells.end() && *cut / grid_.nx == j; ++cut) {
        gap(*cut % grid_.nx);
        from = *cut % grid_.nx + 1;
      }
      gap(grid_.nx);
      rowStart_.push_back(static_cast<int>(wide_.size()));
    }
  }

  void joinRows(int lower, int upper) {
    const Run *a = wide_.data() + rowStart_[lower], *b = wide_.data() + rowStart_[upper];
    const Run *aEnd = wide_.data() + rowStart_[lower + 1], *bEnd = wide_.data() + rowStart_[upper + 1];
    while (a != aEnd && b != bEnd) {
      if (std::max(a->begin, b->begin) < std::min(a->end, b->end)) join(a->region, b->region);
      ++(a->end < b->end ? a : b);
    }
  }

  void joinWideRuns() {
    for (int j = 1; j < grid_.ny; ++j) joinRows(j - 1, j);
    if (joined_.y) joinRows(grid_.ny - 1, 0);
    if (!joined_.x) return;
    for (int j = 0; j < grid_.ny; ++j) {
      if (rowStart_[j] == rowStart_[j + 1]) continue;
      const Run &first = wide_[rowStart_[j]], &last = wide_[rowStart_[j + 1] - 1];
      if (first.begin == 0 && last.end == grid_.nx) join(first.region, last.region);
    }
  }

  int wideRunAt(int i, int j) const {
    const auto first = wide_.begin() + rowStart_[j], last = wide_.begin() + rowStart_[j + 1];
    const auto run = std::lower_bound(first, last, i, [](const Run& r, int x) { return r.end <= x; });
    return run != last && run->begin <= i ? run->region : -1;
  }

  /// Through the openings of the faces of a cut cell.
  void joinParts(int k) {
    const double least = kLeastOpening * grid_.h;
    for (int a = work_.arcStart[k]; a < work_.arcStart[k + 1]; ++a) {
      const CoverWork::PartArc& arc = work_.arcs[a];
      int i = work_.cells[k] % grid_.nx + (arc.side == 1) - (arc.side == 3),
          j = work_.cells[k] / grid_.nx + (arc.side == 2) - (arc.side == 0);
      if (joined_.x) i = (i + grid_.nx) % grid_.nx;
      if (joined_.y) j = (j + grid_.ny) % grid_.ny;
      if (i < 0 || j < 0 || i >= grid_.nx || j >= grid_.ny || arc.hi - arc.lo <= least) continue;
      const int other = work_.pieceOfCell[j * grid_.nx + i];
      if (other < 0) {
        const int run = wideRunAt(i, j);
        if (run >= 0) join(arc.part, run);
        continue;
      }
      if (arc.side == 0 || arc.side == 3) continue;  // seen from the other cell
      for (int b = work_.arcStart[other]; b < work_.arcStart[other + 1]; ++b) {
        const CoverWork::PartArc& opposite = work_.arcs[b];
        if (opposite.side == (arc.side ^ 2) &&
            std::min(arc.hi, opposite.hi) - std::max(arc.lo, opposite.lo) > least)
          join(arc.part, opposite.part);
      }
    }
  }

  void number() {
    RegionMap& map = cover_.regions;
    map.runs.clear();
    map.rowStart.assign(1, 0);
    map.count = 0;
    work_.regionLabel.assign(root_.size(), -1);
    auto cut = work_.sortedCells.begin();
    for (int j = 0; j < grid_.ny; ++j) {
      const std::size_t first = map.runs.size();
      auto add = [&](int begin, int end, int node) {
        int& label = work_.regionLabel[rootOf(node)];
        if (label < 0) label = map.count++;
        if (map.runs.size() > first && map.runs.back().end == begin && map.runs.back().region == label)
          map.runs.back().end = end;
        else
          map.runs.push_back({begin, end, label});
      };
      auto addCut = [&](int before) {
        for (; cut != work_.sortedCells.end() && *cut / grid_.nx == j && *cut % grid_.nx < before; ++cut) {
          const int part = work_.keptPart[work_.pieceOfCell[*cut]], i = *cut % grid_.nx;
          if (part >= 0 && cover_.volume(i, j) > 0) add(i, i + 1, part);
        }
      };
      for (int r = rowStart_[j]; r < rowStart_[j + 1]; ++r) {
        addCut(wide_[r].begin);
        add(wide_[r].begin, wide_[r].end, wide_[r].region);
      }
      addCut(grid_.nx);
      map.rowStart.push_back(static_cast<int>(map.runs.size()));
    }
  }

  const Grid& grid_;
  JoinedSides joined_;
  GridCover& cover_;
  CoverWork& work_;
  std::vector<Run>& wide_;  // `region`: the run's node; the nodes before these are the parts of cut cells
  std::vector<int>& rowStart_;
  std::vector<int>& root_;
};

}  // namespace

int RegionMap::at(int i, int j) const {
  if (rowStart.empty()) return -1;
  const Run *first = begin(j), *last = end(j);
  const Run* run = std::lower_bound(first, last, i, [](const Run& r, int x) { return r.end <= x; });
  return run != last && run->begin <= i ? run->region : -1;
}

void mapRegions(const Grid& grid, JoinedSides joined, GridCover& cover) {
  RegionMapper(grid, joined, cover).run();
}

}  // namespace smokebox
