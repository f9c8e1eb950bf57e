#include "rigid/conjugate_sweeps.h"

namespace smokebox {

namespace {

/// visit(impulses, masses, count) for all impulses along normals and tangents, in a fixed order.
template <class Visit>
void eachImpulse(ContactBlocks& blocks, std::vector<Contact>& spare, std::vector<Contact>& lively,
                 Visit&& visit) {
  blocks.eachImpulse(visit);
  for (std::vector<Contact>* contacts : {&spare, &lively})
    for (Contact& contact : *contacts)
      for (int k = 0; k < contact.count; ++k) {
        ContactPoint& p = contact.points[k];
        visit(&p.impulseN, &p.massN, 1);
        visit(&p.impulseT, &p.massT, 1);
      }
}

}  // namespace

void ConjugateSweeps::remember(const Bodies& bodies, ContactBlocks& blocks, std::vector<Contact>& spare,
                               std::vector<Contact>& lively) {
  impulses_.clear();
  eachImpulse(blocks, spare, lively, [&](const double* impulse, const auto*, int count) {
    impulses_.insert(impulses_.end(), impulse, impulse + count);
  });
  velocities_ = bodies.velocity;
}

void ConjugateSweeps::extrapolate(Bodies& bodies, ContactBlocks& blocks, std::vector<Contact>& spare,
                                  std::vector<Contact>& lively) {
  // The squares of the changes over the effective masses: energies, whatever the masses are.
  double size = 0;
  std::size_t at = 0;
  eachImpulse(blocks, spare, lively, [&](const double* impulse, const auto* mass, int count) {
    for (int l = 0; l < count; ++l) {
      const double change = impulse[l] - impulses_[at++];
      if (mass[l] > 0) size += change * change / static_cast<double>(mass[l]);
    }
  });
  const bool goesOn = known_ && size_ > 0 && size <= size_;
  const double share = goesOn ? size / size_ : 0;
  direction_.resize(impulses_.size());
  turnedTo_.resize(velocities_.size());
  if (!goesOn) {
    std::fill(direction_.begin(), direction_.end(), 0.0);
    std::fill(turnedTo_.begin(), turnedTo_.end(), Motion{});
  }
  at = 0;
  eachImpulse(blocks, spare, lively, [&](double* impulse, const auto*, int count) {
    for (int l = 0; l < count; ++l, ++at) {
      const double change = impulse[l] - impulses_[at], more = share * direction_[at];
      impulse[l] += more;
      direction_[at] = more + change;
    }
  });
  for (std::size_t b = 0; b < velocities_.size(); ++b) {
    Motion &v = bodies.velocity[b], &turned = turnedTo_[b];
    const Motion& was = velocities_[b];
    const Motion change{v.x - was.x, v.y - was.y, v.turn - was.turn};
    const Motion more{share * turned.x, share * turned.y, share * turned.turn};
    v.x += more.x;
    v.y += more.y;
    v.turn += more.turn;
    turned = {more.x + change.x, more.y + change.y, more.turn + change.turn};
  }
  // After growth of the gradient it starts anew, with nothing.
  known_ = !known_ || goesOn;
  size_ = size;
}

}  // namespace smokebox
