// What collisions and distances of convex pieces have in common: supports, separating axes, clipping of an
// edge.
#pragma once
#include "rigid/convex.h"

namespace smokebox::convex {

inline int next(const ConvexPiece& piece, int k) {
  return k + 1 < static_cast<int>(piece.points.size()) ? k + 1 : 0;
}
inline int previous(const ConvexPiece& piece, int k) {
  return k > 0 ? k - 1 : static_cast<int>(piece.points.size()) - 1;
}

/// The corner farthest along `direction` (own coordinates), of all corners.
inline int support(const ConvexPiece& piece, Vec2 direction) {
  const int n = static_cast<int>(piece.points.size());
  int best = 0;
  double most = dot(direction, piece.points[0]);
  for (int k = 1; k < n; ++k) {
    const double along = dot(direction, piece.points[k]);
    if (along > most) {
      most = along;
      best = k;
    }
  }
  return best;
}

/// The best of every 16th corner: a place for supportFrom() to start from.
inline int coarseSupport(const ConvexPiece& piece, Vec2 direction) {
  const int n = static_cast<int>(piece.points.size());
  int best = 0;
  for (int k = 16; k < n; k += 16)
    if (dot(direction, piece.points[k]) > dot(direction, piece.points[best])) best = k;
  return best;
}

/// The farthest corner, found by walking uphill from corner `from`.
inline int supportFrom(const ConvexPiece& piece, Vec2 direction, int from) {
  const int n = static_cast<int>(piece.points.size());
  if (n < 3) return support(piece, direction);
  double most = dot(direction, piece.points[from]);
  int best = from;
  for (int step = 0; step < n; ++step) {
    const int k = next(piece, best);
    const double along = dot(direction, piece.points[k]);
    if (along <= most) break;
    most = along;
    best = k;
  }
  if (best != from) return best;
  for (int step = 0; step < n; ++step) {
    const int k = previous(piece, best);
    const double along = dot(direction, piece.points[k]);
    if (along <= most) break;
    most = along;
    best = k;
  }
  return best;
}

/// An edge of one piece, how far the other lies outside its line (cores: radii left out), and which corner of
/// the other is nearest to that line.
struct Axis {
  double separation = -1e300;
  int edge = -1, support = -1;
};

/// The edge of `p` whose line is farthest from `q`; where there are many, the first that is farther than
/// `limit` will do.
Axis largestSeparation(const ConvexPiece& p, const ConvexPiece& q, const Frame& qInP, double limit);

/// Of the two edges at corner `k` the one that faces `direction` more.
inline int edgeFacing(const ConvexPiece& piece, int k, Vec2 direction) {
  const int before = previous(piece, k);
  return dot(piece.normals[before], direction) > dot(piece.normals[k], direction) ? before : k;
}

/// May something touch corner `k` with the outward normal `direction`? Always if the piece is the whole body.
bool inCone(const ConvexPiece& piece, int k, Vec2 direction);

/// Does the body's outline turn inward at corner `k`? The lines of both edges there bound what is outside.
inline bool isNotch(const ConvexPiece& piece, int k) {
  return !piece.cones.empty() && piece.cones[k][0] == Vec2{};
}

/// Does the segment meet the (rounded) piece? Own coordinates. At rounded corners up to 0.4 radius too
/// generous.
bool meets(const ConvexPiece& piece, Vec2 from, Vec2 to);

/// The point of the segment nearest to `p`; `share` from 0 at `from` to 1 at `to`.
inline Vec2 nearestOnSegment(Vec2 from, Vec2 to, Vec2 p, double& share) {
  const Vec2 along = to - from;
  const double size = dot(along, along), ahead = dot(p - from, along);
  share = !(ahead > 0) ? 0 : ahead >= size ? 1 : ahead / size;
  return share == 1 ? to : from + share * along;
}

}  // namespace smokebox::convex
