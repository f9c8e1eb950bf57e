// Which bodies can meet: pairs of bodies whose fat boxes overlap. A body's fat box holds its way through the
// coming step and some room, so that one which rests or drifts needs no new search: near-linear in the number
// of bodies. Beyond periodic sides a body meets the images of others.
#pragma once
#include <compare>
#include <vector>

#include "base/threads.h"
#include "rigid/bodies.h"
#include "rigid/box_tree.h"

namespace smokebox {

/// b's image that a meets lies `sx` widths and `sy` heights from b itself.
struct PairKey {
  int a = 0, b = 0;
  std::int8_t sx = 0, sy = 0;
  auto operator<=>(const PairKey&) const = default;
};

struct alignas(64) BodyPair {
  PairKey key;
  bool apart = false;    // there is nothing closer than `margin`, whatever turns: not only no contact
  bool follows = false;  // its contacts go along with an edge, each
  // Contacts of the last step, from then on of this one: a range of the narrow phase's ...
  int first = 0, count = 0;
  // ... all that are closer than `margin` (below 0: to be found anew) ...
  double margin = -1;
  // ... when b was there, seen from a, and they had turned so far.
  Vec2 between{};
  double angleA = 0, angleB = 0;
};
static_assert(sizeof(BodyPair) == 64);

class BroadPhase {
 public:
  BroadPhase(const RigidWalls& walls, ThreadPool& pool) : walls_(walls), pool_(pool) {}

  /// Brings pairs() up to date for a step of `dt`.
  void update(const Bodies& bodies, Vec2 gravity, double dt);
  /// Within a step: makes sure that the box of each body that is listed holds its way for another `dt`, from
  /// now or from the end of `way`. Gives pairs that are new; pairs() has them from the next update on.
  void extend(const Bodies& bodies, const std::vector<int>& which, const std::vector<Motion>& way,
              Vec2 gravity, double dt, std::vector<PairKey>& found);

  /// Whom it may meet has changed: they are searched for anew.
  void lookAgain(int body) {
    if (body < static_cast<int>(listed_.size())) listed_[body] = 0;
  }

  std::vector<BodyPair>& pairs() { return pairs_; }
  Vec2 shiftOf(const PairKey& key) const { return {key.sx * walls_.width, key.sy * walls_.height}; }

 private:
  bool fit(const Bodies& bodies, int body, Vec2 gravity, double dt, Vec2 later = {});
  void refitTree(long moved);
  void search(const Bodies& bodies, int body, bool imagesOnly, std::vector<PairKey>& found) const;
  void dropAndInsert(const Bodies& bodies);
  void searchAll(const Bodies& bodies, long moved, std::vector<PairKey>& found);

  RigidWalls walls_;
  ThreadPool& pool_;
  std::vector<Box> fat_;
  std::vector<char> listed_, refitted_;  // by body
  BoxTree tree_;
  std::vector<std::uint64_t> groups_;  // by body
  std::vector<int> items_;
  std::vector<BodyPair> pairs_, next_;
  std::vector<PairKey> found_, late_;  // late: found within a step
  long sinceBuild_ = 0;
};

}  // namespace smokebox
