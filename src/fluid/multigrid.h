// A symmetric multigrid cycle for the pressure equation, to precondition conjugate gradients with.
//
//   sum over the faces of a cell of  open (x(cell) - x(neighbour)) = b(cell),   x = 0 beyond an open side
//
// A V-cycle. Links of coarse levels are at least half of what the fine ones they stand for add up to: a
// coarse correction so goes less than twice too far, and conjugate gradients stay safe.
//
// Red-black Gauss-Seidel (mirrored after the coarse correction), more sweeps in a band along solids (McAdams
// 2010), piecewise constant transfer, coarse cells split along solids (Dick, Rogowsky and Westermann 2016),
// coarsened down to one block. Cells without an open face, and regions without an open side at the coarsest
// level, get 0 from there: b must add up to 0 over each sealed region.
//
// A problem that is mirrored left to right (or up to down) has the mirrored solution to the bit, for any
// number of columns and rows: colours and the joining of blocks are mirrored about the middle (see Level),
// every unknown is a sum of what lies along x and of what lies along y whichever way it is stored, and so is
// what a sweep along solids covers. Neighbours in the middle, and across a periodic seam, then have one
// colour and are solved as one; on periodic levels these are swept with those along solids.
//
// All sweeps of a level run in one pass over its rows, each row as soon as its neighbours are ready; several
// threads do so in bands of rows, each sweep a row further from the border than the last, and then what is
// missing at the borders. Rows that are periodic: one pass for each sweep. The results are the same to the
// bit.
#pragma once
#include <vector>

#include "base/threads.h"
#include "fluid/boundary.h"
#include "fluid/multigrid_build.h"
#include "fluid/multigrid_level.h"

namespace smokebox {

class Multigrid {
 public:
  Multigrid(const Boundary& boundary, ThreadPool& pool);

  /// Rebuilds the levels from the open shares.
  void rebuild(const Boundary& boundary);

  /// The finest level: fill its b (0 where there is no unknown), read its x.
  multigrid::Level& finest() { return levels_.front(); }
  const multigrid::Level& finest() const { return levels_.front(); }

  /// What conjugate gradients need of x: the sums of x b and of x A x.
  struct Products {
    double withResidual = 0, curvature = 0;
  };
  /// x = M b by one cycle. `measured`: returns the products, found row by row on the way.
  Products cycle(bool measured = true);

  std::size_t bytes() const;

 private:
  void shape(const Boundary& boundary);
  void listSealed();
  void balance(multigrid::Floats& values) const;
  void visit(std::size_t l, bool measured);
  void descend(std::size_t l);
  void ascend(std::size_t l, bool measured);
  /// Large enough to be spread over several threads.
  bool shared(const multigrid::Level& level) const;
  /// Does the stages 0 to `stages` - 1 for all rows, each after the stage before of the rows beside it and
  /// before the stage after of them: sweep(s, j) for the stages from sweepsBegin to sweepsEnd - 1, once for
  /// the two rows in the middle of mirrored colours (and by sweep itself for those of a seam), and then(s, j)
  /// for the others.
  template <class Sweep, class Then>
  void inOrder(multigrid::Level& level, int sweepsBegin, int sweepsEnd, int stages, Sweep&& sweep,
               Then&& then);
  template <class Body>
  void rows(const multigrid::Level& level, int first, int last, Body&& body);

  ThreadPool& pool_;
  multigrid::Builder builder_;
  std::vector<multigrid::Level> levels_;
  std::size_t balanced_ = 0;      // the level on which sealed regions are balanced
  std::vector<int> sealedBegin_;  // its unknowns, region by region
  std::vector<int> sealedAt_;
  std::vector<std::vector<int>> labels_;  // scratch of listSealed, by level
  const float* zeroRow() const { return zeroRow_.data() + kLanes; }
  std::vector<float> zeroRow_;
  std::vector<Products> rowProducts_;
};

/// Calls body(j) for the rows [first, last) of a grid with `cells` cells: spread over the threads if that is
/// worth it.
template <class Body>
void forRows(ThreadPool& pool, long cells, int first, int last, Body&& body) {
  constexpr int kGrain = 8;
  constexpr long kWorthIt = 1 << 15;
  if (pool.threads() == 1 || cells < kWorthIt) {
    for (int j = first; j < last; ++j) body(j);
    return;
  }
  pool.blocks(first, last, kGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) body(j);
  });
}

}  // namespace smokebox
