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
  // Faces of a row within 16 columns that are done together: not cut, nor at a side of the domain. A bit for
  // each.
  struct Group {
    int i = 0;                // of the first
    std::uint16_t faces = 0;  // which ones
    std::array<std::uint16_t, 4> third{},
        fifth{};  // of which order they are at these flux points, else first
  };
  struct Component {
    std::vector<Face> faces;              // those that are done one by one
    std::vector<int> rowBegin;            // faces of row j: [rowBegin[j], rowBegin[j + 1])
    std::vector<Group> groups;            // the others
    std::vector<int> groupBegin;          // as rowBegin
    FaceMap use;                          // what a stencil may do with a face's value, see the .cpp
    std::vector<std::uint8_t> irregular;  // scratch of one row
  };

  void findUse(const Boundary& boundary, const VelocityExtension& extension, bool alongX, FaceMap& use) const;
  void findFaces(const Boundary& boundary, const VelocityExtension& extension, bool alongX);
  Order orderBetween(const FaceMap& use, int i, int j, int di, int dj, bool atWall) const;

  // Value between a and b of (m2 m1 a | b p1 p2) by each order, first to fifth: the even weights on a + b, m1
  // + p1, m2 + p2 less the sign of the flow times the odd weights on b - a, p1 - m1, p2 - m2.
  static constexpr float kEven[3][3] = {
      {1.0f / 2, 0, 0}, {9.0f / 16, -1.0f / 16, 0}, {150.0f / 256, -25.0f / 256, 3.0f / 256}};
  static constexpr float kOdd[3][3] = {
      {1.0f / 2, 0, 0}, {3.0f / 16, -1.0f / 16, 0}, {30.0f / 256, -15.0f / 256, 3.0f / 256}};

  static float carried(int order, const float* p, std::ptrdiff_t step, int own, float U);
  static void addToGroup(Component& c, int j, const Face& face);
  /// Those in groups, in rows [begin, end) within the domain.
  void advanceGroups(const AdvectionStage& stage, int begin, int end) const;

  Component u_, v_;
};

}  // namespace smokebox
