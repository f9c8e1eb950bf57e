// Carries the velocity along itself: conservative 5th-order upwind fluxes on the staggered grid with
// 4th-order transport velocity and deconvolved flux, Wicker-Skamarock RK3 (2002), the last pressure inside
// the stages; lower order beside walls and cut faces. Stable to max(|u|+|v|) dt/h = 1.5: above 1.4 it takes
// sub-steps (up to four); beyond that, and where solids that close a gap make it so within a step, a
// Catmull-Rom semi-Lagrangian step with lagged pressure, stable at any size.
//
// What comes in through an open side was at rest far away: its normal speed loses the head u^2/2 on the way
// in, its tangential speed is that of the face it meets.
#pragma once
#include <functional>
#include <memory>

#include "base/threads.h"
#include "fluid/boundary.h"

namespace smokebox {

class VelocityExtension;

class Advection {
 public:
  /// Makes a velocity of a middle stage roughly divergence-free by `cycles` iterations (0: a bare
  /// cycle), and adds `phiGain`
  /// times the increment to the lagged phi (whose impulse is that of a whole step): what follows then knows
  /// the pressure of now. That keeps the error of sub-steps at that of steps of their size, and saves an
  /// iteration at the end.
  using RoughProjection = std::function<void(Field& u, Field& v, int cycles, double phiGain)>;

  /// What one call of advance() did.
  struct Result {
    double courant = 0;  // max(|u|+|v|) dt/h at the start of the step
    int subSteps = 0;    // Runge-Kutta steps; 0: a semi-Lagrangian step, or the last one was
  };

  Advection(const Boundary& boundary, ThreadPool& pool);
  ~Advection();

  /// Finds the faces that need the low-order path; needed when boundary.version has changed.
  void rebuild(const Boundary& boundary);

  /// u, v: divergence-free velocity in; out: carried, with the accelerations (may be null) and the gradient
  /// of the lagged `phi` (m/s, see PressureSolver; the impulse of one whole step of dt) applied, not yet
  /// projected. The rough projections update phi. Closed faces and margins come out extended. A rough
  /// projection follows the second stage of each sub-step and ends each but the last.
  Result advance(const Boundary& boundary, Field& u, Field& v, const Field& phi, const Field* accelerationU,
                 const Field* accelerationV, double dt, const RoughProjection& projectRoughly);

  /// Fills the margins beyond the walls and the closed faces inside solids (see VelocityExtension), by the
  /// lists of the last rebuild(), with the wall velocities of `boundary`.
  void extend(const Boundary& boundary, Field& u, Field& v) const;

  /// Friction where a surface covers the centre of an open face (see VelocityExtension); `coefficient`:
  /// viscosity dt / h^2.
  void holdCovered(const Boundary& boundary, Field& u, Field& v, double coefficient) const;

  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// VelocityExtension built for one use: for setting up and for tests; a step uses Advection::extend.
void extendVelocity(const Boundary& boundary, Field& u, Field& v);

}  // namespace smokebox
