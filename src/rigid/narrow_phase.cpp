#include "rigid/narrow_phase.h"

#include <algorithm>
#include <cmath>

#include "rigid/contact_sweeps.h"

namespace smokebox {

namespace {
// Lively contacts are found anew once the bodies have moved by this share of the thinner one's width: less
// where they bounce.
constexpr double kReuseLively = 4e-2, kReuseBouncing = 1e-2;
// A lively pair that is this many sub-steps apart is left alone for as long.
constexpr double kAhead = 4;
// Lively pairs are looked at while they are this share of the thinner one's width apart, beyond their way and
// what they may move until they are looked at again.
constexpr double kNear = 0.01;
constexpr int kDue = 32;  // a thread looks for the contacts of so many at a time
}  // namespace

void NarrowPhase::makeLively(const PairKey& key, int pair, const Contact* old, int count) {
  LivelyPair made{key, static_cast<int>(lively_.size()), count, false, -1, pair};
  for (int k = 0; k < count; ++k) lively_.emplace_back(old[k]);
  pairs_.push_back(made);
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
  const int all = static_cast<int>(pairs_.size());
  pool_.blocks(refreshed_, all, kTogether, [&](int k, int end) {
    for (; k < end; ++k) pairs_[k].due = isDue(pairs_[k], bodies, broad.shiftOf(pairs_[k].key), h);
  });
  due_.clear();
  for (; refreshed_ < all; ++refreshed_)
    if (pairs_[refreshed_].due) due_.push_back(refreshed_);
  if (parts_.size() < due_.size() / kDue + 1) parts_.resize(due_.size() / kDue + 1);
  const int due = static_cast<int>(due_.size());
  pool_.blocks(0, due, kDue, [&](int at, int end) {
    Part& part = parts_[at / kDue];
    part.found.clear();
    for (; at < end; ++at) {
      PairContacts::askAhead(bodies, at, due_.size(), [&](std::size_t k) { return pairs_[due_[k]].key; });
      LivelyPair& pair = pairs_[due_[at]];
      const std::size_t first = part.found.size();
      const double later = since ? std::max((*since)[pair.key.a], (*since)[pair.key.b]) : 0;
      const double clear = part.finder.find(bodies, pair.key, broad.shiftOf(pair.key), pair.near, h,
                                            pair.swept, part.found, {later, {}, {}});
      pair.found = static_cast<int>(part.found.size() - first);
      pair.clear = pair.found > 0 && !pair.swept ? pair.reuse : clear - pair.near;
    }
  });
  for (int at = 0; at < due; at += kDue) {
    Contact* found = parts_[at / kDue].found.data();
    for (int k = at; k < std::min(at + kDue, due); ++k) {
      LivelyPair& pair = pairs_[due_[k]];
      replace(pair, bodies, found, pair.found);
      found += pair.found;
    }
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
    replace(pair, bodies, next_.data(), static_cast<int>(next_.size()));
  }
}

/// Places that are left over have contacts without a point.
void NarrowPhase::dropContacts(const LivelyPair& pair) {
  for (int k = pair.first; k < pair.first + pair.count; ++k) {
    lively_[k].count = 0;
    lively_[k].total = lively_[k].bounce = 0;
  }
}

/// Puts the contacts that were found in the place of a pair's, or behind all others.
void NarrowPhase::replace(LivelyPair& pair, const Bodies& bodies, Contact* found, int count) {
  const double near = kSamePlace * thinner(bodies, pair.key.a, pair.key.b);
  for (int k = 0; k < count; ++k) inheritImpulses(lively_.data() + pair.first, pair.count, near, found[k]);
  dropContacts(pair);
  if (count > pair.count) {
    pair.first = static_cast<int>(lively_.size());
    lively_.resize(lively_.size() + count);
  }
  pair.count = count;
  for (int k = 0; k < count; ++k) {
    SolvedContact& contact = lively_[pair.first + k] = SolvedContact(found[k]);
    setMasses(bodies, contact);
  }
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
