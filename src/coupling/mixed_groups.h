// The groups of solids that may overlap and do not all move, or hold the fluid, alike: who of such a group is
// near a place. Bins of 8 x 8 cells; nothing is done, or kept, for other groups.
#pragma once
#include <vector>

#include "geometry/cover_work.h"
#include "geometry/grid.h"

namespace smokebox {

class MixedGroups {
 public:
  /// alike(a, b): of two solids that coverGrid was given. `work`: as it left it.
  template <class Alike>
  void find(const Grid& grid, const CoverWork& work, int count, Alike&& alike) {
    group_.assign(work.group.begin(), work.group.begin() + count);
    mixed_.assign(count, false);
    bool any = false;
    for (int k = 0; k < count; ++k) {
      if (group_[k] == k || mixed_[group_[k]] || alike(k, group_[k])) continue;
      mixed_[group_[k]] = any = true;
    }
    if (any) fillBins(grid, work.boxes);
  }

  bool has(int solid) const { return mixed_[group_[solid]]; }
  bool together(int solid, int other) const { return group_[solid] == group_[other]; }

  /// Calls body(other) for those of a solid's group whose boxes are within a cell or two of p, itself too.
  template <class Body>
  void near(int solid, Vec2 p, Body&& body) const {
    const int bin = binOf(p.y, rows_) * columns_ + binOf(p.x, columns_);
    for (int k = start_[bin]; k < start_[bin + 1]; ++k)
      if (group_[listed_[k]] == group_[solid]) body(listed_[k]);
  }

 private:
  static constexpr int kWide = 8;      // cells
  static constexpr double kReach = 2;  // cells

  void fillBins(const Grid& grid, const std::vector<double>& boxes);
  int binOf(double x, int bins) const;

  std::vector<int> group_;
  std::vector<char> mixed_;  // by the first member of a group
  double perMetre_ = 0;      // bins
  int columns_ = 0, rows_ = 0;
  std::vector<int> start_, listed_;
};

}  // namespace smokebox
