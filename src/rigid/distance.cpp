#include "rigid/distance.h"

#include <algorithm>
#include <cmath>

#include "rigid/convex_queries.h"

namespace smokebox {
namespace {

using namespace convex;

/// Corners of the difference B - A that the search holds on to: 1, 2 or 3.
struct Simplex {
  struct Corner {
    int a, b;
    Vec2 pointA, pointB, difference;  // in A's coordinates
  };
  Corner corners[3];
  double weights[3] = {1, 0, 0};
  int count = 0;

  Vec2 closest() const {
    Vec2 sum;
    for (int k = 0; k < count; ++k) sum = sum + weights[k] * corners[k].difference;
    return sum;
  }

  /// Keeps the corners around the point closest to (0, 0); three are kept only if it lies within.
  void reduce() {
    if (count == 2) reduceSegment();
    if (count == 3) reduceTriangle();
  }

 private:
  void keep(int k) {
    corners[0] = corners[k];
    weights[0] = 1;
    count = 1;
  }
  void reduceSegment() {
    const Vec2 from = corners[0].difference, to = corners[1].difference;
    double share;
    nearestOnSegment(from, to, {}, share);
    if (share == 0) return keep(0);
    if (share == 1) return keep(1);
    weights[0] = 1 - share;
    weights[1] = share;
  }
  void reduceTriangle() {
    const Vec2 p[3] = {corners[0].difference, corners[1].difference, corners[2].difference};
    const double area = cross(p[1] - p[0], p[2] - p[0]);
    const double u = cross(p[1], p[2]), v = cross(p[2], p[0]), w = cross(p[0], p[1]);
    if (area != 0 && u * area >= 0 && v * area >= 0 && w * area >= 0) return;  // within
    int best = 0;
    double nearest = 1e300;
    for (int k = 0; k < 3; ++k) {
      double share;
      const Vec2 at = nearestOnSegment(p[k], p[(k + 1) % 3], {}, share);
      if (dot(at, at) >= nearest) continue;
      nearest = dot(at, at);
      best = k;
    }
    const Corner first = corners[best], second = corners[(best + 1) % 3];
    corners[0] = first;
    corners[1] = second;
    count = 2;
    reduceSegment();
  }
};

Simplex::Corner cornerOf(const ConvexPiece& a, const ConvexPiece& b, const Frame& bInA, int i, int j) {
  const Vec2 pointA = a.points[i], pointB = toWorld(bInA, b.points[j]);
  return {i, j, pointA, pointB, pointB - pointA};
}

/// Overlap of cores: the way out with the least of it, over the normals of edges.
Closest overlapOf(const ConvexPiece& a, const Frame& fa, const ConvexPiece& b, const Frame& bInA) {
  const Frame aInB{-inverseRotate(bInA.turn, bInA.position), {bInA.turn.c, -bInA.turn.s}};
  const Axis onA = a.points.size() > 1 ? largestSeparation(a, b, bInA, 1e300) : Axis{};
  const Axis onB = b.points.size() > 1 ? largestSeparation(b, a, aInB, 1e300) : Axis{};
  Closest result;
  Vec2 normal{0, 1}, pointA = a.points[0], pointB = pointA;
  double separation = 0;
  if (onA.edge >= 0 && onA.separation >= onB.separation) {
    normal = a.normals[onA.edge];
    separation = std::min(onA.separation, 0.0);
    pointB = toWorld(bInA, b.points[onA.support]);
    pointA = pointB - separation * normal;
  } else if (onB.edge >= 0) {
    normal = -rotate(bInA.turn, b.normals[onB.edge]);
    separation = std::min(onB.separation, 0.0);
    pointA = a.points[onB.support];
    pointB = pointA + separation * normal;
  }
  result.distance = separation - a.radius - b.radius;
  result.normal = rotate(fa.turn, normal);
  result.a = toWorld(fa, pointA + a.radius * normal);
  result.b = toWorld(fa, pointB - b.radius * normal);
  return result;
}

}  // namespace

Closest closestPoints(const ConvexPiece& a, const Frame& fa, const ConvexPiece& b, const Frame& fb) {
  const Frame bInA = relativeFrame(fa, fb);
  Simplex simplex;
  const Vec2 start = toWorld(bInA, b.centre) - a.centre;
  int i = support(a, start), j = support(b, -inverseRotate(bInA.turn, start));
  simplex.corners[0] = cornerOf(a, b, bInA, i, j);
  simplex.count = 1;
  double least = 1e300;
  // Each round brings the closest point nearer, or it ends; rounds are bounded for rounding's sake.
  constexpr int kRounds = 64;
  for (int round = 0; round < kRounds; ++round) {
    simplex.reduce();
    if (simplex.count == 3) return overlapOf(a, fa, b, bInA);
    Vec2 towards = -simplex.closest();  // from the difference to (0, 0): A's points go against it
    const double square = dot(towards, towards);
    if (square == 0) return overlapOf(a, fa, b, bInA);
    if (square >= least) break;
    least = square;
    if (simplex.count == 2) {  // more exact than from the closest point when that is near (0, 0)
      const Vec2 edge = simplex.corners[1].difference - simplex.corners[0].difference;
      const double side = cross(edge, -simplex.corners[0].difference);
      towards = side > 0 ? perpendicular(edge) : -perpendicular(edge);
    }
    i = supportFrom(a, -towards, i);
    j = supportFrom(b, inverseRotate(bInA.turn, towards), j);
    bool known = false;
    for (int k = 0; k < simplex.count; ++k)
      known = known || (simplex.corners[k].a == i && simplex.corners[k].b == j);
    if (known) break;
    simplex.corners[simplex.count++] = cornerOf(a, b, bInA, i, j);
  }
  simplex.reduce();
  if (simplex.count == 3) return overlapOf(a, fa, b, bInA);
  Vec2 pointA, pointB;
  for (int k = 0; k < simplex.count; ++k) {
    pointA = pointA + simplex.weights[k] * simplex.corners[k].pointA;
    pointB = pointB + simplex.weights[k] * simplex.corners[k].pointB;
  }
  const double apart = length(pointB - pointA);
  if (!(apart > 1e-12 * (a.reach + b.reach))) return overlapOf(a, fa, b, bInA);
  const Vec2 normal = (1 / apart) * (pointB - pointA);
  return {apart - a.radius - b.radius, toWorld(fa, pointA + a.radius * normal),
          toWorld(fa, pointB - b.radius * normal), rotate(fa.turn, normal)};
}

}  // namespace smokebox
