// Keeps the smoke under its ceiling: what a cell holds above the largest value before the step (by a velocity
// that is not quite free of divergence, or volumes that a moving solid changed) goes to the nearest cells
// that have room for it. What finds no room stays, and the value stays at the ceiling, as long as it is no
// more than masses may be off by rounding (3e-5 of the ceiling).
#pragma once
#include <vector>

#include "fluid/smoke_cells.h"
#include "fluid/sweep.h"

namespace smokebox {

class MassSpread {
 public:
  /// Returns the largest value afterwards: `highest`, or more where the neighbourhood is full (a pocket that
  /// is squeezed).
  /// `volume`: what the cells carry.
  float run(const SmokeCells& cells, const Boundary& boundary, const Field& volume, float highest,
            Quantum quantum, Field& mass, Field& value, Activity& active);
  std::size_t bytes() const { return (seen_.capacity() + queue_.capacity()) * sizeof(int); }

 private:
  std::vector<int> seen_, queue_;
  int search_ = 0;
};

}  // namespace smokebox
