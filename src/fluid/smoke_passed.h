// Whether a thin wall has passed a cell in a step.
#pragma once
#include "fluid/smoke_transfer.h"

namespace smokebox {

/// Whether the part of a cell that counts as open has changed from one side of a thin wall to the other: the
/// cells that are never cut and that it is connected with near by are others now.
bool passedByWall(const SmokeCells& cells, int cell, const SmokeGeometry& before, const SmokeGeometry& after);

}  // namespace smokebox
