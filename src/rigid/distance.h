// Distance of two convex pieces (Gilbert, Johnson and Keerthi 1988), and when two moving pieces come close
// (conservative advancement: Mirtich 1996).
#pragma once
#include <optional>

#include "rigid/convex.h"

namespace smokebox {

struct Closest {
  double distance = 0;  // between the rounded surfaces; <= 0 if they overlap
  Vec2 a, b;            // on the surfaces, world
  Vec2 normal;  // from A to B; where they overlap, the way out with the least overlap of their edges' normals
};
Closest closestPoints(const ConvexPiece& a, const Frame& fa, const ConvexPiece& b, const Frame& fb);

/// Motion over a sub-step, straight and at an even rate; `turn` in radians, of any size.
struct Sweep {
  Frame start;
  Vec2 move;
  double turn = 0;
};
/// At share s of the sub-step.
inline Frame frameAt(const Sweep& sweep, double s) {
  const Turn by = turnBy(sweep.turn * s), q = sweep.start.turn;
  return {sweep.start.position + s * sweep.move, {by.c * q.c - by.s * q.s, by.s * q.c + by.c * q.s}};
}

/// First share in [0, 1] at which the distance is `target` or less (found from before, with distances up to a
/// thousandth of the target above it), or nothing. Never passes a hit, at any speed of turning. After a
/// bounded number of rounds it returns the last share that is known to be free.
std::optional<double> timeOfImpact(const ConvexPiece& a, const Sweep& sa, const ConvexPiece& b,
                                   const Sweep& sb, double target);

}  // namespace smokebox
