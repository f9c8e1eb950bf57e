// What a velocity component is just behind a surface: recipes that continue it, to second order, to the first
// faces whose centres the solid covers.
//
// Each cut link that ends on a surface (Gibou 2002) gives a straight line through the velocity that it starts
// from (or, where that lies nearer than half a cell to the surface, the one before) and the surface's own;
// several links to one face are weighed by the square of the surface's normal, found from where they end.
// Without drag the fluid's velocity goes on by itself, from two faces of each row or column. In between they
// are mixed by the drag.
//
// Some of these faces are partly open. The velocity that is kept there is the mean over the open part, which
// the projection needs; with drag, what stencils should see at the covered centre is another value.
#pragma once
#include <algorithm>
#include <vector>

#include "fluid/boundary.h"
#include "fluid/face_map.h"

namespace smokebox {

/// value = own * (value that stands there) + sum of weights * faces + sum of weights * velocities of links.
/// What lies along x is added up apart from what lies along y, so that mirror images have the same sums.
struct GhostRecipe {
  static constexpr int kMostSources = 8, kMostLinks = 4;
  int target = 0, sources[kMostSources] = {}, count = 0;
  int links[kMostLinks] = {}, linkCount = 0;
  bool across[kMostSources] = {}, linkAcross[kMostLinks] = {};  // along y
  float weights[kMostSources] = {}, linkWeights[kMostLinks] = {};
  float own = 0;

  void add(int source, bool alongY, double weight) {
    sources[count] = source;
    across[count] = alongY;
    weights[count++] = static_cast<float>(weight);
  }
  void addLink(int link, bool alongY, double weight) {
    links[linkCount] = link;
    linkAcross[linkCount] = alongY;
    linkWeights[linkCount++] = static_cast<float>(weight);
  }
  float value(const float* faces, const std::vector<CutLink>& cut) const {
    float sum[2] = {}, ofLinks[2] = {};
    for (int k = 0; k < count; ++k) sum[across[k]] += weights[k] * faces[sources[k]];
    for (int k = 0; k < linkCount; ++k) ofLinks[linkAcross[k]] += linkWeights[k] * cut[links[k]].velocity;
    return own * faces[target] + (sum[0] + sum[1]) + (ofLinks[0] + ofLinks[1]);
  }
  /// The same, within the range of what it is made of.
  float boundedValue(const float* faces, const std::vector<CutLink>& cut) const {
    float least = 3e38f, most = -3e38f;
    auto include = [&](float q) { least = std::min(least, q), most = std::max(most, q); };
    for (int k = 0; k < count; ++k) include(faces[sources[k]]);
    for (int k = 0; k < linkCount; ++k) include(cut[links[k]].velocity);
    return std::clamp(value(faces, cut), least, most);
  }
};

/// A partly open face whose centre is covered: friction draws the mean over its open part towards `share` of
/// the way from the surface's velocity to that of the nearest face in the open.
struct CoveredFace {
  int target = 0, source = 0, link = 0;
  float share = 0;
  float stiffness = 0;  // times viscosity dt / h^2
};

class SurfaceGhosts {
 public:
  std::vector<GhostRecipe> covered, closed;  // of partly open faces with drag; of closed faces
  std::vector<CoveredFace> held;
  std::vector<Vec2i> deeper;  // what find() had no recipe for

  /// `front`: the closed faces beside open ones; columns x rows: the faces of the component.
  void find(const Boundary& boundary, bool alongX, int columns, int rows, const std::vector<Vec2i>& front);
  std::size_t bytes() const;

 private:
  struct Arrival {
    int target, link;
  };
  class Finder;
  std::vector<Arrival> arrivals_;  // links by the face that they lead to
  FaceMap kind_;                   // scratch: which faces have links of their own, which are covered
};

}  // namespace smokebox
