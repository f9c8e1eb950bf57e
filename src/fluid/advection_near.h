// The faces whose stencils meet a wall, a solid or an open side, and their rates by lower orders.
//
// A near face uses the advective form, the sum over its four flux points of U (q_point - q): equal to the
// flux form where the plain averages U are divergence-free, exactly 0 in a uniform flow beside a solid (where
// only the share-weighted fluxes are), and without a limit from small cut cells. Each point takes the highest
// order its neighbours allow:
//   fifth    six faces away from any wall
//   third    four faces of which the inner two are open or next to it and the outer two at least extended
//   first    upwind
//   inward   a tangential component at the domain's wall: third order through the wall's velocity where the
//            flow comes in, the face's own value where it goes out
//   ambient  a normal component at an open side: what comes in was at rest far away, so half of its speed is
//            lost (Bernoulli's head u^2/2); without that, vortices that leave feed energy back and grow
//   none     a tangential component at an open side: no gradient across it
// Beside a surface with drag the stencils read what VelocityExtension makes of the covered faces, to second
// order, and need no other rule: first-order fluxes there were the largest error of a drag. Beside one
// without much drag a face that is open by less than half is of first order, and the flow is the whole flux
// through a face, the fluid's and the surface's, whose divergence is 0 in cut cells too, over the open area
// (no less than half a cell's): at sharp corners in a fluid without friction anything else grows noise.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "fluid/advection_kernel.h"
#include "fluid/boundary.h"
#include "fluid/extend.h"

namespace smokebox {

class NearFaces {
 public:
  explicit NearFaces(const Boundary& boundary);

  void rebuild(const Boundary& boundary, const VelocityExtension& extension, ThreadPool& pool);

  /// Overwrites what the whole-row kernel wrote on near faces of rows [begin, end); row ny is v's last.
  void advanceRows(const Boundary& boundary, const AdvectionStage& stage, int begin, int end) const;

  std::size_t count() const { return u_.faces.size() + v_.faces.size(); }
  std::size_t bytes() const;

 private:
  enum Order : std::uint8_t { first, third, fifth, inward, ambient, none };  // the last three: at sides only
  struct Face {
    int i = 0;
    float perVolume = 1;           // one over the open share of the area that the face stands for
    bool cut = false;              // the flow around it is partly that of a surface
    bool atSide = false;           // some order is of the kind that only the domain's sides have
    std::array<Order, 4> order{};  // at the flux points before and after it along x, then along y
  };
  struct Component {
    std::vector<Face> faces;
    std::vector<int> rowBegin;            // faces of row j: [rowBegin[j], rowBegin[j + 1])
    FaceMap use;                          // what a stencil may do with a face's value, see the .cpp
    std::vector<std::uint8_t> irregular;  // scratch of one row
  };

  void findUse(const Boundary& boundary, const VelocityExtension& extension, bool alongX, FaceMap& use) const;
  void findFaces(const Boundary& boundary, const VelocityExtension& extension, bool alongX);
  Order orderBetween(const FaceMap& use, int i, int j, int di, int dj, bool atWall) const;

  Component u_, v_;
};

}  // namespace smokebox
