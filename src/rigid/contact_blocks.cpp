#include "rigid/contact_blocks.h"

namespace smokebox {

namespace {
// So few contacts would leave most lanes empty: they are solved one by one.
constexpr int kFew = 12;
// More contacts than so many are worked in float32 while they are rough.
constexpr int kBrief = 1000;
// More points than so many are swept but once in a sub-step, and each one gives more than it is asked for
// (successive over-relaxation): bins of 10,000 overlap as little as by two sweeps. A wall of 100 by 100 boxes
// would not stand.
constexpr long kMany = 30000;
constexpr double kOverRelaxed = 1.45;
}  // namespace

void ContactBlocks::build(const Bodies& bodies, const std::vector<Contact>& contacts, std::vector<int>& rest,
                          Vec2 down, bool areRough) {
  const int count = static_cast<int>(contacts.size());
  exact_.clear();
  brief_.clear();
  points_ = 0;
  isBrief_ = areRough && count > kBrief;
  if (count <= kFew) {
    layout_.clear(count, rest);
    return;
  }
  layout_.arrange(bodies, contacts, down, isBrief_ ? brief_.kLanes : exact_.kLanes, rest);
  for (const Contact& contact : contacts) points_ += contact.count;
  inUse(*this, [&]<class Number>(BlockSweeps<Number>& blocks) {
    blocks.fill(bodies, contacts, layout_, static_cast<Number>(areMany() ? kOverRelaxed : 1));
  });
}

bool ContactBlocks::areMany() const { return points_ > kMany; }

void ContactBlocks::warmStart(Bodies& bodies) const {
  inUse(*this, [&](auto& blocks) { blocks.warmStart(bodies); });
}

double ContactBlocks::sweepFirst(Bodies& bodies, double h, const MoveApart& apart) {
  return inUse(*this, [&](auto& blocks) { return blocks.sweepFirst(bodies, h, apart); });
}

double ContactBlocks::sweep(Bodies& bodies) {
  return inUse(*this, [&](auto& blocks) { return blocks.sweep(bodies); });
}

bool ContactBlocks::separateDeep(Bodies& bodies, const MoveApart& apart) {
  return inUse(*this, [&](auto& blocks) { return blocks.separateDeep(bodies, apart); });
}

void ContactBlocks::beginRough(double above) {
  inUse(*this, [&](auto& blocks) { blocks.beginRough(above); });
}

double ContactBlocks::sweepRough(Bodies& bodies, double above) {
  return inUse(*this, [&](auto& blocks) { return blocks.sweepRough(bodies, above); });
}

void ContactBlocks::drop(int index, Contact& contact) {
  const int place = layout_.places()[index];
  if (place < 0) return;
  inUse(*this, [&](auto& blocks) {
    blocks.read(place, contact);
    blocks.drop(place);
  });
  layout_.takeOut(index);
}

void ContactBlocks::readBack(int index, Contact& contact) const {
  const int place = layout_.places()[index];
  if (place >= 0) inUse(*this, [&](auto& blocks) { blocks.read(place, contact); });
}

}  // namespace smokebox
