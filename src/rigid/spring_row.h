// A spring as a soft constraint: an impulse that grows with the rate at the sub-step's end, in
//   impulse = -(bias + hardness rate).
//
// With C the stretch at the sub-step's start, u the rate within it, u0 that within the last one:
//   impulse = -h [stiffness (C + a h u - b h u0) + damping (q u + (1 - q) u0)].
// With w^2 = stiffness / effective mass:
// - w h < 1/2: a = b = 1/12, which is Numerov's method: no damping of its own, error of the frequency (w h)^4
// / 480
//   for springs alone, and stable for what hangs on up to a dozen such springs;
// - up to 1: to a = b = 1/4, the mean acceleration of Newmark (1959), stable at any stiffness;
// - up to 2: to a = 1, b = 0, backward Euler, which quiets what the sub-step cannot follow.
// Damping is centred (q = 1/2) while it takes less than half of the rate in a sub-step, and implicit (q = 1)
// where it would take all of it twice.
#pragma once
#include <algorithm>

#include "rigid/links.h"

namespace smokebox {

/// Of a spring, as long as its stiffness, its masses and the sub-step stay.
struct SpringShares {
  double now = 0, before = 0;  // a, b
  double damping = 0.5;        // q
};

inline double smoothStep(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

/// m; 0 where it is slack.
inline double stretchOf(const SpringDef& def, double distance) {
  return std::max(distance - def.length, 0.0) + std::min(distance - (def.length - def.slack), 0.0);
}

/// Of a spring without damping; `squared`: (w h)^2.
inline SpringShares sharesOf(double squared) {
  const double even = 1.0 / 12 + (1.0 / 4 - 1.0 / 12) * smoothStep((squared - 0.25) / 0.75);
  const double late = smoothStep((squared - 1) / 3);
  return {even + late * (1 - even), even * (1 - late), 0.5};
}

/// `inertia`: the rate that a unit impulse makes, 1/kg.
inline SpringShares springShares(double stiffness, double damping, double inertia, double h) {
  SpringShares shares = sharesOf(h * h * stiffness * inertia);
  shares.damping += 0.5 * smoothStep((h * damping * inertia - 0.5) / 1.5);
  return shares;
}

/// The impulse at which all agrees: rate + softness impulse + offset = 0.
struct SoftRow {
  double softness = 0, offset = 0;
  bool on = false;

  static SoftRow of(double stiffness, double damping, const SpringShares& shares, double stretch,
                    double rateBefore, double h) {
    const double hardness = h * (stiffness * shares.now * h + damping * shares.damping);
    if (!(hardness > 0)) return {};
    const double bias = h * (stiffness * (stretch - shares.before * h * rateBefore) +
                             damping * (1 - shares.damping) * rateBefore);
    return {1 / hardness, bias / hardness, true};
  }
};

}  // namespace smokebox
