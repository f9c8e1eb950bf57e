// Where the stencil of each velocity component meets a surface before it reaches the next velocity.
#pragma once
#include "coupling/wall_velocity.h"

namespace smokebox {

/// Lists the links of u (or v) unsorted; needs the boundary's shares and wall velocities.
void findCutLinks(const CoveredBy& by, bool ofU, const Boundary& boundary, std::vector<CutLink>& links);

}  // namespace smokebox
