// Implicit viscosity with cut links to the wall (Gibou 2002): symmetric positive definite, second order in
// the velocity on curved and moving solids. Each component is solved by itself: by
// Chebyshev's iteration, for very large steps by conjugate gradients.
#pragma once
#include <memory>
#include <vector>

#include "base/threads.h"
#include "fluid/boundary.h"

namespace smokebox {

class Viscosity {
 public:
  struct Result {
    int iterations = 0;
    bool converged = false;
  };
  Viscosity(const Boundary& boundary, ThreadPool& pool);
  ~Viscosity();
  void rebuild(const Boundary& boundary);
  /// Beside a surface the second difference of a link of theta cells and one of a whole cell is
  /// (1 + theta) / 2 of the second derivative, and the pressure would have to make up for the rest. The
  /// wall's link is made stronger by 2 / (1 + theta); so is the other one, but its larger part is taken from
  /// u and v here and added by diffuse() to its right side: the matrix stays symmetric.
  void bendAtWalls(const Boundary& boundary, const Field& u, const Field& v);
  /// (1 - dt nu Laplacian) u_new = u; `viscosity` nu is kinematic, m^2/s.
  Result diffuse(const Boundary& boundary, Field& u, Field& v, double viscosity, double dt);
  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The slope of the velocity at the surface along each of the boundary's cut links, m/s a cell, into the
/// fluid: of the parabola through the surface's velocity and two faces, where there are two.
struct SurfaceShear {
  std::vector<float> u, v;  // of linksU, linksV
};
void findSurfaceShear(const Boundary& boundary, const Field& u, const Field& v, SurfaceShear& shear);

/// The share of the tangential velocity that a surface and an inviscid fluid have in common, applied to the
/// faces whose links end on a surface (without viscosity there is no boundary layer to do it).
void applySurfaceDrag(const Boundary& boundary, Field& u, Field& v);

}  // namespace smokebox
