// Puts the solids and the domain's walls onto the grid: fills a Boundary from outlines and their velocities.
//
// - Closed walls (slip, no-slip, inflow) have share 0 on the faces of their side; an open side keeps what the
// solids leave
//   of it; on a periodic side column nx (row ny) repeats column (row) 0, and solids that stick out come in
//   again.
// - Margins beyond the domain: 0, except beyond periodic sides, where they repeat the other side.
// - wallU, wallV: mean over what closes the face (solids by covered length, the inflow for the rest of an
// inflow's face),
//   each at the middle of its piece; exact for rigid motion. A face inside a solid has the solid's velocity
//   at its centre; one shut because a thin wall cuts the cell beside it, that wall's.
// - Links are listed for faces that are open at least in part, whose centre no solid covers, and that no wall
// of the
//   domain fixes. Those that meet a solid are listed whatever its drag, 0 too. The domain's walls: along the
//   surface theta 1/2 with drag 1 for no-slip and inflow, none for slip, open and periodic ones; along the
//   normal the wall's own face, theta 1, drag 1, velocity wallU (wallV) there, for all closed walls: a given
//   value, not a friction. A link to a face that is shut though no solid lies between has theta 1. The
//   repeated faces of a periodic side have none.
#pragma once
#include <vector>

#include "coupling/mixed_groups.h"
#include "fluid/boundary.h"
#include "fluid/viscosity.h"
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

/// Working memory: the sums over what covers a face. In float64, where the order, which is not the mirror
/// image's, is all one.
struct FaceSum {
  int i = 0, j = 0;
  double share = 0, flux = 0;  // of the face; velocity times share
  double fastest = 0;
};
struct FaceWeights {
  Field covered;  // 1 + place in `touched`, then the share; 0: none
  std::vector<FaceSum> touched;
};

class SolidsOnGrid {
 public:
  /// Sets the boundary's fields for these solids; boundary.grid and boundary.sides are set already.
  /// `shapesMoved`: the fractions have to be found anew (else only the velocities are).
  void cover(const std::vector<MovingSolid>& solids, bool shapesMoved, Boundary& boundary);

  /// The geometry behind the fractions, in terms of copies(): solids and their images beyond periodic sides.
  /// Its fields are the boundary's.
  const GridCover& geometry() const { return cover_; }
  struct Copy {
    int solid = 0;
    Vec2 shift;  // where the image lies from the solid itself
  };
  const std::vector<Copy>& copies() const { return copies_; }
  /// Shifts of the images of a solid that reach the domain, 0 for itself: more than one beside periodic
  /// sides.
  static std::vector<Vec2> imagesOf(const MovingSolid& solid, const Boundary& boundary);

 private:
  void placeCopies(const std::vector<MovingSolid>& solids, const Boundary& boundary);

  GridCover cover_;
  std::vector<Copy> copies_;
  std::vector<SolidOutline> outlines_;  // of the copies
  MixedGroups mixed_;                   // among the copies
  FaceWeights weightsU_, weightsV_;
  std::vector<CutLink> sorted_;
  std::vector<int> rowStart_;
};

/// Force (N/m) and torque (N m/m, about the solid's origin) of the fluid on each solid from the pressure (Pa,
/// at cell centres) and, if viscosity is not 0, from the shear in the cut links (none if that is empty). The
/// pressure on the surface is that of the parabola, plane or line through the nearest cells on the fluid's
/// side, so a pressure that is linear in space gives the exact force.
struct SurfaceForce {
  Vec2 force;
  double torque = 0;
};
std::vector<SurfaceForce> surfaceForces(const Boundary& boundary, const std::vector<MovingSolid>& solids,
                                        const Field& pressure, const SurfaceShear& shear,
                                        double dynamicViscosity);

}  // namespace smokebox
