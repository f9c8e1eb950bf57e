// Polygons and convex pieces at random, the same on every machine, and the distance of pieces the slow way.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/maths.h"
#include "geometry/shape.h"
#include "rigid/convex.h"
#include "support/rigid_world.h"

namespace smokebox::test {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 2654435761u + 1) {}
  double between(double lo, double hi) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return lo + (hi - lo) * static_cast<double>(state_ >> 11) * 0x1p-53;
  }
  int below(int n) { return std::min(n - 1, static_cast<int>(between(0, n))); }
  Frame frame(double extent) {
    const Vec2 position{between(-extent, extent), between(-extent, extent)};
    return {position, turnBy(between(-4, 4))};
  }

 private:
  std::uint64_t state_;
};

/// Star-shaped, with 3 to 8 corners (concave: 6 to 10, every second drawn in), of a size within `radius`.
inline std::shared_ptr<const BodyShape> randomPolygon(Dice& dice, bool concave, double radius = 0.6) {
  const int corners =
      concave ? 2 * static_cast<int>(dice.between(3, 6)) : static_cast<int>(dice.between(3, 9));
  PolygonShape polygon;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * kPi * (k + (concave ? 0 : dice.between(-0.3, 0.3))) / corners;
    const double r = radius * (concave && k % 2 == 0 ? dice.between(0.35, 0.5) : dice.between(0.9, 1));
    polygon.points.push_back({r * exact::cos(angle), r * exact::sin(angle)});
  }
  return bodyShape(polygon);
}

/// Corners on an ellipse at random angles; 1: a disk, 2: a capsule.
inline ConvexPiece randomPiece(Dice& dice, int corners, double radius) {
  std::vector<double> angles;
  for (int k = 0; k < corners; ++k) angles.push_back(2 * kPi * (k + dice.between(0.1, 0.9)) / corners);
  const Vec2 radii{dice.between(0.3, 1), dice.between(0.3, 1)},
      centre{dice.between(-1, 1), dice.between(-1, 1)};
  std::vector<Vec2> points;
  for (double angle : angles)
    points.push_back(centre + Vec2{radii.x * exact::cos(angle), radii.y * exact::sin(angle)});
  return makePiece(points, radius);
}

inline std::vector<Vec2> worldPoints(const ConvexPiece& piece, const Frame& frame) {
  std::vector<Vec2> points;
  for (Vec2 p : piece.points) points.push_back(toWorld(frame, p));
  return points;
}

inline double pointToSegment(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 along = b - a;
  const double size = dot(along, along),
               share = size > 0 ? std::clamp(dot(p - a, along) / size, 0.0, 1.0) : 0;
  return length(p - (a + share * along));
}

/// Of the cores, all edges against all; 0 if they overlap.
inline double slowDistance(const ConvexPiece& a, const Frame& fa, const ConvexPiece& b, const Frame& fb) {
  const std::vector<Vec2> p = worldPoints(a, fa), q = worldPoints(b, fb);
  double nearest = 1e300;
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t j = 0; j < q.size(); ++j) {
      const Vec2 a1 = p[i], a2 = p[(i + 1) % p.size()], b1 = q[j], b2 = q[(j + 1) % q.size()];
      nearest = std::min({nearest, pointToSegment(a1, b1, b2), pointToSegment(a2, b1, b2),
                          pointToSegment(b1, a1, a2), pointToSegment(b2, a1, a2)});
      const double c = cross(a2 - a1, b1 - a1), d = cross(a2 - a1, b2 - a1);
      const double e = cross(b2 - b1, a1 - b1), f = cross(b2 - b1, a2 - b1);
      if (c * d < 0 && e * f < 0) return 0;
    }
  const auto inside = [](const std::vector<Vec2>& outline, Vec2 point) {
    return outline.size() > 2 && contains({outline}, point);
  };
  return inside(p, q[0]) || inside(q, p[0]) ? 0 : nearest;
}

/// Least overlap over all normals of edges, the slow way (for cores that overlap); negative.
inline double slowOverlap(const ConvexPiece& a, const Frame& fa, const ConvexPiece& b, const Frame& fb) {
  double most = -1e300;
  const std::pair<const ConvexPiece*, Frame> both[2] = {{&a, fa}, {&b, fb}};
  for (int k = 0; k < 2; ++k) {
    const auto& [piece, frame] = both[k];
    const std::vector<Vec2> own = worldPoints(*piece, frame);
    const std::vector<Vec2> others = worldPoints(*both[1 - k].first, both[1 - k].second);
    for (std::size_t e = 0; e < piece->normals.size(); ++e) {
      double least = 1e300;
      for (Vec2 q : others) least = std::min(least, dot(rotate(frame.turn, piece->normals[e]), q - own[e]));
      most = std::max(most, least);
    }
  }
  return most;
}

}  // namespace smokebox::test
