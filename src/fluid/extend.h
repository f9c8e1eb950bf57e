// Gives every face a velocity that stencils may read: the margins beyond the domain's sides, and the closed
// faces inside solids.
//
//   sides    periodic: wrapped. slip: mirrored (tangential even, normal odd about the wall's). no-slip and
//   inflow: the
//            tangential component by the parabola through the wall's velocity and the two nearest faces, the
//            normal one even (its normal derivative is 0 there). open: the last value goes on.
//   solids   kLayers closed faces deep, layer by layer: neighbours across the component's own direction give
//   the fluid's
//            velocity, mixed with the wall's by the surface's drag; neighbours along it give the wall's
//            velocity (the component is normal to the surface there). Deeper: the wall's velocity.
//
// Each component by itself, so a slip surface at 45 degrees gets half of each rule: first order there.
// The lists are found once in rebuild(); apply() only follows them.
#pragma once
#include <cstdint>
#include <vector>

#include "base/threads.h"
#include "fluid/boundary.h"
#include "fluid/face_map.h"

namespace smokebox {

class VelocityExtension {
 public:
  static constexpr int kLayers = 3;

  VelocityExtension(const Boundary& boundary, ThreadPool& pool);

  /// Needed when boundary.version has changed.
  void rebuild(const Boundary& boundary);

  /// Sets the closed faces and the margins of u and v.
  void apply(const Boundary& boundary, Field& u, Field& v) const;

  /// How far a face is from the fluid: 1 open, 2 to 1 + kLayers extended, 0 deep inside. Inside the domain
  /// only.
  const FaceMap& layerU() const { return u_.layer; }
  const FaceMap& layerV() const { return v_.layer; }
  /// Whether any cell is shut (solids, as opposed to the domain's walls).
  bool anySolid() const { return u_.anySolid || v_.anySolid; }

  std::size_t bytes() const;

 private:
  struct Span {  // closed faces of one row
    int j, begin, end;
  };
  struct Ghost {  // value = wallShare * wall + weight * sum of the sources
    int target = 0, sources[4] = {0, 0, 0, 0}, count = 0;
    float weight = 0, wallShare = 0;
  };
  struct Component {
    bool alongX = true;  // u: the component along x
    bool anySolid = false;
    FaceMap layer;
    Field drag;  // of the link that ends on a closed face; 0 elsewhere
    std::vector<Span> spans;
    std::vector<Ghost> ghosts;
    std::vector<std::size_t> layerEnds;
    std::vector<Vec2i> front, next;
  };

  void rebuild(const Boundary& boundary, Component& c);
  void apply(const Component& c, const Field& wall, Field& f) const;

  ThreadPool& pool_;
  Component u_, v_;
};

/// Fills the margins of u and v beyond the domain's sides; the faces on the walls must hold the wall's
/// velocity.
void fillMargins(const Boundary& boundary, Field& u, Field& v);

}  // namespace smokebox
