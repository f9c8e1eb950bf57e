#include "rigid/collide.h"

#include <algorithm>
#include <cmath>

#include "rigid/collide_outlines.h"
#include "rigid/contact_points.h"

namespace smokebox {
namespace {

using namespace convex;

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
    if (separation > limit) {
      manifold.apart = separation - limit + margin;
      return false;
    }
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
    if (apart > limit) {
      manifold.apart = apart - limit + margin;
      return false;
    }
    if (share == 0 || share == 1) {
      const int corner = share == 0 ? edge : next(p, edge);
      if (!inCone(p, corner, (1 / apart) * (centre - nearest))) return false;
      touchCorner(side, nearest, centre, apart, featureOf(side, edge, 0, false), manifold);
      return true;
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
  if (apart > sum + margin) {
    manifold.apart = apart - sum;
    return false;
  }
  manifold.count = 0;
  if (apart > 1e-12 * sum) {
    touchCorner(side, a, b, apart, 0, manifold);
    return true;
  }
  const Vec2 up = inverseRotate(side.frame.turn, {0, 1});
  addPoint(side, b, 0, up, 0, manifold);
  setNormal(side, up, manifold);
  return true;
}

/// The closest points of edge `k` of the reference and an edge of the other, and the corners that they are
/// (-1: none).
struct ClosestFeatures {
  double apart = 1e300;
  Vec2 onReference, onOther;
  int referenceCorner = -1, otherCorner = -1;
};

ClosestFeatures closestOfEdges(const Side& side, int k, int other) {
  const ConvexPiece &p = side.reference, &q = side.other;
  const int pEnds[2] = {k, next(p, k)}, qEnds[2] = {other, next(q, other)};
  Vec2 onP[2], onQ[2];
  for (int e = 0; e < 2; ++e) {
    onP[e] = p.points[pEnds[e]];
    onQ[e] = toWorld(side.otherInReference, q.points[qEnds[e]]);
  }
  const auto cornerAt = [](const int(&ends)[2], double share) {
    return share == 0 ? ends[0] : share == 1 ? ends[1] : -1;
  };
  ClosestFeatures closest;
  double share;
  for (int e = 0; e < 2; ++e) {
    const Vec2 foot = nearestOnSegment(onP[0], onP[1], onQ[e], share);
    const double apart = length(onQ[e] - foot);
    if (apart < closest.apart) closest = {apart, foot, onQ[e], cornerAt(pEnds, share), qEnds[e]};
  }
  for (int e = 0; e < 2; ++e) {
    const Vec2 foot = nearestOnSegment(onQ[0], onQ[1], onP[e], share);
    const double apart = length(foot - onP[e]);
    if (apart < closest.apart) closest = {apart, onP[e], foot, pEnds[e], cornerAt(qEnds, share)};
  }
  return closest;
}

/// Two capsules in line: their edges' normals do not tell them apart, their ends do.
bool apartInLine(const Side& side, double tiny) {
  const ConvexPiece &p = side.reference, &q = side.other;
  if (p.points.size() != 2 || q.points.size() != 2) return false;
  const Vec2 along = perpendicular(p.normals[0]);
  const double from = dot(along, p.points[0]), to = dot(along, p.points[1]);
  const double first = dot(along, toWorld(side.otherInReference, q.points[0]));
  const double second = dot(along, toWorld(side.otherInReference, q.points[1]));
  return std::min(first, second) > to + tiny || std::max(first, second) < from - tiny;
}

}  // namespace

bool collide(const ConvexPiece& a, const Frame& fa, const ConvexPiece& b, const Frame& fb, double margin,
             Manifold& manifold) {
  manifold.count = 0;
  manifold.apart = 0;
  manifold.face = 0;
  if (a.buried || b.buried) {
    manifold.apart = 1e300;
    return false;
  }
  const Frame bInA = relativeFrame(fa, fb);
  const Vec2 between = toWorld(bInA, b.centre) - a.centre;
  const double near = a.reach + b.reach + margin;
  if (dot(between, between) > near * near) {
    manifold.apart = length(between) - a.reach - b.reach;
    return false;
  }
  const Frame aInB = relativeFrame(fb, fa);
  const Side ab{a, fa, b, bInA, false}, ba{b, fb, a, aInB, true};
  if (a.points.size() == 1)
    return b.points.size() == 1 ? collideDisks(ab, margin, manifold) : collideDisk(ba, margin, manifold);
  if (b.points.size() == 1) return collideDisk(ab, margin, manifold);

  const double radii = a.radius + b.radius, limit = margin + radii;
  auto areApart = [&](double cores) {
    manifold.apart = cores - radii;
    return cores > limit;
  };
  const Axis onA = largestSeparation(a, b, bInA, limit);
  if (areApart(onA.separation)) return false;
  const Axis onB = largestSeparation(b, a, aInB, limit);
  if (areApart(onB.separation)) return false;
  const bool betterOnA = onA.separation >= onB.separation;
  const Side& best = betterOnA ? ab : ba;
  const Axis& axis = betterOnA ? onA : onB;

  const double tiny = 1e-9 * (a.reach + b.reach);
  if (axis.separation > tiny || apartInLine(ab, tiny)) {
    // Apart: the closest features are on this edge and at the supported corner, or on an edge beside that.
    const ConvexPiece &p = best.reference, &q = best.other;
    const Turn turn = best.otherInReference.turn;
    const int facing = edgeFacing(q, axis.support, -inverseRotate(turn, p.normals[axis.edge]));
    const ClosestFeatures closest = closestOfEdges(best, axis.edge, facing);
    if (areApart(closest.apart)) return false;
    // Flush faces are no corners: then the way from corner to corner is along the normal.
    const Vec2 way = closest.onOther - closest.onReference;
    const bool corners = closest.referenceCorner >= 0 && closest.otherCorner >= 0 && closest.apart > tiny &&
                         std::fabs(cross(p.normals[axis.edge], way)) > tiny;
    const Vec2 normal = (1 / closest.apart) * way;
    if (corners && inCone(p, closest.referenceCorner, normal) &&
        inCone(q, closest.otherCorner, -inverseRotate(turn, normal))) {
      touchCorner(best, closest.onReference, closest.onOther, closest.apart,
                  featureOf(best, axis.edge, closest.otherCorner, false), manifold);
      edgesBeside(best, closest.referenceCorner, closest.otherCorner, normal, margin, manifold);
      return true;
    }
  }
  if (!a.whole || !b.whole) return collideOutlines(ab, ba, axis.separation, margin, manifold);

  // A's face unless B's is clearly better: contacts keep their features while two faces lie on each other.
  const double bias = 1e-3 * std::min(a.reach, b.reach);
  const bool aligned =
      axis.separation <= 0 || dot(a.normals[onA.edge], rotate(bInA.turn, b.normals[onB.edge])) < -1 + 1e-5;
  if (!betterOnA && aligned && onA.separation >= onB.separation - bias &&
      faceOnOutline(ab, onA.edge, onA.support, margin, manifold))
    return true;
  if (faceOnOutline(best, axis.edge, axis.support, margin, manifold)) return true;
  cornerOnFace(best, axis.edge, axis.support,
               manifold);  // needles, tip to tip: beside the edge by a rounding
  return true;
}

}  // namespace smokebox
