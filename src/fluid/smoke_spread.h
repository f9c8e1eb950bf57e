// Keeps the smoke under its ceiling: what a cell holds above the largest value before the step (by a velocity
// that is not quite free of divergence, or volumes that a moving solid changed) goes to the nearest cells
// that have room for it. What finds no room stays, and the value stays at the ceiling, as long as it is no
// more than masses may be off by rounding (3e-5 of the ceiling).
//
// And keeps it above the floor: where more was taken from a cell than it held (a solid that jumps over many
// cells in a step), the nearest cells that can be reached from it give it back.
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
  /// Fills cells with less than nothing up to nothing. Returns whether all could be.
  bool fill(const SmokeCells& cells, const Boundary& boundary, const Field& volume, Field& mass, Field& value,
            Activity& active);
  std::size_t bytes() const { return (seen_.capacity() + queue_.capacity()) * sizeof(int); }

 private:
  std::vector<int> seen_, queue_;
  int search_ = 0;
};

}  // namespace smokebox
