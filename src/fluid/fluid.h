// The fluid's velocity and the stages that move it through one step, each built only when a scene needs it.
//
// Order in a step (NUMERICS: Wicker-Skamarock RK3 with the last pressure inside): accelerations are
// collected, the velocity is carried together with them and the lagged pressure gradient, diffused, driven by
// sources, and projected for the correction to the pressure.
#pragma once
#include <memory>
#include <optional>

#include "fluid/advection.h"
#include "fluid/boundary.h"
#include "fluid/pressure.h"
#include "fluid/viscosity.h"
#include "fluid/vorticity.h"

namespace smokebox {

class Fluid {
 public:
  struct Parts {
    bool viscous = false;       // a viscosity that is not 0, now or after an event
    bool confined = false;      // vorticity confinement
    bool forced = false;        // any acceleration: viscosity, confinement, buoyancy, a force on a region
    bool inviscidDrag = false;  // a surface with drag in a fluid without viscosity
  };

  Fluid(const Boundary& boundary, const Parts& parts, ThreadPool& pool);

  /// The fractions have changed: refreshes what the stages keep of them.
  void boundaryChanged(const Boundary& boundary);

  /// Solids are about to move away from `before`: the faces that they uncover must hold the fluid's velocity.
  void prepareUncovering(const Boundary& before);

  /// Sets the accelerations to what viscosity did in the last step (0 without it) and what vorticity
  /// confinement does (of this strength; 0: nothing); the scene's own are then added to accelerationU() and
  /// accelerationV(), m/s^2. With the last viscous acceleration and the last pressure inside, the stages of a
  /// steady flow are in balance: without it each middle projection would answer to the missing friction, and
  /// the velocity beside a wall, and with it the drag, would be off by a share of the step.
  void beginForces(const Boundary& boundary, double confinement, double length);
  void advect(const Boundary& boundary, double dt);
  /// Takes the last viscous acceleration out again and puts that of this step in, implicitly.
  void diffuse(const Boundary& boundary, double viscosity, double dt);
  /// Drives the fluid inside a shape at a velocity: share (0..1) of each cell's area.
  void drive(const Boundary& boundary, const Field& share, double velocityX, double velocityY);
  void applySurfaceDrag(const Boundary& boundary);
  PressureSolver::Result project(const Boundary& boundary, double dt, double tolerance, int maxIterations);

  /// Sets the lagged pressure to 0.
  void forgetPressure() {
    phi_.fill(0);
    pressure_.forget();
  }

  /// m/s on the faces.
  Field& u() { return u_; }
  Field& v() { return v_; }
  const Field& u() const { return u_; }
  const Field& v() const { return v_; }
  /// Accelerations on the faces; only with parts.forced.
  Field& accelerationU() { return accelerationU_; }
  Field& accelerationV() { return accelerationV_; }
  /// Impulse of the pressure in a step, m/s at cell centres: pressure = density h phi / dt.
  const Field& phi() const { return phi_; }

  /// How the last step was cut into sub-steps, and why.
  const Advection::Result& carried() const { return carried_; }

  /// What friction did at the surfaces in the last step: before the projection, which moves the faces there a
  /// little, and so the slope a lot where they lie close to the surface. Empty before the first step.
  const SurfaceShear& shear() const { return shear_; }
  /// A copy of the velocity that also fills the walls' margins and the surroundings of surfaces inside
  /// solids.
  struct ExtendedVelocity {
    Field u, v;
  };
  ExtendedVelocity extended(const Boundary& boundary) const;

  std::size_t bytes() const;

 private:
  void startForces();

  Parts parts_;
  Field u_, v_, phi_;
  Field accelerationU_, accelerationV_;
  Field viscousU_, viscousV_;  // acceleration by viscosity in the last step, m/s^2
  SurfaceShear shear_;
  Advection::Result carried_;
  ThreadPool& pool_;
  PressureSolver pressure_;
  Advection advection_;
  std::optional<Viscosity> viscosity_;
  std::optional<Confinement> confinement_;
};

}  // namespace smokebox
