// Which region of the fluid (geometry/region_map.h) after the solids have moved continues which one before:
// the two overlap by half of the smaller one at least, once the old one is shifted by as many cells as the
// walls around the new one have moved on average. Where regions join or part, one continues several.
//
// Limits: a pocket of a few cells whose walls move it by more than its size while it turns may not be
// recognised; its smoke is then treated as if the pocket had vanished.
#pragma once
#include <cstdint>
#include <vector>

#include "fluid/smoke_cells.h"

namespace smokebox {

class RegionMatch {
 public:
  /// From `before` to boundary.regions; the walls' velocities are the boundary's. `cut`: at least the cells
  /// with a face that is not open.
  void find(const SmokeCells& cells, const std::vector<int>& cut, const RegionMap& before,
            const Boundary& boundary, double dt);
  /// Nothing is told apart: all is one region.
  void clear() {
    apart_ = false;
    pairs_.clear();
  }

  /// Whether there is more than one region at all; if not, all else is true or nothing.
  bool apart() const { return apart_; }
  bool continues(int before, int after) const;
  /// The region that most of it goes on as; -1: none, it has vanished.
  int heir(int before) const;
  std::size_t bytes() const { return (pairs_.capacity() + overlaps_.capacity()) * sizeof(Pair); }

  /// Appends the cells, open before and after, that are in another region now.
  void addChanged(const SmokeCells& cells, const RegionMap& before, const RegionMap& after,
                  std::vector<int>& changed) const;

 private:
  struct Pair {
    int before, after;
    long cells;
  };
  struct Shift {
    double x = 0, y = 0, weightX = 0, weightY = 0;
  };
  void findShifts(const SmokeCells& cells, const std::vector<int>& cut, const Boundary& boundary, double dt);
  void findOverlaps(const SmokeCells& cells, const RegionMap& before, const RegionMap& after);

  bool apart_ = false;
  std::vector<Pair> pairs_;  // that continue each other; sorted by before, after
  std::vector<Pair> overlaps_;
  std::vector<long> sizeBefore_, sizeAfter_;  // cells
  std::vector<Shift> shifts_;
};

}  // namespace smokebox
