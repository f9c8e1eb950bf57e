// Carries the velocity over a step of any size: each face takes the value at the foot of the path that led to
// it (second-order Runge-Kutta, Catmull-Rom interpolation limited to the four nearest values, so that nothing
// grows). A foot beyond a closed or open side is put on that side, one inside a solid at the last fluid on
// its way.
#pragma once
#include "base/threads.h"
#include "fluid/boundary.h"

namespace smokebox {

/// u, v must have been extended. Writes all open faces of outU and outV (and those repeated by a period).
void carrySemiLagrangian(const Boundary& boundary, const Field& u, const Field& v, double dt, bool anySolid,
                         ThreadPool& pool, Field& outU, Field& outV);

}  // namespace smokebox
