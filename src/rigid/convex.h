// Convex pieces of rigid bodies, and where a body is. A body's own coordinates have their origin at its
// centre of mass (a scripted solid's at the point that it turns about); a frame takes them into the world.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "base/maths.h"
#include "geometry/vec2.h"

namespace smokebox {

/// A rotation as cosine and sine.
struct Turn {
  double c = 1, s = 0;
};
inline Vec2 rotate(Turn q, Vec2 v) { return {q.c * v.x - q.s * v.y, q.s * v.x + q.c * v.y}; }
inline Vec2 inverseRotate(Turn q, Vec2 v) { return {q.c * v.x + q.s * v.y, q.c * v.y - q.s * v.x}; }
inline Turn turnBy(double angleRad) { return {exact::cos(angleRad), exact::sin(angleRad)}; }

/// world = position + rotate(turn, own).
struct Frame {
  Vec2 position;
  Turn turn;
};
inline Vec2 toWorld(const Frame& frame, Vec2 own) { return frame.position + rotate(frame.turn, own); }
inline Vec2 toLocal(const Frame& frame, Vec2 world) {
  return inverseRotate(frame.turn, world - frame.position);
}

/// `inner` in the coordinates of `outer`: toLocal(outer, toWorld(inner, p)) = toWorld(relative(outer, inner),
/// p).
inline Frame relativeFrame(const Frame& outer, const Frame& inner) {
  const Turn a = outer.turn, b = inner.turn;
  return {toLocal(outer, inner.position), {a.c * b.c + a.s * b.s, a.c * b.s - a.s * b.c}};
}

/// One convex piece of a body, in the body's own coordinates: 1 point (a disk), 2 points (a capsule) or a
/// counterclockwise convex polygon, rounded by `radius`.
struct ConvexPiece {
  std::vector<Vec2> points;
  std::vector<Vec2> normals;  // [k]: outward, of the edge from points[k] to points[k + 1]; a disk has none
  std::vector<std::uint8_t> inner;  // [k]: that edge lies inside the body, between two pieces: no contacts
  double radius = 0;
  Vec2 centre;
  double reach = 0;   // largest distance of the (rounded) piece from `centre`
  double within = 0;  // the disk of this radius about `centre` lies within the core
  /// The same four at a time: corners, and the lines of the edges that begin there, `out` from (0, 0) along
  /// the normal. Lanes that are left over have corner 0 and a line at which nothing arrives.
  typedef double Lanes __attribute__((vector_size(32)));
  struct Four {
    Lanes cornerX, cornerY, normalX, normalY, out;
  };
  std::vector<Four> fours;

  bool whole = true;    // no edge is inner
  bool buried = false;  // every edge is inner
  /// [k]: outward normals of the body's outline before and after points[k]; both (0, 0) at a corner that
  /// points into the body, where nothing can touch. Empty if the piece is whole: then they are its own
  /// normals.
  std::vector<std::array<Vec2, 2>> cones;
  /// So far about a corner that points into the body the lines of its edges bound what is outside, m: less
  /// than the body is thick, lest what touches its other side meets them.
  double notchReach = 0;
};

/// A piece of a body of one piece: 1, 2 or more points (convex, counterclockwise), no inner edges.
ConvexPiece makePiece(std::vector<Vec2> points, double radius);
/// Normals, centre, reach and flags, after points, radius, inner (may be empty: none) and cones are set.
void finishPiece(ConvexPiece& piece);

}  // namespace smokebox
