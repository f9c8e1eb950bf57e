// Vorticity at nodes, and vorticity confinement (Fedkiw, Stam and Jensen 2001, section 3.2; Steinhoff and
// Underhill 1994).
#pragma once
#include "base/threads.h"
#include "fluid/boundary.h"

namespace smokebox {

/// Curl of the velocity at the nodes, 1/s: node (i, j) is the lower left corner of cell (i, j), i = 0..nx, j
/// = 0..ny. `u`, `v` must have been extended (Advection::extend).
void vorticityAtNodes(const Boundary& boundary, const Field& u, const Field& v, ThreadPool& pool,
                      Field& omega);

/// Adds the acceleration e L (N x omega), N = grad|omega| / |grad|omega||, to the accelerations on the faces
/// (m/s^2). L: a length that does not change with the resolution (shorter side / 256). No power is added
/// inside solids: nodes that touch a shut face give no force, shut faces take none. N fades where
/// |grad|omega|| is below a thousandth of its largest value, so that still regions stay still; without
/// vorticity the force is exactly 0.
class Confinement {
 public:
  Confinement(const Boundary& boundary, ThreadPool& pool);
  /// u, v: extended. `fromNothing`: what the accelerations hold does not count.
  void addForce(const Boundary& boundary, const Field& u, const Field& v, double strength, double length,
                Field& accelerationU, Field& accelerationV, bool fromNothing = false);
  std::size_t bytes() const;

 private:
  /// Square of the largest |grad|omega||.
  double steepestSquare();
  /// The force at `count` nodes of row j from column `first` on.
  void forceAtNodes(const Boundary& boundary, int j, int first, int count, float scale, float fadeSquare,
                    float* fx, float* fy) const;

  ThreadPool& pool_;
  Field omega_;             // at nodes
  float perTwoMetres_ = 0;  // 1 / (2 h)
};

}  // namespace smokebox
