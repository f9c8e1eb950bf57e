// Gives every face a velocity that stencils may read: the margins beyond the domain's sides, and the closed
// faces inside solids.
//
//   sides    periodic: wrapped. slip: mirrored (tangential even, normal odd about the wall's). no-slip and
//   inflow: the
//            tangential component by the parabola through the wall's velocity and the two nearest faces, the
//            normal one even (its normal derivative is 0 there). open: the last value goes on.
//   solids   the first closed faces, and for stencils the open ones whose centre is covered: see
//            SurfaceGhosts. Two more layers: the neighbours before, the first of them in a straight line too.
//            Deeper: the wall's velocity.
//
// Near a surface without drag nothing is continued in a straight line: past a corner a flow without friction
// has no slope to go by, and a wrong one makes it noisy.
//
// The lists are found once in rebuild(); apply() only follows them.
#pragma once
#include <cstdint>
#include <vector>

#include "base/threads.h"
#include "fluid/boundary.h"
#include "fluid/face_map.h"
#include "fluid/surface_ghosts.h"

namespace smokebox {

class VelocityExtension {
 public:
  static constexpr int kLayers = 3;

  VelocityExtension(const Boundary& boundary, ThreadPool& pool);

  /// Needed when boundary.version has changed.
  void rebuild(const Boundary& boundary);

  /// Sets the closed faces and the margins of u and v. `bounded`: without new extremes, for steps so huge
  /// that what lies behind a surface is carried far into the fluid.
  void apply(const Boundary& boundary, Field& u, Field& v, bool bounded = false) const;

  /// Gives the closed faces the velocity of what closes them.
  void setWalls(const Boundary& boundary, Field& u, Field& v) const;

  /// Sets the open faces with covered centres to what stencils should see there. `hidden`: what they had more
  /// than that, to be given back with reveal().
  struct Hidden {
    std::vector<float> u, v;
  };
  void hideCovered(const Boundary& boundary, Field& u, Field& v, Hidden* hidden = nullptr) const;
  void reveal(const Hidden& hidden, Field& u, Field& v) const;
  /// Friction on the open faces with covered centres, implicit; `coefficient`: viscosity dt / h^2.
  void holdCovered(const Boundary& boundary, Field& u, Field& v, double coefficient) const;

  /// How far a face is from the fluid: 1 open, 2 to 1 + kLayers extended, 0 deep inside. Inside the domain
  /// only.
  const FaceMap& layerU() const { return u_.layer; }
  const FaceMap& layerV() const { return v_.layer; }
  /// Faces near a surface without much drag: 1.
  const FaceMap& slipU() const { return u_.slip; }
  const FaceMap& slipV() const { return v_.slip; }
  /// Whether any cell is shut (solids, as opposed to the domain's walls).
  bool anySolid() const { return u_.anySolid || v_.anySolid; }

  std::size_t bytes() const;

 private:
  struct Span {  // closed faces of one row
    int j, begin, end;
  };
  struct Ghost {  // value = weight * sum of (2 source - what lies behind it)
    int target = 0, sources[4] = {0, 0, 0, 0}, behind[4] = {0, 0, 0, 0}, count = 0;
    int countX = 0;  // the first of them lie along x: they are added up apart from the others
    float weight = 0;
  };
  struct Component {
    bool alongX = true;  // u: the component along x
    bool anySolid = false;
    FaceMap layer, slip;
    SurfaceGhosts surface;
    std::vector<Span> spans;
    std::vector<Ghost> ghosts;
    std::vector<std::size_t> layerEnds;
    std::vector<Vec2i> front, next;
  };

  void rebuild(const Boundary& boundary, Component& c);
  void setWalls(const Component& c, const Field& wall, Field& f) const;
  void apply(const Component& c, const Field& wall, const std::vector<CutLink>& links, bool bounded,
             Field& f) const;

  ThreadPool& pool_;
  Component u_, v_;
};

/// Fills the margins of u and v beyond the domain's sides; the faces on the walls must hold the wall's
/// velocity.
void fillMargins(const Boundary& boundary, Field& u, Field& v);

}  // namespace smokebox
