#include "rigid/conjugate_sweeps.h"

#include <type_traits>

namespace smokebox {

namespace {

/// visit(impulses, masses, count) for all impulses along normals and tangents, in a fixed order.
template <class Visit>
void eachImpulse(ContactBlocks& blocks, std::vector<SolvedContact>& spare, std::vector<SolvedContact>& lively,
                 Visit&& visit) {
  blocks.eachImpulse(visit);
  for (std::vector<SolvedContact>* contacts : {&spare, &lively})
    for (SolvedContact& contact : *contacts)
      for (int k = 0; k < contact.count; ++k) {
        ContactPoint& p = contact.points[k];
        visit(&p.impulseN, &contact.massN[k], 1);
        visit(&p.impulseT, &contact.massT[k], 1);
      }
}

}  // namespace

void ConjugateSweeps::list(const Bodies& bodies, const ContactBlocks& blocks,
                           const std::vector<SolvedContact>& spare,
                           const std::vector<SolvedContact>& lively) {
  isListed_.assign(bodies.count(), 0);
  auto add = [&](int body) {
    if (isListed_[body] || !bodies.moves(body)) return;
    isListed_[body] = 1;
    bodies_.push_back(body);
  };
  blocks.eachBody(add);
  for (const std::vector<SolvedContact>* contacts : {&spare, &lively})
    for (const SolvedContact& contact : *contacts) {
      add(contact.a);
      add(contact.b);
    }
}

void ConjugateSweeps::remember(const Bodies& bodies, ContactBlocks& blocks, std::vector<SolvedContact>& spare,
                               std::vector<SolvedContact>& lively) {
  if (bodies_.empty()) list(bodies, blocks, spare, lively);
  impulses_.clear();
  eachImpulse(blocks, spare, lively, [&](const auto* impulse, const auto*, int count) {
    impulses_.insert(impulses_.end(), impulse, impulse + count);
  });
  velocities_.clear();
  for (const int b : bodies_) velocities_.push_back(bodies.velocity[b]);
}

void ConjugateSweeps::extrapolate(Bodies& bodies, ContactBlocks& blocks, std::vector<SolvedContact>& spare,
                                  std::vector<SolvedContact>& lively) {
  // The squares of the changes over the effective masses: energies, whatever the masses are.
  double size = 0;
  std::size_t at = 0;
  eachImpulse(blocks, spare, lively, [&](const auto* impulse, const auto* mass, int count) {
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
  eachImpulse(blocks, spare, lively, [&](auto* impulse, const auto*, int count) {
    for (int l = 0; l < count; ++l, ++at) {
      const double change = impulse[l] - impulses_[at], more = share * direction_[at];
      impulse[l] = static_cast<std::remove_pointer_t<decltype(impulse)>>(impulse[l] + more);
      direction_[at] = more + change;
    }
  });
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    Motion &v = bodies.velocity[bodies_[k]], &turned = turnedTo_[k];
    const Motion& was = velocities_[k];
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
