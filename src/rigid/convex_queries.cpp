#include "rigid/convex_queries.h"

#include <algorithm>

namespace smokebox::convex {

Axis largestSeparation(const ConvexPiece& p, const ConvexPiece& q, const Frame& qInP, double limit) {
  const int np = static_cast<int>(p.normals.size()), nq = static_cast<int>(q.points.size());
  const Vec2* corners = q.points.data();
  Axis best;
  // Many corners: while the edge goes round, so does the support.
  const bool calipers = nq > 12;
  int at = 0;
  for (int k = 0; k < np; ++k) {
    const Vec2 normal = p.normals[k], inward = -inverseRotate(qInP.turn, normal);
    double most;
    if (calipers) {
      at = k == 0 ? support(q, inward) : supportFrom(q, inward, at);
      most = dot(inward, corners[at]);
    } else {
      at = 0;
      most = dot(inward, corners[0]);
      for (int j = 1; j < nq; ++j) {
        const double along = dot(inward, corners[j]);
        at = along > most ? j : at;
        most = along > most ? along : most;
      }
    }
    const double separation = dot(normal, qInP.position - p.points[k]) - most;
    if (separation > best.separation) {
      best = {separation, k, at};
      if (separation > limit) return best;
    }
  }
  return best;
}

bool inCone(const ConvexPiece& piece, int k, Vec2 direction) {
  if (piece.cones.empty()) return true;
  constexpr double kSlack = 1e-3;  // radians
  const auto& [start, end] = piece.cones[k];
  return dot(start + end, direction) > 0 && cross(start, direction) >= -kSlack &&
         cross(direction, end) >= -kSlack;
}

bool meets(const ConvexPiece& piece, Vec2 from, Vec2 to) {
  double enter = 0, leave = 1;
  for (std::size_t k = 0; k < piece.normals.size(); ++k) {
    const double a = dot(piece.normals[k], from - piece.points[k]) - piece.radius;
    const double b = dot(piece.normals[k], to - piece.points[k]) - piece.radius;
    if (a > 0 && b > 0) return false;
    if (a > 0) enter = std::max(enter, a / (a - b));
    if (b > 0) leave = std::min(leave, a / (a - b));
  }
  return enter <= leave;
}

}  // namespace smokebox::convex
