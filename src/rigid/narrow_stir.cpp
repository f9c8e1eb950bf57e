// Bodies that leave the way that was expected of them, and what becomes of their pairs.
#include <algorithm>
#include <cmath>
#include <utility>

#include "rigid/lanes.h"
#include "rigid/narrow_phase.h"

namespace smokebox {

namespace {
constexpr int kBodies = 2048;  // a thread looks at so many at a time
}  // namespace

// A third of the way for each axis.
void NarrowPhase::setLimit(int body, double limit, double mostTurn) {
  const double reach = rooms_[body].reach;
  const double part = limit / 3, turn = std::min(reach > 0 ? part / reach : kNoBound, mostTurn);
  rooms_[body].limit = limit;
  rooms_[body].turn = mostTurn;
  expected_[body].within = {part * part, part * part, turn * turn};
}

// Those in which a body is the first one lie side by side as they are.
void NarrowPhase::listPairs(const Bodies& bodies, const std::vector<BodyPair>& pairs) {
  pairsOfFirst_.assign(bodies.count() + 1, 0);
  pairsOfSecond_.assign(bodies.count() + 2, 0);
  for (const BodyPair& pair : pairs) {
    ++pairsOfFirst_[pair.key.a + 1];
    ++pairsOfSecond_[pair.key.b + 2];
  }
  for (int b = 0; b < bodies.count(); ++b) {
    pairsOfFirst_[b + 1] += pairsOfFirst_[b];
    pairsOfSecond_[b + 2] += pairsOfSecond_[b + 1];
  }
  pairsAt_.resize(pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k)
    pairsAt_[pairsOfSecond_[pairs[k].key.b + 1]++] = static_cast<int>(k);
  pairsListed_ = true;
}

bool NarrowPhase::findLeaving(const Bodies& bodies, const std::vector<Motion>* struck, double timeLeft) {
  const double later = timeLeft > 1.5 * h_ ? 1 : 0;
  const double h = h_, elapsed = elapsed_;
  const auto on = [&](int b) {
    const Lanes by = h * load(&bodies.velocity[b].x) - h * load(&expected_[b].velocity.x);
    return struck ? by + load(&(*struck)[b].x) : by;
  };
  const auto off = [&](int b, Lanes by) {
    return load(&bodies.moved[b].x) + by - elapsed * load(&expected_[b].velocity.x);
  };
  // Most are far from leaving; who is not is put down first, which takes no guess at what comes next.
  leaving_.resize(bodies.count());
  leavingOf_.assign(bodies.count() / kBodies + 1, 0);
  pool_.blocks(0, bodies.count(), kBodies, [&](int begin, int end) {
    int count = begin;
    for (int b = begin; b < end; ++b) {
      const Lanes by = on(b), now = off(b, by), then = now + later * by;
      const Lanes p = now * now, q = then * then;
      leaving_[count] = b;
      count += anyOf((p > q ? p : q) > load(&expected_[b].within.x)) ? 1 : 0;
    }
    leavingOf_[begin / kBodies] = count - begin;
  });
  int count = 0;
  for (std::size_t part = 0; part < leavingOf_.size(); ++part)
    for (int k = 0; k < leavingOf_[part]; ++k) leaving_[count++] = leaving_[kBodies * part + k];
  leaving_.resize(count);
  bool any = false;
  std::erase_if(leaving_, [&](int b) {
    const Room& room = rooms_[b];
    const auto leaves = [&](Lanes by) {
      const double left = room.limit - std::abs(by[2]) * room.reach;
      return left < 0 || std::abs(by[2]) > room.turn || by[0] * by[0] + by[1] * by[1] > left * left;
    };
    const Lanes by = on(b), now = off(b, by);
    const bool leavesNow = leaves(now);
    any |= leavesNow;
    return !leavesNow && !leaves(now + later * by);
  });
  return any;
}

NarrowPhase::Stir NarrowPhase::stir(const Bodies& bodies, const std::vector<Motion>* struck,
                                    BroadPhase& broad, Vec2 gravity, ContactBlocks& blocks, double timeLeft) {
  turned_.clear();
  auto wayOf = [&](int b) -> Motion {
    const Motion &v = bodies.velocity[b], by = struck ? (*struck)[b] : Motion{};
    return {by.x + h_ * v.x, by.y + h_ * v.y, by.turn + h_ * v.turn};
  };
  bool now = false;
  // Those whose pairs are lively already: does the box still hold the way?
  for (const int b : stirred_) {
    const Motion& v = bodies.velocity[b];
    const Vec2 changed = v.linear() - expected_[b].velocity.linear();
    const double room = rooms_[b].room, slack = 0.5 * room / timeLeft;
    if (dot(changed, changed) <= slack * slack) continue;
    now |= length(changed) * h_ > 0.5 * room;
    expected_[b].velocity = v;
    turned_.push_back(b);
  }
  now |= findLeaving(bodies, struck, timeLeft);
  for (const int b : leaving_) {
    expected_[b].velocity = bodies.velocity[b];
    setLimit(b, kNoBound, kNoBound);
    stirred_.push_back(b);
  }
  if (leaving_.empty() && turned_.empty()) return Stir::none;
  bool any = false;
  const auto& pairs = broad.pairs();
  if (!pairsListed_) listPairs(bodies, pairs);
  const auto enliven = [&](int k) {
    if (std::exchange(livelyPair_[k], 1)) return;
    any = true;
    const BodyPair& pair = pairs[k];
    for (int c = pair.first; c < pair.first + pair.count; ++c) {
      blocks.drop(c, calm_[c]);
      dropped_[c] = 1;
    }
    makeLively(pair.key, k, calm_.data() + pair.first, pair.count);
  };
  for (const int body : leaving_) {
    for (int at = pairsOfSecond_[body]; at < pairsOfSecond_[body + 1]; ++at) enliven(pairsAt_[at]);
    for (int k = pairsOfFirst_[body]; k < pairsOfFirst_[body + 1]; ++k) enliven(k);
  }
  late_.clear();
  leaving_.insert(leaving_.end(), turned_.begin(), turned_.end());
  for (const int b : leaving_) way_[b] = wayOf(b);
  broad.extend(bodies, leaving_, way_, gravity, timeLeft, late_);
  for (const PairKey& key : late_) {
    makeLively(key, -1, nullptr, 0);
    any = true;
  }
  return !any ? Stir::none : now ? Stir::now : Stir::later;
}

}  // namespace smokebox
