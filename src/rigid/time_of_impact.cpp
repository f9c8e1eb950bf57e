#include <algorithm>
#include <cmath>

#include "rigid/distance.h"

namespace smokebox {
namespace {

/// One of the two pieces, as seen along a direction fixed in the world that leads to the other piece.
class Side {
 public:
  Side(const ConvexPiece& piece, const Sweep& sweep) : piece_(piece), sweep_(sweep) {
    for (Vec2 p : piece.points) reach_ = std::max(reach_, length(p));
  }

  double reach() const { return reach_; }
  /// Speed of the body along the direction.
  double along() const { return along_; }
  /// Largest speed that turning gives to any point.
  double turning() const { return std::fabs(sweep_.turn) * reach_; }

  void lookAlong(Vec2 direction, const Frame& frame) {
    along_ = dot(sweep_.move, direction);
    ahead_ = inverseRotate(frame.turn, direction);
    extent_ = -1e300;
    for (Vec2 p : piece_.points) extent_ = std::max(extent_, dot(ahead_, p));
  }

  /// How much farther ahead turning brings the piece within `step` of the sweep, at most: a corner at
  /// distance r from the origin and x ahead gets to x cos(angle) + x' sin(angle) <= x + x' angle + r angle^2
  /// / 2.
  double advance(double step) const {
    const double angle = sweep_.turn * step, bend = reach_ * angle * angle / 2;
    double most = extent_ - bend;
    for (Vec2 p : piece_.points) most = std::max(most, dot(ahead_, p) + cross(p, ahead_) * angle);
    return most + bend - extent_;
  }
  /// And never, however it turns, by more than this.
  double spare() const { return reach_ - extent_; }

 private:
  const ConvexPiece& piece_;
  const Sweep& sweep_;
  double reach_ = 0, along_ = 0, extent_ = 0;
  Vec2 ahead_;
};

/// Is the direction's gap `slack` not used up within `step`, nor at any time before? Both bounds grow with
/// the step, or are convex and 0 at its beginning, so that their ends tell.
bool isFree(const Side& a, const Side& b, double slack, double step) {
  const double approach = a.along() + b.along(), turnA = a.advance(step), turnB = b.advance(step);
  if (turnA + turnB + approach * step <= slack) return true;
  return std::min(turnA, a.spare()) + std::min(turnB, b.spare()) + std::max(approach, 0.0) * step <= slack;
}

/// A long step (within a quarter of the longest) that is free, at most `longest`.
double freeStep(const Side& a, const Side& b, double slack, double longest) {
  if (isFree(a, b, slack, longest)) return longest;
  const double fastest = std::max(a.along() + b.along(), 0.0) + a.turning() + b.turning();
  double step = std::min(slack / fastest, longest);
  while (2 * step < longest && isFree(a, b, slack, 2 * step)) step *= 2;
  for (double share : {0.5, 0.25})
    if (isFree(a, b, slack, step * (1 + share))) step *= 1 + share;
  return std::min(step, longest);
}

}  // namespace

std::optional<double> timeOfImpact(const ConvexPiece& a, const Sweep& sa, const ConvexPiece& b,
                                   const Sweep& sb, double target) {
  Side ofA(a, sa), ofB(b, sb);
  const double tolerance = 1e-3 * std::fabs(target) + 1e-9 * (ofA.reach() + ofB.reach());
  constexpr int kRounds = 20000;
  double s = 0;
  for (int round = 0; round < kRounds; ++round) {
    const Frame fa = frameAt(sa, s), fb = frameAt(sb, s);
    const Closest closest = closestPoints(a, fa, b, fb);
    const double slack = closest.distance - target;
    if (slack <= tolerance) return s;
    if (s >= 1) return std::nullopt;
    ofA.lookAlong(closest.normal, fa);
    ofB.lookAlong(-closest.normal, fb);
    const double left = 1 - s, step = freeStep(ofA, ofB, slack, left);
    if (step >= left) return std::nullopt;
    s += step;
  }
  return s;
}

}  // namespace smokebox
