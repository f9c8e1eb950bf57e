// Which contacts are solved side by side: in colours, of which none has a moving body twice, and within a
// colour by kind, for blocks are done, or left out, as a whole.
#pragma once
#include <cstdint>
#include <vector>

#include "rigid/bodies.h"
#include "rigid/contact.h"

namespace smokebox {

class ContactLayout {
 public:
  /// Lays the contacts out in blocks of `lanes`. First what bears along gravity (`down`: of length 1, or
  /// (0, 0)), then what bears sideways, last what is merely near: a sweep in this order leaves the least
  /// undone, and does not change with what comes near. Those that find no colour are listed in `rest`.
  void arrange(const Bodies& bodies, const std::vector<Contact>& contacts, Vec2 down, int lanes,
               std::vector<int>& rest);
  int blocks() const { return colourEnds_.empty() ? 0 : colourEnds_.back(); }
  /// Where the blocks of each colour end.
  const std::vector<int>& colourEnds() const { return colourEnds_; }
  /// By lane: which contact; -1: none.
  const std::vector<int>& inLane() const { return inLane_; }
  /// By contact: block * lanes + lane; -1: it has none.
  const std::vector<int>& places() const { return place_; }
  void takeOut(int contact) { place_[contact] = -1; }
  /// All are in `rest`.
  void clear(int contacts, std::vector<int>& rest);

 private:
  struct Brief {
    int a, b, rank, count;
  };
  std::vector<Brief> brief_;         // of the contacts
  std::vector<std::uint64_t> used_;  // colours at each body
  std::vector<int> colour_, kind_, place_, start_, inLane_, colourEnds_;
};

}  // namespace smokebox
