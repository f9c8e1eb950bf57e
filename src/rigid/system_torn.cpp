// Joints that no motion can satisfy.
#include <algorithm>
#include <cmath>

#include "rigid/system_state.h"

namespace smokebox {

namespace {
// What is torn closes at this speed, m/s, where there is not even that much energy.
constexpr double kGentle = 2;

/// J, of half the scalar product by mass.
double energyOf(const InverseMass& m, const Motion& v, const Motion& w) {
  return (m.mass > 0 ? 0.5 * (v.x * w.x + v.y * w.y) / m.mass : 0) +
         (m.inertia > 0 ? 0.5 * v.turn * w.turn / m.inertia : 0);
}
}  // namespace

// A chain drawn straight between two nails, on which something falls, asks for impulses without bound. What
// hangs on such joints, and all that this touches, gets no more energy than it came with: of what the solver
// did to it only such a share is done. Momentum goes in equal shares, too.
void RigidSystem::State::yieldTorn() {
  joints.doubt(bodies);
  if (!joints.anyTorn()) return;
  torn.assign(bodies.count(), 0);
  joints.mark(torn);
  double mass = 0;
  for (int b = kWalls; b < bodies.count(); ++b)
    if (torn[b] && bodies.moves(b)) mass += 1 / bodies.inverse[b].mass;
  bool more = true;
  const auto spread = [&](const Contact& contact) {
    if (contact.count == 0 || !bodies.moves(contact.a) || !bodies.moves(contact.b)) return;
    if (torn[contact.a] == torn[contact.b]) return;
    torn[contact.a] = torn[contact.b] = 1;
    more = true;
  };
  while (more) {
    more = false;
    for (std::size_t k = 0; k < narrow.calm().size(); ++k)
      if (!narrow.isDropped(k)) spread(narrow.calm()[k]);
    for (const Contact& contact : narrow.lively()) spread(contact);
    more |= joints.mark(torn);
  }
  // The energy of start + share (velocity - start), as a polynomial of the share.
  double came = 0, linear = 0, squared = 0;
  const auto changeOf = [&](int b) -> Motion {
    const Motion &v = bodies.velocity[b], &was = start[b];
    return {v.x - was.x, v.y - was.y, v.turn - was.turn};
  };
  for (int b = kWalls; b < bodies.count(); ++b) {
    if (!torn[b] || !bodies.moves(b)) continue;
    const Motion change = changeOf(b);
    came += energyOf(bodies.inverse[b], start[b], start[b]);
    linear += 2 * energyOf(bodies.inverse[b], start[b], change);
    squared += energyOf(bodies.inverse[b], change, change);
  }
  if (!std::isfinite(squared)) {  // joints that pull against each other without bound
    for (int b = kWalls; b < bodies.count(); ++b)
      if (torn[b] && bodies.moves(b)) bodies.velocity[b] = start[b];
    return;
  }
  const double room = std::max(0.0, 0.5 * mass * kGentle * kGentle - came);
  if (linear + squared <= room) return;
  const double share =
      std::clamp((std::sqrt(linear * linear + 4 * squared * room) - linear) / (2 * squared), 0.0, 1.0);
  for (int b = kWalls; b < bodies.count(); ++b) {
    if (!torn[b] || !bodies.moves(b)) continue;
    const Motion change = changeOf(b);
    bodies.velocity[b] = {start[b].x + share * change.x, start[b].y + share * change.y,
                          start[b].turn + share * change.turn, 0};
  }
}

}  // namespace smokebox
