// Bodies in a press: what impulses alone do not hold.
#include <algorithm>
#include <cmath>

#include "rigid/contact_sweeps.h"
#include "rigid/narrow_phase.h"

namespace smokebox {

namespace {
// What overlaps by more than this share of the thinner one's width, and goes on closing in faster than that
// (m/s) against all impulses, is crushed.
constexpr double kCrushed = 0.01, kCrushSpeed = 0.2;
}  // namespace

bool NarrowPhase::yieldCrushed(Bodies& bodies, const std::vector<Motion>& before) {
  crushed_.clear();
  auto isCrushed = [&](const Contact& c) {
    const double deep = kCrushed * thinner(bodies, c.a, c.b);
    for (int k = 0; k < c.count; ++k) {
      const ContactPoint& p = c.points[k];
      if (p.impulseN > 0 && p.gap + gapMoved(bodies, c, p) < -deep &&
          partingSpeed(bodies, c, p) < -kCrushSpeed)
        return true;
    }
    return false;
  };
  crushedAt_.assign(bodies.count(), -1);
  for (const SolvedContact& c : lively_)
    if (isCrushed(c))
      for (const int body : {c.a, c.b})
        if (bodies.moves(body) && crushedAt_[body] < 0) {
          crushedAt_[body] = static_cast<int>(crushed_.size());
          crushed_.push_back(body);
        }
  if (crushed_.empty()) return false;
  auto speed = [&](int body) {
    const Motion& v = before[body];
    return length(v.linear()) + std::abs(v.turn) * bodies.extent[body].turningReach();
  };
  // Nothing that gives way can make it faster than the fastest of those around it.
  crushSpeed_.resize(crushed_.size());
  for (std::size_t k = 0; k < crushed_.size(); ++k) crushSpeed_[k] = speed(crushed_[k]);
  for (SolvedContact& c : lively_) {
    const int a = crushedAt_[c.a], b = crushedAt_[c.b];
    if (a >= 0) crushSpeed_[a] = std::max(crushSpeed_[a], speed(c.b));
    if (b >= 0) crushSpeed_[b] = std::max(crushSpeed_[b], speed(c.a));
  }
  bool any = false;
  for (std::size_t k = 0; k < crushed_.size(); ++k) {
    Motion& v = bodies.velocity[crushed_[k]];
    const double linear = length(v.linear()),
                 turning = std::abs(v.turn) * bodies.extent[crushed_[k]].turningReach();
    const double most = crushSpeed_[k];
    crushSpeed_[k] = linear > most || turning > most ? -1 : 0;  // from here on: whether it was
    any |= crushSpeed_[k] < 0;
    if (linear > most) {
      v.x *= most / linear;
      v.y *= most / linear;
    }
    if (turning > most) v.turn *= most / turning;
  }
  if (!any) return false;
  for (SolvedContact& c : lively_) {
    const int a = crushedAt_[c.a], b = crushedAt_[c.b];
    if ((a >= 0 && crushSpeed_[a] < 0) || (b >= 0 && crushSpeed_[b] < 0))
      for (ContactPoint& p : c.points) p.impulseN = p.impulseT = 0;
  }
  return true;
}

}  // namespace smokebox
