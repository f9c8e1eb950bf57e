// Contact of two convex pieces: up to two points and one normal.
// Separating axes over the edges' normals; the face of largest separation is the reference, the other piece's
// edge is clipped to it (as in Box2D). That axis also tells the closest features of pieces that are apart:
// the closest point of the difference of two convex sets lies on its face of largest distance. So gaps and
// normals are exact at any distance, corner against corner too. Edges and corners inside a body give no
// normal.
#pragma once
#include <cstdint>

#include "rigid/convex.h"

namespace smokebox {

struct ManifoldPoint {
  Vec2 point;                 // world, midway between the two surfaces
  double gap = 0;             // below 0: overlap
  std::uint32_t feature = 0;  // the same while the same edge and corner meet
};

struct Manifold {
  Vec2 normal;  // from A to B, world
  int count = 0;
  ManifoldPoint points[2];
  int face = 0;  // whose edge gives the normal, and meets sharp corners: 1 A, 2 B; 0: corners or round ones
  double apart = 0;  // where there is no contact: the gap is at least so large
};

/// Contact of two pieces whose gap is below `margin` (at the closest); false: farther apart, or only through
/// edges inside a body. O(na + nb), for few corners O(na nb).
bool collide(const ConvexPiece& a, const Frame& fa, const ConvexPiece& b, const Frame& fb, double margin,
             Manifold& manifold);

}  // namespace smokebox
