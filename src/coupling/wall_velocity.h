// The velocity of what closes each face, along the face's normal.
#pragma once
#include "coupling/covered_by.h"

namespace smokebox {

/// Sets boundary.wallU, wallV from the solids and the sides. The weights are all 0, and are so again
/// afterwards.
void setWallVelocities(const CoveredBy& by, Boundary& boundary, FaceWeights& ofU, FaceWeights& ofV);

/// Copies what lies beyond periodic sides from the other side, 0 beyond the others; repeats column nx, row
/// ny.
void wrapFaces(const Boundary& boundary, bool xFaces, Field& field);
void wrapCells(const Boundary& boundary, Field& field);

}  // namespace smokebox
