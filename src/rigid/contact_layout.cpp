#include "rigid/contact_layout.h"

#include <bit>

namespace smokebox {

namespace {
constexpr int kColours = 64;
// Within a colour: those that bear or not, of two points or one.
constexpr int kKinds = 4;
}  // namespace

void ContactLayout::clear(int contacts, std::vector<int>& rest) {
  colourEnds_.clear();
  inLane_.clear();
  place_.assign(contacts, -1);
  rest.clear();
  for (int k = 0; k < contacts; ++k) rest.push_back(k);
}

void ContactLayout::arrange(const Bodies& bodies, const std::vector<Contact>& contacts, Vec2 down, int lanes,
                            std::vector<int>& rest) {
  const int count = static_cast<int>(contacts.size());
  used_.assign(bodies.count(), 0);
  colour_.resize(count);
  place_.assign(count, -1);
  start_.assign(kKinds * kColours + 1, 0);
  kind_.resize(count);
  colourEnds_.clear();
  rest.clear();
  brief_.resize(count);
  for (int k = 0; k < count; ++k) {
    const Contact& c = contacts[k];
    const bool bears = c.points[0].impulseN > 0 || c.points[1].impulseN > 0;
    const double along = dot(c.normal, down);
    brief_[k] = {c.a, c.b, !bears ? 2 : along * along > 0.5 ? 0 : 1, c.count};
  }
  for (const int rank : {0, 1, 2})
    for (int k = 0; k < count; ++k) {
      const Brief& c = brief_[k];
      if (c.rank != rank) continue;
      const bool movesA = bodies.moves(c.a), movesB = bodies.moves(c.b);
      const std::uint64_t used = (movesA ? used_[c.a] : 0) | (movesB ? used_[c.b] : 0);
      if (~used == 0) {
        colour_[k] = -1;
        rest.push_back(k);
        continue;
      }
      const int colour = std::countr_one(used);
      colour_[k] = colour;
      if (movesA) used_[c.a] |= std::uint64_t{1} << colour;
      if (movesB) used_[c.b] |= std::uint64_t{1} << colour;
      kind_[k] = kKinds * colour + (rank < 2 ? 0 : 2) + (c.count == 2 ? 0 : 1);
      ++start_[kind_[k] + 1];
    }
  // Each colour begins a new block.
  for (int colour = 0; colour < kColours; ++colour) {
    int lane = blocks() * lanes;
    for (int kind = kKinds * colour; kind < kKinds * (colour + 1); ++kind) {
      const int size = start_[kind + 1];
      start_[kind] = lane;
      lane += size;
    }
    colourEnds_.push_back((lane + lanes - 1) / lanes);
  }
  inLane_.assign(static_cast<std::size_t>(lanes) * blocks(), -1);
  for (int k = 0; k < count; ++k)
    if (colour_[k] >= 0) inLane_[place_[k] = start_[kind_[k]]++] = k;
}

}  // namespace smokebox
