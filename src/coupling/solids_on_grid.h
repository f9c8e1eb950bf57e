// Puts the solids and the domain's walls onto the grid: fills a Boundary from outlines and their velocities.
#pragma once
#include <vector>

#include "fluid/boundary.h"
#include "geometry/coverage.h"

namespace smokebox {

/// A solid at one moment, as the fluid sees it.
struct MovingSolid {
  std::vector<Outline> outlines;  // world coordinates
  Vec2 origin;                    // the point that moves at `velocity`
  Vec2 velocity;                  // m/s
  double spin = 0;                // rad/s about `origin`
  double drag = 0;                // 0 full slip .. 1 no slip

  Vec2 velocityAt(Vec2 p) const { return velocity + spin * perpendicular(p - origin); }
};

class SolidsOnGrid {
 public:
  /// Sets the boundary's fields for these solids; boundary.grid and boundary.sides are set already. `shapesMoved`: the
  /// fractions have to be found anew (else only the velocities are).
  void cover(const std::vector<MovingSolid>& solids, bool shapesMoved, Boundary& boundary);

 private:
  GridCover cover_;
};

/// Force (N/m) and torque (N m/m, about the solid's origin) of the fluid on each solid from the pressure (Pa, at cell
/// centres) and, if viscosity is not 0, from the shear in the cut links.
struct SurfaceForce {
  Vec2 force;
  double torque = 0;
};
std::vector<SurfaceForce> surfaceForces(const Boundary& boundary, const std::vector<MovingSolid>& solids,
                                        const Field& pressure, const Field& u, const Field& v, double dynamicViscosity);

}  // namespace smokebox
