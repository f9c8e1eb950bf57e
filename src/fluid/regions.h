// The connected regions of the fluid: cells joined through open faces. A region without an open side is
// sealed: its pressure is determined up to a constant, and its net inflow must be 0 or be spread over it.
//
// Found by joining runs of cells along the rows; the runs are kept, so that sums over a region are sums over
// runs.
#pragma once
#include <vector>

#include "fluid/boundary.h"
#include "fluid/multigrid_level.h"

namespace smokebox {

/// Sum of values[begin, end), in float64 and always in the same order.
double sumOfRow(const float* values, int begin, int end);

class Regions {
 public:
  struct Run {
    int j = 0, begin = 0, end = 0;  // cells begin <= i < end of row j
    int region = 0;
  };
  struct Region {
    bool sealed = true;
    long cells = 0;
    double volume = 0;        // open area in cells
    bool unweighted = false;  // hardly any open area: changes are spread over its cells instead
  };

  /// `links`: the finest level of the multigrid.
  void rebuild(const Boundary& boundary, const multigrid::Level& links);

  const std::vector<Run>& runs() const { return runs_; }  // by row, then column; cells with an open face only
  const std::vector<Region>& regions() const { return regions_; }
  bool anySealed() const { return anySealed_; }
  std::size_t bytes() const;

 private:
  int findRoot(int run);
  void join(int a, int b);

  std::vector<Run> runs_;
  std::vector<Region> regions_;
  std::vector<int> root_, label_, rowBegin_;
  std::vector<char> open_;
  bool anySealed_ = false;
};

}  // namespace smokebox
