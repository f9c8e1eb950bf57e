// One Runge-Kutta stage of the momentum equations over whole rows, as if every face were far from any wall:
//
//   out = base + rateScale * (-h div(U q)) + accelerationScale * acceleration - phiScale * grad phi
//
// Values at the flux points: 5th-order upwind (6-point interpolation and its dissipation); transport
// velocity: 4-point interpolation; difference (27 (F1 - F0) - (F2 - F_1)) / 24, which is the plain difference
// of the deconvolved flux (26 F_k - F_(k-1) - F_(k+1)) / 24 and so conservative. Mirrored input gives
// mirrored output to the bit.
#pragma once
#include "base/field.h"

namespace smokebox {

struct AdvectionStage {
  const Field *u = nullptr, *v = nullptr;          // what is carried and carries; extended
  const Field *baseU = nullptr, *baseV = nullptr;  // velocity at the start of the step
  Field *outU = nullptr, *outV = nullptr;          // neither the base nor what is carried
  const Field* phi = nullptr;
  const Field *accelerationU = nullptr, *accelerationV = nullptr;  // may be null
  float rateScale = 0, phiScale = 0, accelerationScale = 0;        // dt/h, share of phi, dt of the stage
  bool periodicX = false, periodicY = false;
};

/// Rows [begin, end) of u (columns 0..nx-1).
void advanceRowsOfU(const AdvectionStage& stage, int begin, int end);
/// Rows [begin, end) of v (rows up to ny-1).
void advanceRowsOfV(const AdvectionStage& stage, int begin, int end);

}  // namespace smokebox
