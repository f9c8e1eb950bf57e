#include <algorithm>
#include <cmath>

#include "rigid/distance.h"

namespace smokebox {
namespace {

double farthest(const ConvexPiece& piece) {
  double most = 0;
  for (Vec2 p : piece.points) most = std::max(most, length(p));
  return most + piece.radius;
}

/// How far the piece reaches along a world direction, from its body's origin.
double extent(const ConvexPiece& piece, const Frame& frame, Vec2 direction) {
  const Vec2 own = inverseRotate(frame.turn, direction);
  double most = -1e300;
  for (Vec2 p : piece.points) most = std::max(most, dot(own, p));
  return most + piece.radius;
}

}  // namespace

std::optional<double> timeOfImpact(const ConvexPiece& a, const Sweep& sa, const ConvexPiece& b,
                                   const Sweep& sb, double target) {
  const double reachA = farthest(a), reachB = farthest(b);
  const double turning = std::fabs(sa.turn) * reachA + std::fabs(sb.turn) * reachB;
  const double tolerance = 1e-3 * std::fabs(target) + 1e-9 * (reachA + reachB);
  constexpr int kRounds = 20000;
  double s = 0;
  for (int round = 0; round < kRounds; ++round) {
    const Frame fa = frameAt(sa, s), fb = frameAt(sb, s);
    const Closest closest = closestPoints(a, fa, b, fb);
    const double slack = closest.distance - target;
    if (slack <= tolerance) return s;
    // The line across the normal keeps them apart. No point comes nearer to it faster than this:
    const double approach = -dot(sb.move - sa.move, closest.normal);
    double step = approach + turning > 0 ? slack / (approach + turning) : 2;
    // And however they turn, they stay within the circles of their reach.
    const double spare = (reachA - extent(a, fa, closest.normal)) + (reachB - extent(b, fb, -closest.normal));
    if (slack > spare) step = std::max(step, approach > 0 ? (slack - spare) / approach : 2);
    s += step;
    if (s > 1) return std::nullopt;
  }
  return s;
}

}  // namespace smokebox
