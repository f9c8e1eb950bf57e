#include "rigid/narrow_phase.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "rigid/contact_sweeps.h"
#include "rigid/lanes.h"

namespace smokebox {

namespace {

// A pair is calm while its bodies move against each other by less than this share of the thinner one's width
// in a step (less if they bounce): the contact's normal and corners then still hold at its end.
constexpr double kCalm = 0.25, kCalmTurning = 0.05, kCalmBouncing = 0.01;
constexpr double kCalmTurn = 0.1;  // rad
// ... and whether they bounce or not, while they move by less than what so many sub-steps of gravity make of
// it: a bounce is hardly to be told from rest there.
constexpr double kCalmSubSteps = 10;
// A body may stray by this share of its width from the way expected of it, and by this share of that way; but
// no farther than the last one, and turn by no more than so many radians: that its normals still hold.
constexpr double kStray = 0.02, kStrayOnWay = 0.4, kStrayMost = 0.06, kStrayTurn = 0.05;
// What is sunk may stray by so much of its depth more: the normals of deep overlaps are good for that.
constexpr double kStraySunk = 0.5, kStrayTurnSunk = 0.3;
// Contacts are found anew once the bodies have moved by this share of the thinner one's width.
constexpr double kReuse = 2e-3, kReuseFollowing = 8e-3;
// ... or have turned by so much, rad, where the normal does not follow an edge: no stack leans on those of
// before.
constexpr double kReuseTurn = 1e-5;
// ... or, where both are sunk, by this share of what they may stray for that.
constexpr double kReuseSunk = 0.5;
// Lively ones, after this share: less where they bounce.
constexpr double kReuseLively = 4e-2, kReuseBouncing = 1e-2;
// A lively pair that is this many sub-steps apart is left alone for as long.
constexpr double kAhead = 4;
// Lively pairs are looked at while they are this share of the thinner one's width apart, beyond their way and
// what they may move until they are looked at again.
constexpr double kNear = 0.01;
// A point that has moved by less than this share of the thinner one's width goes on where another one was.
constexpr double kSamePlace = 0.1;
constexpr std::size_t kTogether = 256;  // pairs
constexpr double kNoBound = std::numeric_limits<double>::infinity();

}  // namespace

// A third of the way for each axis.
void NarrowPhase::setLimit(int body, double limit, double mostTurn) {
  const double reach = rooms_[body].reach;
  const double part = limit / 3, turn = std::min(reach > 0 ? part / reach : kNoBound, mostTurn);
  rooms_[body].limit = limit;
  rooms_[body].turn = mostTurn;
  expected_[body].within = {part * part, part * part, turn * turn};
}

void NarrowPhase::beginStep(const Bodies& bodies, BroadPhase& broad, const Press& press, Vec2 gravity,
                            double dt, int subSteps) {
  const int count = bodies.count();
  h_ = dt / subSteps;
  elapsed_ = 0;
  const double slow = kCalmSubSteps * h_ * length(gravity) * dt;
  expected_.resize(count);
  rooms_.resize(count);
  seen_.resize(count);
  stirred_.clear();
  way_.resize(count);
  for (int b = 0; b < count; ++b) {
    const Motion& v = bodies.velocity[b];
    const bool moves = bodies.there[b] && bodies.moves(b);
    const double fall = length(gravity) * std::abs(bodies.surface[b].gravityScale) * dt * dt;
    const Extent& extent = bodies.extent[b];
    const double stray = std::min(kStray * extent.thinnest + kStrayOnWay * dt * length(v.linear()),
                                  kStrayMost * extent.thinnest);
    const double sunk = moves ? kStraySunk * press.sunk(b) : 0;
    const double room = moves ? fall + stray + sunk : 0;
    expected_[b].velocity = v;
    rooms_[b] = {room, 0, 0, extent.turningReach()};
    if (moves)
      setLimit(b, room, sunk > 0 ? kStrayTurnSunk : kStrayTurn);
    else
      setLimit(b, kNoBound, kNoBound);
    const bool isMoving = v.x != 0 || v.y != 0 || v.turn != 0;
    Seen& seen = seen_[b];  // number by number: a whole one would be read before it is written
    seen.position = bodies.position[b];
    seen.velocity = v.linear();
    seen.angleRad = bodies.angleRad[b];
    seen.turn = static_cast<float>(v.turn);
    seen.thinnest = static_cast<float>(extent.thinnest);
    seen.turningReach = static_cast<float>(extent.turningReach());
    seen.room = static_cast<float>(room);
    seen.sunk = static_cast<float>(sunk);
    seen.bounces = bodies.surface[b].bounce > 0;
    seen.pushes = isMoving && !bodies.moves(b);
  }
  auto& pairs = broad.pairs();
  livelyPair_.assign(pairs.size(), 0);
  pairsListed_ = false;
  calm_.clear();
  lively_.clear();
  pairs_.clear();
  // Some at a time: the second look finds them in the cache.
  for (std::size_t k = 0; k < pairs.size(); k += kTogether) {
    const std::size_t end = std::min(k + kTogether, pairs.size());
    sortPairs(broad, k, end, slow, dt);
    takePairs(bodies, broad, k, end);
  }
  for (SolvedContact& contact : lively_) contact.total = contact.approach = 0;
  dropped_.assign(calm_.size(), 0);
}

void NarrowPhase::sortPairs(BroadPhase& broad, std::size_t begin, std::size_t end, double slow, double dt) {
  due_.clear();
  for (std::size_t k = begin; k < end; ++k) {
    BodyPair& pair = broad.pairs()[k];
    const Seen &a = seen_[pair.key.a], &b = seen_[pair.key.b];
    const double way = relativeWay(a, b, dt);
    if (movesFast(a, b, way, slow, dt)) {
      livelyPair_[k] = 1;
      makeLively(pair.key, static_cast<int>(k), memory_.data() + pair.first, pair.count);
    } else if (!mayKeep(a, b, pair, broad.shiftOf(pair.key), way)) {
      due_.push_back(static_cast<int>(k));
    }
  }
}

void NarrowPhase::takePairs(const Bodies& bodies, BroadPhase& broad, std::size_t begin, std::size_t end) {
  auto& pairs = broad.pairs();
  std::size_t next = 0;
  for (std::size_t k = begin; k < end; ++k) {
    BodyPair& pair = pairs[k];
    const std::size_t first = calm_.size();
    if (next < due_.size() && due_[next] == static_cast<int>(k)) {
      askAhead(
          next, [&](int due) { return pairs[due].key; }, bodies);
      ++next;
      const Vec2 shift = broad.shiftOf(pair.key);
      double clear = clearance(bodies, pair.key, shift, 2 * pair.margin);
      if (clear <= pair.margin)
        clear = finder_.find(bodies, pair.key, shift, pair.margin, h_, false, calm_, {});
      for (std::size_t c = first; c < calm_.size(); ++c)
        inheritImpulses(memory_.data() + pair.first, pair.count,
                        kSamePlace * thinner(bodies, pair.key.a, pair.key.b), calm_[c]);
      pair.apart = clear >= pair.margin;
      pair.follows = std::all_of(calm_.begin() + static_cast<std::ptrdiff_t>(first), calm_.end(),
                                 [](const Contact& c) { return c.face > 0; });
      pair.margin = std::max(pair.margin, clear);
    } else if (!livelyPair_[k]) {
      for (int c = 0; c < pair.count; ++c) {
        Contact& kept = calm_.emplace_back(memory_[pair.first + c]);
        if (bodies.surfacesChanged) setSurfaces(bodies, kept);
        kept.total = kept.approach = 0;
      }
    }
    pair.first = static_cast<int>(first);
    pair.count = static_cast<int>(calm_.size() - first);
  }
}

double NarrowPhase::relativeWay(const Seen& a, const Seen& b, double dt) {
  return (length(a.velocity - b.velocity) + std::abs(a.turn) * a.turningReach +
          std::abs(b.turn) * b.turningReach) *
         dt;
}

bool NarrowPhase::movesFast(const Seen& a, const Seen& b, double way, double slow, double dt) {
  const double thin = std::min(a.thinnest, b.thinnest);
  const double sunk = std::min(a.sunk, b.sunk);
  if (sunk > 0) return way > kCalm * thin + sunk;
  const bool bounces = a.bounces || b.bounces;
  const double turn = std::max(std::abs(a.turn), std::abs(b.turn)) * dt;
  return ((a.pushes || b.pushes) && way > kReuse * thin) ||
         way > (bounces ? std::clamp(slow, kCalmBouncing * thin, kCalm * thin) : kCalm * thin) ||
         (way > kCalmTurning * thin && turn > kCalmTurn);
}

bool NarrowPhase::mayKeep(const Seen& a, const Seen& b, BodyPair& pair, Vec2 shift, double way) const {
  const double thin = std::min(a.thinnest, b.thinnest);
  const double margin = way + a.room + b.room;
  const Vec2 between = b.position + shift - a.position;
  const double turnedA = std::abs(a.angleRad - pair.angleA), turnedB = std::abs(b.angleRad - pair.angleB);
  const double since = length(between - pair.between) + turnedA * a.turningReach + turnedB * b.turningReach;
  const double sunk = kReuseSunk * std::min(a.sunk, b.sunk);
  const bool same = (since <= kReuse * thin && std::max(turnedA, turnedB) <= kReuseTurn) ||
                    (since <= kReuseFollowing * thin && pair.follows) || since <= sunk;
  if ((pair.apart || same) && margin + since <= pair.margin) return true;
  pair.margin = margin + 2 * kReuseFollowing * thin + sunk;
  pair.between = between;
  pair.angleA = a.angleRad;
  pair.angleB = b.angleRad;
  return false;
}

template <class KeyOf>
void NarrowPhase::askAhead(std::size_t at, KeyOf&& keyOf, const Bodies& bodies) const {
  constexpr std::size_t kLong = 8, kSoon = 4;
  for (const std::size_t ahead : {kLong, kSoon}) {
    if (at + ahead >= due_.size()) continue;
    const PairKey key = keyOf(due_[at + ahead]);
    PairContacts::prefetch(bodies, key.a, ahead == kSoon);
    PairContacts::prefetch(bodies, key.b, ahead == kSoon);
  }
}

void NarrowPhase::makeLively(const PairKey& key, int pair, const Contact* old, int count) {
  LivelyPair made{key, static_cast<int>(lively_.size()), count, false, -1, pair};
  for (int k = 0; k < count; ++k) lively_.emplace_back(old[k]);
  pairs_.push_back(made);
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

bool NarrowPhase::isDue(LivelyPair& pair, const Bodies& bodies, Vec2 shift, double h) {
  const int a = pair.key.a, b = pair.key.b;
  const double thin = thinner(bodies, a, b);
  const double way = relativeSpeed(bodies, a, b) * h;
  pair.swept = way > kSwept * thin;
  pair.clear -= way;
  if (pair.clear >= 0) {
    for (int k = pair.first; k < pair.first + pair.count; ++k) {
      lively_[k].total = lively_[k].approach = 0;
      lively_[k].struck = false;
    }
    return false;
  }
  const bool bounces = bodies.surface[a].bounce > 0 || bodies.surface[b].bounce > 0;
  pair.reuse =
      (bounces ? kReuseBouncing : kReuseLively) * thin + kReuseSunk * std::min(seen_[a].sunk, seen_[b].sunk);
  pair.near = pair.swept ? way : way + kNear * thin + pair.reuse;
  const double clear = clearance(bodies, pair.key, shift, kAhead * pair.near);
  if (clear <= pair.near) return true;
  pair.clear = clear - pair.near;
  dropContacts(pair);
  return false;
}

void NarrowPhase::refresh(const Bodies& bodies, const BroadPhase& broad, double h,
                          const std::vector<double>* since) {
  refreshed_ = 0;
  refreshNew(bodies, broad, h, since);
}

void NarrowPhase::refreshNew(const Bodies& bodies, const BroadPhase& broad, double h,
                             const std::vector<double>* since) {
  due_.clear();
  for (; refreshed_ < pairs_.size(); ++refreshed_) {
    LivelyPair& pair = pairs_[refreshed_];
    if (isDue(pair, bodies, broad.shiftOf(pair.key), h)) due_.push_back(static_cast<int>(refreshed_));
  }
  for (std::size_t k = 0; k < due_.size(); ++k) {
    askAhead(
        k, [&](int due) { return pairs_[due].key; }, bodies);
    LivelyPair& pair = pairs_[due_[k]];
    const double later = since ? std::max((*since)[pair.key.a], (*since)[pair.key.b]) : 0;
    next_.clear();
    const double clear = finder_.find(bodies, pair.key, broad.shiftOf(pair.key), pair.near, h, pair.swept,
                                      next_, {later, {}, {}});
    pair.clear = !next_.empty() && !pair.swept ? pair.reuse : clear - pair.near;
    replace(pair, bodies);
  }
}

void NarrowPhase::refreshAfterImpacts(const Bodies& bodies, const BroadPhase& broad, double h,
                                      const std::vector<Motion>& struck,
                                      const std::vector<double>& struckAt) {
  auto wasStruck = [&](int body) {
    const Motion& m = struck[body];
    return m.x != 0 || m.y != 0 || m.turn != 0;
  };
  // What was found holds while the two have not moved far against each other since.
  auto isDue = [&](LivelyPair& pair) {
    const int a = pair.key.a, b = pair.key.b;
    const auto begin = lively_.begin() + pair.first, end = begin + pair.count;
    if ((!wasStruck(a) && !wasStruck(b)) ||
        std::any_of(begin, end, [](const SolvedContact& c) { return c.struck; }))
      return false;
    const double way = relativeSpeed(bodies, a, b) * h;
    auto reach = [&](int body) {
      return length(struck[body].linear()) + std::abs(struck[body].turn) * bodies.extent[body].turningReach();
    };
    pair.swept = way > kSwept * thinner(bodies, a, b);
    pair.clear -= way + reach(a) + reach(b);
    return pair.swept || pair.clear < 0;
  };
  for (LivelyPair& pair : pairs_) {
    if (!isDue(pair)) continue;
    const int a = pair.key.a, b = pair.key.b;
    const double thin = thinner(bodies, a, b), way = relativeSpeed(bodies, a, b) * h;
    pair.clear = 0;
    const double margin = pair.swept ? way : way + kNear * thin;
    const double reach = margin + length(struck[a].linear()) + length(struck[b].linear());
    next_.clear();
    if (clearance(bodies, pair.key, broad.shiftOf(pair.key), reach + way) <= reach + way)
      finder_.find(bodies, pair.key, broad.shiftOf(pair.key), margin, h, pair.swept, next_,
                   {std::max(struckAt[a], struckAt[b]), struck[a], struck[b]});
    replace(pair, bodies);
  }
}

/// Places that are left over have contacts without a point.
void NarrowPhase::dropContacts(const LivelyPair& pair) {
  for (int k = pair.first; k < pair.first + pair.count; ++k) {
    lively_[k].count = 0;
    lively_[k].total = lively_[k].bounce = 0;
  }
}

/// Puts what is in next_ into the place of a pair's contacts, or behind all others.
void NarrowPhase::replace(LivelyPair& pair, const Bodies& bodies) {
  const int count = static_cast<int>(next_.size());
  const double near = kSamePlace * thinner(bodies, pair.key.a, pair.key.b);
  for (Contact& contact : next_) inheritImpulses(lively_.data() + pair.first, pair.count, near, contact);
  dropContacts(pair);
  if (count > pair.count) {
    pair.first = static_cast<int>(lively_.size());
    lively_.resize(lively_.size() + count);
  }
  pair.count = count;
  for (int k = 0; k < count; ++k) {
    SolvedContact& contact = lively_[pair.first + k] = SolvedContact(next_[k]);
    setMasses(bodies, contact);
  }
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
  int count = 0;
  for (int b = 0; b < bodies.count(); ++b) {
    const Lanes by = on(b), now = off(b, by), then = now + later * by;
    const Lanes p = now * now, q = then * then;
    leaving_[count] = b;
    count += anyOf((p > q ? p : q) > load(&expected_[b].within.x)) ? 1 : 0;
  }
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

bool NarrowPhase::mayPass(const Bodies& bodies, double h) const {
  return std::any_of(pairs_.begin(), pairs_.end(), [&](const LivelyPair& pair) {
    return relativeSpeed(bodies, pair.key.a, pair.key.b) * h >
           kSwept * thinner(bodies, pair.key.a, pair.key.b);
  });
}

void NarrowPhase::stopPassing(const Bodies& bodies, const BroadPhase& broad, double h,
                              const std::vector<double>* since, std::vector<Motion>& way) {
  swept_.clear();
  for (const LivelyPair& pair : pairs_) swept_.push_back(pair.key);
  passing_.stop(bodies, broad, swept_, h, since, way);
}

void NarrowPhase::endStep(BroadPhase& broad) {
  memory_.swap(calm_);
  auto& pairs = broad.pairs();
  for (const LivelyPair& lively : pairs_) {
    if (lively.pair < 0) continue;
    BodyPair& pair = pairs[lively.pair];
    pair.first = static_cast<int>(memory_.size());
    pair.count = lively.count;
    pair.margin = -1;
    memory_.insert(memory_.end(), lively_.begin() + lively.first,
                   lively_.begin() + lively.first + lively.count);
  }
}

std::size_t NarrowPhase::bytes() const {
  return (calm_.capacity() + next_.capacity() + memory_.capacity()) * sizeof(Contact) +
         lively_.capacity() * sizeof(SolvedContact) + pairs_.capacity() * sizeof(LivelyPair);
}

}  // namespace smokebox
