#include "rigid/convex_queries.h"

#include <algorithm>

#include "rigid/lanes.h"

namespace smokebox::convex {

namespace {

constexpr int kFew = 16;  // corners

/// Every edge against every corner, four edges at a time.
Axis directSeparation(const ConvexPiece& p, const ConvexPiece& q, const Frame& qInP) {
  const int corners = static_cast<int>(q.points.size());
  const Turn turn = qInP.turn;
  double x[kFew], y[kFew];
  for (std::size_t k = 0; k < q.fours.size(); ++k) {
    const ConvexPiece::Four& four = q.fours[k];
    store(x + 4 * k, qInP.position.x + (turn.c * four.cornerX - turn.s * four.cornerY));
    store(y + 4 * k, qInP.position.y + (turn.s * four.cornerX + turn.c * four.cornerY));
  }
  Axis best{-1e300, 0, 0};
  for (std::size_t k = 0; k < p.fours.size(); ++k) {
    const ConvexPiece::Four& four = p.fours[k];
    Lanes nearest = four.normalX * x[0] + four.normalY * y[0];
    for (int j = 1; j < corners; ++j) {
      const Lanes along = four.normalX * x[j] + four.normalY * y[j];
      nearest = along < nearest ? along : nearest;
    }
    const Lanes separation = nearest - four.out;
    for (int l = 0; l < 4; ++l)
      if (separation[l] > best.separation) best = {separation[l], static_cast<int>(4 * k) + l, 0};
  }
  const ConvexPiece::Four& four = p.fours[best.edge / 4];
  const double nx = four.normalX[best.edge % 4], ny = four.normalY[best.edge % 4];
  double nearest = nx * x[0] + ny * y[0];
  for (int j = 1; j < corners; ++j) {
    const double along = nx * x[j] + ny * y[j];
    best.support = along < nearest ? j : best.support;
    nearest = along < nearest ? along : nearest;
  }
  return best;
}

}  // namespace

Axis largestSeparation(const ConvexPiece& p, const ConvexPiece& q, const Frame& qInP, double limit) {
  if (p.points.size() <= kFew && q.points.size() <= kFew) return directSeparation(p, q, qInP);
  const int np = static_cast<int>(p.normals.size());
  // The edge that faces the other's centre most is tried first. Any other cannot be better than its line is
  // from the disk within the other piece, and mostly that tells that it is worse.
  const Vec2 centre = toWorld(qInP, q.centre);
  int facing = 0;
  double farthest = -1e300;
  for (int k = 0; k < np; ++k) {
    const double away = dot(p.normals[k], centre - p.points[k]);
    facing = away > farthest ? k : facing;
    farthest = away > farthest ? away : farthest;
  }
  Axis best;
  int at = 0;
  const bool many = q.points.size() > 12;
  for (int step = 0, k = facing; step < np; ++step, k = k + 1 < np ? k + 1 : 0) {
    const Vec2 normal = p.normals[k];
    if (dot(normal, centre - p.points[k]) - q.within <= best.separation) continue;
    const Vec2 inward = -inverseRotate(qInP.turn, normal);
    at = many ? supportFrom(q, inward, step == 0 ? coarseSupport(q, inward) : at) : support(q, inward);
    const double separation = dot(normal, qInP.position - p.points[k]) - dot(inward, q.points[at]);
    if (separation <= best.separation) continue;
    best = {separation, k, at};
    if (separation > limit) return best;
  }
  return best;
}

bool inCone(const ConvexPiece& piece, int k, Vec2 direction) {
  if (piece.cones.empty()) return true;
  constexpr double kSlack = 1e-6;  // radians
  const auto& [start, end] = piece.cones[k];
  return dot(start + end, direction) > 0 && cross(start, direction) >= -kSlack &&
         cross(direction, end) >= -kSlack;
}

bool meets(const ConvexPiece& piece, Vec2 from, Vec2 to) {
  double enter = 0, leave = 1;
  // What is left of the segment behind the line through `corner`.
  const auto cut = [&](Vec2 normal, Vec2 corner) {
    const double a = dot(normal, from - corner) - piece.radius, b = dot(normal, to - corner) - piece.radius;
    if (a > 0 && b > 0) return false;
    if (a > 0) enter = std::max(enter, a / (a - b));
    if (b > 0) leave = std::min(leave, a / (a - b));
    return enter <= leave;
  };
  for (std::size_t k = 0; k < piece.normals.size(); ++k)
    if (!cut(piece.normals[k], piece.points[k])) return false;
  if (piece.points.size() != 2) return true;
  const Vec2 along = perpendicular(piece.normals[0]);  // a capsule has ends too
  return cut(along, piece.points[1]) && cut(-along, piece.points[0]);
}

}  // namespace smokebox::convex
