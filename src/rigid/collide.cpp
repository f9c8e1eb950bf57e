#include "rigid/collide.h"

#include <algorithm>
#include <cmath>

#include "rigid/convex_queries.h"

namespace smokebox {
namespace {

using namespace convex;

/// Two pieces in the coordinates of one of them, the reference, whose edge or corner gives the normal.
struct Side {
  const ConvexPiece& reference;
  const Frame& frame;  // of the reference
  const ConvexPiece& other;
  const Frame& otherInReference;
  bool flipped;  // the reference is B
};

std::uint32_t featureOf(const Side& side, int onReference, int onOther, bool cornerOfReference) {
  const int onA = side.flipped ? onOther : onReference, onB = side.flipped ? onReference : onOther;
  const std::uint32_t cornerOfA = cornerOfReference != side.flipped ? 1 : 0;
  return cornerOfA << 31 | (static_cast<std::uint32_t>(onA) & 0x7fff) << 16 |
         (static_cast<std::uint32_t>(onB) & 0xffff);
}

/// `point` on the core of the other piece, `apart` from that of the reference along `normal`.
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
  const double slack = 1e-9 * (p.reach + q.reach);
  if (std::max(x[0], x[1]) < -slack || std::min(x[0], x[1]) > size + slack) return false;
  const double reach = margin + p.radius + q.radius;
  for (int e = 0; e < 2; ++e) {
    Vec2 point = at[e];
    std::uint32_t feature = featureOf(side, k, ends[e], false);
    if (x[e] < -slack || x[e] > size + slack) {
      const double share = std::clamp(((x[e] < 0 ? 0 : size) - x[e]) / (x[1 - e] - x[e]), 0.0, 1.0);
      point = at[e] + share * (at[1 - e] - at[e]);
      feature = featureOf(side, x[e] < 0 ? k : next(p, k), incident, true);
    }
    const double apart = dot(normal, point - from);
    if (apart <= reach) addPoint(side, point, apart, normal, feature, manifold);
  }
  setNormal(side, normal, manifold);
  return manifold.count > 0;
}

/// One point: `point` of the other's core against `nearest` of the reference's, which are `apart`.
bool touchCorner(const Side& side, Vec2 nearest, Vec2 point, double apart, std::uint32_t feature,
                 Manifold& manifold) {
  const Vec2 normal = (1 / apart) * (point - nearest);
  manifold.count = 0;
  addPoint(side, point, apart, normal, feature, manifold);
  setNormal(side, normal, manifold);
  return true;
}

/// Corner `corner` of the other piece alone against edge `k` of the reference.
bool cornerOnFace(const Side& side, int k, int corner, double margin, Manifold& manifold) {
  const ConvexPiece& p = side.reference;
  const Vec2 normal = p.normals[k], at = toWorld(side.otherInReference, side.other.points[corner]);
  const Vec2 from = p.points[k], to = p.points[next(p, k)];
  const double apart = dot(normal, at - from);
  if (dot(at - from, to - from) < 0 || dot(at - to, to - from) > 0) return false;
  if (apart > margin + p.radius + side.other.radius) return false;
  manifold.count = 0;
  addPoint(side, at, apart, normal, featureOf(side, k, corner, false), manifold);
  setNormal(side, normal, manifold);
  return true;
}

/// Contact of edge `k`, on the outline, with what the other piece has on its own outline at its supported
/// corner: an edge that runs against it, or the corner if it can be touched from there.
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
  return touchable && cornerOnFace(side, k, supported, margin, manifold);
}

/// The best edge on the outlines, for bodies of several pieces: it must be crossed by the other piece where
/// that overlaps, lest a piece be pushed out through its own body to the far side.
struct OutlineChoice {
  Manifold manifold, fallback;
  double separation = -1e300, fallbackSeparation = -1e300;
};

void chooseOutline(const Side& side, const Frame& referenceInOther, double margin, OutlineChoice& choice) {
  const ConvexPiece &p = side.reference, &q = side.other;
  const int n = static_cast<int>(p.normals.size());
  int at = 0;
  for (int k = 0; k < n; ++k) {
    if (p.inner[k]) continue;
    const Vec2 normal = p.normals[k];
    at = supportFrom(q, -inverseRotate(side.otherInReference.turn, normal), at);
    const double separation = dot(normal, toWorld(side.otherInReference, q.points[at]) - p.points[k]);
    if (separation <= choice.separation) continue;
    Manifold manifold;
    if (!faceOnOutline(side, k, at, margin, manifold)) continue;
    const bool crossed = separation > 0 || meets(q, toWorld(referenceInOther, p.points[k]),
                                                 toWorld(referenceInOther, p.points[next(p, k)]));
    if (crossed) {
      choice.separation = separation;
      choice.manifold = manifold;
    } else if (separation > choice.fallbackSeparation) {
      choice.fallbackSeparation = separation;
      choice.fallback = manifold;
    }
  }
}

/// The nearest edge of the reference's outline, whatever it meets: one point, where the other is deepest
/// behind it.
void nearestOutline(const Side& side, OutlineChoice& choice) {
  const ConvexPiece &p = side.reference, &q = side.other;
  for (std::size_t k = 0; k < p.normals.size(); ++k) {
    if (p.inner[k]) continue;
    const Vec2 normal = p.normals[k];
    const int corner = support(q, -inverseRotate(side.otherInReference.turn, normal));
    const Vec2 at = toWorld(side.otherInReference, q.points[corner]);
    const double separation = dot(normal, at - p.points[k]);
    if (separation <= choice.fallbackSeparation) continue;
    choice.fallbackSeparation = separation;
    choice.fallback.count = 0;
    addPoint(side, at, separation, normal, featureOf(side, static_cast<int>(k), corner, false),
             choice.fallback);
    setNormal(side, normal, choice.fallback);
  }
}

/// `separation`: the largest of all edges, those inside the bodies too.
bool collideOutlines(const Side& ab, const Side& ba, double separation, double margin, Manifold& manifold) {
  OutlineChoice choice;
  chooseOutline(ab, ba.otherInReference, margin, choice);
  chooseOutline(ba, ab.otherInReference, margin, choice);
  // An overlap that is far deeper than that of the two pieces goes through a neighbouring piece, which has it
  // too; unless this one is swallowed.
  constexpr double kFar = 10, kSwallowed = 0.2;
  const bool found = choice.manifold.count > 0;
  const bool swallowed = separation < -kSwallowed * std::min(ab.reference.reach, ba.reference.reach);
  if (found && (swallowed || choice.separation >= std::min(0.0, kFar * separation))) {
    manifold = choice.manifold;
    return true;
  }
  if (!swallowed) return false;
  if (choice.fallback.count == 0) {
    nearestOutline(ab, choice);
    nearestOutline(ba, choice);
  }
  manifold = choice.fallback;
  return manifold.count > 0;
}

/// A disk (the other) against edges.
bool collideDisk(const Side& side, double margin, Manifold& manifold) {
  const ConvexPiece& p = side.reference;
  const Vec2 centre = toWorld(side.otherInReference, side.other.points[0]);
  const double limit = margin + p.radius + side.other.radius;
  const int n = static_cast<int>(p.normals.size());
  int edge = -1, outline = -1;
  double most = -1e300, mostOutline = -1e300;
  for (int k = 0; k < n; ++k) {
    const double separation = dot(p.normals[k], centre - p.points[k]);
    if (separation > limit) return false;
    if (separation > most) {
      most = separation;
      edge = k;
    }
    if (!p.inner[k] && separation > mostOutline) {
      mostOutline = separation;
      outline = k;
    }
  }
  const double tiny = 1e-9 * (p.reach + side.other.reach);
  double share;
  const Vec2 nearest = nearestOnSegment(p.points[edge], p.points[next(p, edge)], centre, share);
  const double apart = length(centre - nearest);
  manifold.count = 0;
  const bool outside = most > tiny || (n == 2 && apart > tiny);
  if (outside) {
    if (apart > limit) return false;
    if (share == 0 || share == 1) {
      const int corner = share == 0 ? edge : next(p, edge);
      if (!inCone(p, corner, (1 / apart) * (centre - nearest))) return false;
      return touchCorner(side, nearest, centre, apart, featureOf(side, edge, 0, false), manifold);
    }
    if (p.inner[edge]) return false;
  } else {
    edge = outline;
    if (edge < 0) return false;
  }
  const double separation = dot(p.normals[edge], centre - p.points[edge]);
  addPoint(side, centre, separation, p.normals[edge], featureOf(side, edge, 0, false), manifold);
  setNormal(side, p.normals[edge], manifold);
  return true;
}

bool collideDisks(const Side& side, double margin, Manifold& manifold) {
  const Vec2 a = side.reference.points[0], b = toWorld(side.otherInReference, side.other.points[0]);
  const double apart = length(b - a), sum = side.reference.radius + side.other.radius;
  if (apart > sum + margin) return false;
  if (apart > 1e-12 * sum) return touchCorner(side, a, b, apart, 0, manifold);
  manifold.count = 0;
  const Vec2 up = inverseRotate(side.frame.turn, {0, 1});
  addPoint(side, b, 0, up, 0, manifold);
  setNormal(side, up, manifold);
  return true;
}

}  // namespace

bool collide(const ConvexPiece& a, const Frame& fa, const ConvexPiece& b, const Frame& fb, double margin,
             Manifold& manifold) {
  manifold.count = 0;
  if (a.buried || b.buried) return false;
  const Frame bInA = relativeFrame(fa, fb);
  const Vec2 between = toWorld(bInA, b.centre) - a.centre;
  const double near = a.reach + b.reach + margin;
  if (dot(between, between) > near * near) return false;
  const Frame aInB = relativeFrame(fb, fa);
  const Side ab{a, fa, b, bInA, false}, ba{b, fb, a, aInB, true};
  if (a.points.size() == 1)
    return b.points.size() == 1 ? collideDisks(ab, margin, manifold) : collideDisk(ba, margin, manifold);
  if (b.points.size() == 1) return collideDisk(ab, margin, manifold);

  const double limit = margin + a.radius + b.radius;
  const Axis onA = largestSeparation(a, b, bInA, limit);
  if (onA.separation > limit) return false;
  const Axis onB = largestSeparation(b, a, aInB, limit);
  if (onB.separation > limit) return false;

  const bool exactlyA = onA.separation >= onB.separation;
  const Side& best = exactlyA ? ab : ba;
  const Axis& axis = exactlyA ? onA : onB;
  const ConvexPiece &p = best.reference, &q = best.other;
  const bool whole = a.whole && b.whole;

  // Apart: the closest features are on this edge and at the supported corner, or on an edge beside it.
  const double tiny = 1e-9 * (a.reach + b.reach);
  const bool segments = a.points.size() == 2 && b.points.size() == 2;
  if (axis.separation > tiny || segments) {
    const int facing =
        edgeFacing(q, axis.support, -inverseRotate(best.otherInReference.turn, p.normals[axis.edge]));
    const Vec2 p1 = p.points[axis.edge], p2 = p.points[next(p, axis.edge)];
    const int ends[2] = {facing, next(q, facing)};
    double nearest = 1e300;
    Vec2 onP, onQ;
    int cornerP = -1, cornerQ = -1;
    for (int e : ends) {
      const Vec2 corner = toWorld(best.otherInReference, q.points[e]);
      double share;
      const Vec2 foot = nearestOnSegment(p1, p2, corner, share);
      const double apart = length(corner - foot);
      if (apart >= nearest) continue;
      nearest = apart;
      onP = foot;
      onQ = corner;
      cornerQ = e;
      cornerP = share == 0 ? axis.edge : share == 1 ? next(p, axis.edge) : -1;
    }
    const Vec2 q1 = toWorld(best.otherInReference, q.points[ends[0]]);
    const Vec2 q2 = toWorld(best.otherInReference, q.points[ends[1]]);
    for (int e : {axis.edge, next(p, axis.edge)}) {
      double share;
      const Vec2 foot = nearestOnSegment(q1, q2, p.points[e], share);
      const double apart = length(foot - p.points[e]);
      if (apart >= nearest) continue;
      nearest = apart;
      onP = p.points[e];
      onQ = foot;
      cornerP = e;
      cornerQ = share == 0 ? ends[0] : share == 1 ? ends[1] : -1;
    }
    if (nearest > limit) return false;
    // Flush faces are no corners: then the way from corner to corner is along the normal.
    const double aside = std::fabs(cross(p.normals[axis.edge], onQ - onP));
    if (cornerP >= 0 && cornerQ >= 0 && nearest > tiny && aside > tiny) {
      const Vec2 normal = (1 / nearest) * (onQ - onP);
      const bool valid = inCone(p, cornerP, normal) &&
                         inCone(q, cornerQ, -inverseRotate(best.otherInReference.turn, normal));
      if (valid)
        return touchCorner(best, onP, onQ, nearest, featureOf(best, axis.edge, cornerQ, false), manifold);
    }
  }
  if (!whole) return collideOutlines(ab, ba, axis.separation, margin, manifold);

  // A's face unless B's is clearly better: contacts keep their features while two faces lie on each other.
  const double bias = 1e-3 * std::min(a.reach, b.reach);
  const bool aligned =
      axis.separation <= 0 || dot(a.normals[onA.edge], rotate(bInA.turn, b.normals[onB.edge])) < -1 + 1e-5;
  const bool useA = exactlyA || (aligned && onA.separation >= onB.separation - bias);
  const Side& side = useA ? ab : ba;
  const Axis& chosen = useA ? onA : onB;
  if (faceOnOutline(side, chosen.edge, chosen.support, margin, manifold)) return true;
  return faceOnOutline(best, axis.edge, axis.support, margin, manifold);
}

}  // namespace smokebox
