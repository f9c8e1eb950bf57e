#include "rigid/contact_points.h"

#include <algorithm>

namespace smokebox::convex {

std::uint32_t featureOf(const Side& side, int onReference, int onOther, bool cornerOfReference) {
  const int onA = side.flipped ? onOther : onReference, onB = side.flipped ? onReference : onOther;
  const std::uint32_t cornerOfA = cornerOfReference != side.flipped ? 1 : 0;
  return cornerOfA << 31 | (static_cast<std::uint32_t>(onA) & 0x7fff) << 16 |
         (static_cast<std::uint32_t>(onB) & 0xffff);
}

void addPoint(const Side& side, Vec2 point, double apart, Vec2 normal, std::uint32_t feature,
              Manifold& manifold) {
  const double a = side.reference.radius, b = side.other.radius;
  ManifoldPoint& added = manifold.points[manifold.count++];
  added.gap = apart - a - b;
  added.point = toWorld(side.frame, point + (0.5 * (a - b - apart)) * normal);
  added.feature = feature;
}

void setNormal(const Side& side, Vec2 normal, Manifold& manifold) {
  const Vec2 world = rotate(side.frame.turn, normal);
  manifold.normal = side.flipped ? -world : world;
}

namespace {
void setFace(const Side& side, Manifold& manifold) {
  manifold.face = side.other.radius > 0 ? 0 : side.flipped ? 2 : 1;
}
}  // namespace

void touchCorner(const Side& side, Vec2 nearest, Vec2 point, double apart, std::uint32_t feature,
                 Manifold& manifold) {
  const Vec2 normal = (1 / apart) * (point - nearest);
  manifold.count = 0;
  addPoint(side, point, apart, normal, feature, manifold);
  setNormal(side, normal, manifold);
}

void edgesBeside(const Side& side, int corner, int otherCorner, Vec2 normal, double margin,
                 Manifold& manifold) {
  const ConvexPiece &p = side.reference, &q = side.other;
  const Vec2 left = perpendicular(normal), from = p.points[corner];
  auto ofOther = [&](int k) { return toWorld(side.otherInReference, q.points[k]) - from; };
  const Vec2 above = ofOther(otherCorner);
  ManifoldPoint nearest;
  nearest.gap = margin + p.radius + q.radius;
  bool found = false;
  // Seen along the normal, the reference's outline goes on to the left, and the other one's comes from there.
  for (const bool isLeft : {true, false}) {
    const int edge = isLeft ? corner : previous(p, corner),
              otherEdge = isLeft ? previous(q, otherCorner) : otherCorner;
    if (p.inner[edge] || q.inner[otherEdge]) continue;
    const int end = isLeft ? next(p, corner) : edge, otherEnd = isLeft ? otherEdge : next(q, otherCorner);
    const Vec2 along = isLeft ? left : -left, to = p.points[end] - from, otherTo = ofOther(otherEnd);
    const double reach = dot(along, to), otherReach = dot(along, otherTo);
    if (!(reach > 0 && otherReach > 0)) continue;
    // Where the shorter one ends.
    const bool isOwn = reach < otherReach;
    const Vec2 on = isOwn ? to : (otherReach / reach) * to,
               over = isOwn ? above + (reach / otherReach) * (otherTo - above) : otherTo;
    const double gap = dot(normal, over - on);
    if (gap > nearest.gap) continue;
    found = true;
    nearest = {from + over, gap,
               isOwn ? featureOf(side, end, otherEdge, true) : featureOf(side, edge, otherEnd, false)};
  }
  if (found) addPoint(side, nearest.point, nearest.gap, normal, nearest.feature, manifold);
}

void cornerOnFace(const Side& side, int k, int corner, Manifold& manifold) {
  const Vec2 normal = side.reference.normals[k];
  const Vec2 at = toWorld(side.otherInReference, side.other.points[corner]);
  manifold.count = 0;
  addPoint(side, at, dot(normal, at - side.reference.points[k]), normal, featureOf(side, k, corner, false),
           manifold);
  setNormal(side, normal, manifold);
  setFace(side, manifold);
}

namespace {

/// May something touch the line of edge `k`, which is of `size`, where it is `along`, beyond an end of it? It
/// may next to a notch: it touches the edge that follows there, and the least that it moves takes it back.
bool isNextToNotch(const ConvexPiece& piece, int k, double along, double size, double margin) {
  const double most = std::min(margin, piece.notchReach);
  if (along < 0) return -along <= most && isNotch(piece, k);
  return along - size <= most && isNotch(piece, next(piece, k));
}

/// Edge `incident` of the other piece clipped to edge `k` of the reference; points farther than `margin` are
/// left out.
bool clipToFace(const Side& side, int k, int incident, double margin, Manifold& manifold) {
  const ConvexPiece &p = side.reference, &q = side.other;
  const Vec2 normal = p.normals[k], along = perpendicular(normal), from = p.points[k];
  const double size = dot(along, p.points[next(p, k)] - from);
  const int ends[2] = {incident, next(q, incident)};
  Vec2 at[2];
  double x[2];
  for (int e = 0; e < 2; ++e) {
    at[e] = toWorld(side.otherInReference, q.points[ends[e]]);
    x[e] = dot(along, at[e] - from);
  }
  manifold.count = 0;
  const double slack = 1e-9 * (p.reach + q.reach), reach = margin + p.radius + q.radius;
  const auto isBeyond = [&](int e) {
    return (x[e] < -slack || x[e] > size + slack) && !isNextToNotch(p, k, x[e], size, margin);
  };
  for (int e = 0; e < 2; ++e) {
    Vec2 point = at[e];
    std::uint32_t feature = featureOf(side, k, ends[e], false);
    if (isBeyond(e)) {
      const double end = x[e] < 0 ? 0 : size;
      const double other = x[e] < 0 ? -x[1 - e] : x[1 - e] - size;
      if (other > slack) continue;  // all of it is beyond
      const double share = std::clamp((end - x[e]) / (x[1 - e] - x[e]), 0.0, 1.0);
      point = at[e] + share * (at[1 - e] - at[e]);
      feature = featureOf(side, x[e] < 0 ? k : next(p, k), incident, true);
    }
    const double apart = dot(normal, point - from);
    if (apart <= reach) addPoint(side, point, apart, normal, feature, manifold);
  }
  setNormal(side, normal, manifold);
  setFace(side, manifold);
  return manifold.count > 0;
}

}  // namespace

bool faceOnOutline(const Side& side, int k, int supported, double margin, Manifold& manifold) {
  const ConvexPiece& q = side.other;
  const Vec2 facing = -inverseRotate(side.otherInReference.turn, side.reference.normals[k]);
  if (q.whole) return clipToFace(side, k, edgeFacing(q, supported, facing), margin, manifold);
  constexpr double kAgainst = 0.9;
  const bool touchable = inCone(q, supported, facing);
  const int edges[2] = {supported, previous(q, supported)};
  int best = -1;
  double most = touchable ? 0 : kAgainst;
  for (int edge : edges) {
    const double towards = dot(q.normals[edge], facing);
    if (q.inner[edge] || !(towards > most)) continue;
    most = towards;
    best = edge;
  }
  if (best >= 0) return clipToFace(side, k, best, margin, manifold);
  if (!touchable) return false;
  const Vec2 at = toWorld(side.otherInReference, q.points[supported]);
  const ConvexPiece& p = side.reference;
  const Vec2 from = p.points[k], way = perpendicular(side.reference.normals[k]);
  const double along = dot(way, at - from), size = dot(way, p.points[next(p, k)] - from);
  if ((along < 0 || along > size) && !isNextToNotch(p, k, along, size, margin)) return false;
  cornerOnFace(side, k, supported, manifold);
  return manifold.points[0].gap <= margin;
}

}  // namespace smokebox::convex
