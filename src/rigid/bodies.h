// The state of all bodies, as the stages of a sub-step share it: arrays indexed by the body's number.
//
// Within a step a body's place is that at the step's start and what it has moved since; velocities belong to
// the middle of a sub-step (leapfrog).
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

#include "rigid/contact.h"
#include "rigid/system.h"

namespace smokebox {

/// Velocity (m/s, rad/s), or a displacement (m, rad). 32 bytes: one load brings it whole.
struct alignas(32) Motion {
  double x = 0, y = 0, turn = 0, unused = 0;
  Vec2 linear() const { return {x, y}; }
};

struct InverseMass {
  double mass = 0, inertia = 0;  // 1/kg, 1/(kg m^2); both 0 for what nothing moves
};

/// `turn` and a further, mostly small angle: by Taylor's series below a quarter (to rounding), else anew.
inline Turn turnedBy(Turn turn, double angleRad) {
  Turn by;
  if (angleRad < 0.25 && angleRad > -0.25) {
    constexpr double kS3 = -1.0 / 6, kS5 = -kS3 / 20, kS7 = -kS5 / 42, kS9 = -kS7 / 72, kS11 = -kS9 / 110;
    constexpr double kC2 = -0.5, kC4 = -kC2 / 12, kC6 = -kC4 / 30, kC8 = -kC6 / 56, kC10 = -kC8 / 90,
                     kC12 = -kC10 / 132;
    const double q = angleRad * angleRad;
    by.s = angleRad + angleRad * q * (kS3 + q * (kS5 + q * (kS7 + q * (kS9 + q * kS11))));
    by.c = 1 + q * (kC2 + q * (kC4 + q * (kC6 + q * (kC8 + q * (kC10 + q * kC12)))));
  } else {
    by = turnBy(angleRad);
  }
  return {by.c * turn.c - by.s * turn.s, by.s * turn.c + by.c * turn.s};
}

/// What is asked of a body's shape all the time, side by side. A box around all that can be touched, in its
/// own coordinates; lengths in metres.
struct alignas(64) Extent {
  Vec2 centre, half;                  // of the box
  double reach = 0;                   // from the centre of mass to the farthest point
  double thinnest = 0;                // smallest width of a part
  double radius = 0;                  // of the disk that it is; 0: another shape
  const ConvexPiece* only = nullptr;  // piece, if there is but one
  /// How far from the centre of mass a turn moves anything, m: 0 for a disk about it.
  double turningReach() const { return radius > 0 && centre.x == 0 && centre.y == 0 ? 0 : reach; }
};
static_assert(sizeof(Extent) == 64);
Extent extentOf(const BodyShape& shape);

/// What a step asks of a body's BodyDef for each pair, side by side.
struct Surface {
  double bounce = 0, friction = 0.5;
  double gravityScale = 1;
  bool isDriven = false;  // has no mass: nothing moves it but moveTo()
  bool operator==(const Surface&) const = default;
};

struct Bodies {
  std::vector<BodyDef> def;
  std::vector<Extent> extent;
  std::vector<Surface> surface;  // of def, as of the step's start
  std::vector<Motion> velocity;  // now
  std::vector<Motion> moved;     // since the step began
  std::vector<InverseMass> inverse;
  std::vector<Vec2> position;  // at the start of the step
  std::vector<Vec2> wound;     // whole periods that have been taken off it at periodic sides, m
  std::vector<double> angleRad;
  std::vector<Turn> turn;  // of angleRad
  std::vector<char> there;
  /// Pairs that a pin, weld or slide joins: they pass through each other. The lower number first, sorted,
  /// once for each joint.
  std::vector<std::pair<int, int>> joined;

  bool areJoined(int a, int b) const {
    const std::pair<int, int> pair = std::minmax(a, b);
    return !joined.empty() && std::binary_search(joined.begin(), joined.end(), pair);
  }
  /// Of the world's images beyond periodic sides, m.
  Vec2 period;
  Vec2 shiftOf(const Contact& contact) const { return {contact.sx * period.x, contact.sy * period.y}; }

  bool defsChanged = true;      // of any body, since the step before
  bool surfacesChanged = true;  // with that: any surface
  void takeSurfaces() {
    surfacesChanged = false;
    if (!defsChanged) return;
    surfacesChanged = surface.size() != def.size();
    surface.resize(def.size());
    for (std::size_t b = 0; b < def.size(); ++b) {
      const Surface now{def[b].bounce, def[b].friction, def[b].gravityScale, def[b].mass <= 0};
      surfacesChanged |= surface[b] != now;
      surface[b] = now;
    }
  }
  int count() const { return static_cast<int>(def.size()); }
  bool moves(int body) const { return inverse[body].mass > 0; }
  Vec2 positionNow(int body) const { return position[body] + moved[body].linear(); }
  /// As if it had never come in again at the other side: what ties bodies together goes by that.
  Vec2 unwrappedNow(int body) const { return positionNow(body) + wound[body]; }
  double angleNow(int body) const { return angleRad[body] + moved[body].turn; }
  Frame frameNow(int body) const {
    return {positionNow(body), moved[body].turn == 0 ? turn[body] : turnedBy(turn[body], moved[body].turn)};
  }
  /// Of a point of the body at `arm` from its centre of mass.
  Vec2 velocityAt(int body, Vec2 arm) const {
    const Motion& v = velocity[body];
    return {v.x - v.turn * arm.y, v.y + v.turn * arm.x};
  }
  void push(int body, Vec2 arm, Vec2 impulse) {
    Motion& v = velocity[body];
    const InverseMass& m = inverse[body];
    v.x += m.mass * impulse.x;
    v.y += m.mass * impulse.y;
    v.turn += m.inertia * cross(arm, impulse);
  }
};

}  // namespace smokebox
