// Carries the velocity over a step of any size: each face takes the value at the foot of the path that led to
// it (second-order Runge-Kutta, Catmull-Rom interpolation limited to the four nearest values, so that nothing
// grows). A foot beyond a closed or open side is put on that side; where a solid is within reach, a path is
// followed from cell to cell and ends at the last fluid on its way.
#pragma once
#include <functional>
#include <vector>

#include "base/threads.h"
#include "fluid/boundary.h"

namespace smokebox {

class SemiLagrangian {
 public:
  explicit SemiLagrangian(ThreadPool& pool) : pool_(pool) {}

  /// Needed when boundary.version has changed.
  void rebuild() { shutBlocks_.clear(); }

  /// u, v must have been extended. Writes all open faces of outU and outV (and those repeated by a period).
  /// after(begin, end): what is to be done with these rows of both while they are in the cache.
  void carry(const Boundary& boundary, const Field& u, const Field& v, double dt, bool anySolid, Field& outU,
             Field& outV, const std::function<void(int begin, int end)>& after);

  std::size_t bytes() const { return shutBlocks_.size() * sizeof(int); }

 private:
  void findShutBlocks(const Boundary& boundary);
  /// Whether a face inside the domain is shut in columns [i0, i1], rows [j0, j1], or near them.
  bool anyShut(int i0, int i1, int j0, int j1) const;

  ThreadPool& pool_;
  // How many blocks of cells with a shut face inside the domain there are below and to the left: a
  // summed-area table, empty if unknown.
  std::vector<int> shutBlocks_;
  int blocksX_ = 0, blocksY_ = 0;
};

}  // namespace smokebox
