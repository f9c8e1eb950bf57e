// The start of a step: which pairs are calm, and their contacts.
#include <algorithm>
#include <cmath>

#include "rigid/narrow_phase.h"

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
}  // namespace

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
  constexpr int kBodies = 512;
  pool_.blocks(0, count, kBodies, [&](int b, int end) {
    for (; b < end; ++b) {
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
  });
  auto& pairs = broad.pairs();
  livelyPair_.assign(pairs.size(), 0);
  pairsListed_ = false;
  lively_.clear();
  pairs_.clear();
  // Some at a time: which are lively, and what the others lack; then all are put together in their order.
  const int all = static_cast<int>(pairs.size());
  if (parts_.size() < pairs.size() / kTogether + 1) parts_.resize(pairs.size() / kTogether + 1);
  pool_.blocks(0, all, kTogether, [&](int first, int end) {
    Part& part = parts_[first / kTogether];
    sortPairs(part, broad, first, end, slow, dt);
    findDue(part, bodies, broad);
  });
  int contacts = 0;
  for (int first = 0; first < all; first += kTogether) {
    Part& part = parts_[first / kTogether];
    for (const int k : part.lively)
      makeLively(pairs[k].key, k, memory_.data() + pairs[k].first, pairs[k].count);
    part.first = contacts;
    contacts += part.contacts;
  }
  calm_.resize(contacts);
  pool_.blocks(0, all, kTogether,
               [&](int first, int end) { takePairs(parts_[first / kTogether], bodies, pairs, first, end); });
  for (SolvedContact& contact : lively_) contact.total = contact.approach = 0;
  dropped_.assign(calm_.size(), 0);
}

void NarrowPhase::sortPairs(Part& part, BroadPhase& broad, int begin, int end, double slow, double dt) {
  part.due.clear();
  part.lively.clear();
  part.contacts = 0;
  for (int k = begin; k < end; ++k) {
    BodyPair& pair = broad.pairs()[k];
    const Seen &a = seen_[pair.key.a], &b = seen_[pair.key.b];
    const double way = relativeWay(a, b, dt);
    if (movesFast(a, b, way, slow, dt)) {
      livelyPair_[k] = 1;
      part.lively.push_back(k);
    } else if (!mayKeep(a, b, pair, broad.shiftOf(pair.key), way)) {
      part.due.push_back(k);
    } else {
      part.contacts += pair.count;
    }
  }
}

void NarrowPhase::findDue(Part& part, const Bodies& bodies, BroadPhase& broad) {
  part.found.clear();
  for (std::size_t at = 0; at < part.due.size(); ++at) {
    PairContacts::askAhead(bodies, at, part.due.size(),
                           [&](std::size_t due) { return broad.pairs()[part.due[due]].key; });
    BodyPair& pair = broad.pairs()[part.due[at]];
    const Vec2 shift = broad.shiftOf(pair.key);
    const std::size_t first = part.found.size();
    double clear = clearance(bodies, pair.key, shift, 2 * pair.margin);
    if (clear <= pair.margin)
      clear = part.finder.find(bodies, pair.key, shift, pair.margin, h_, false, part.found, {});
    pair.follows = true;
    for (std::size_t c = first; c < part.found.size(); ++c) {
      Contact& contact = part.found[c];
      pair.follows &= contact.face > 0;
      inheritImpulses(memory_.data() + pair.first, pair.count,
                      kSamePlace * thinner(bodies, pair.key.a, pair.key.b), contact);
    }
    pair.apart = clear >= pair.margin;
    pair.margin = std::max(pair.margin, clear);
    pair.count = static_cast<int>(part.found.size() - first);
    part.contacts += pair.count;
  }
}

void NarrowPhase::takePairs(const Part& part, const Bodies& bodies, std::vector<BodyPair>& pairs, int begin,
                            int end) {
  int to = part.first;
  auto due = part.due.begin();
  const Contact* found = part.found.data();
  for (int k = begin; k < end; ++k) {
    BodyPair& pair = pairs[k];
    const int first = to;
    if (due != part.due.end() && *due == k) {
      ++due;
      for (int c = 0; c < pair.count; ++c) calm_[to++] = *found++;
    } else if (livelyPair_[k]) {
      pair.count = 0;
    } else {
      for (int c = 0; c < pair.count; ++c) {
        Contact& kept = calm_[to++] = memory_[pair.first + c];
        if (bodies.surfacesChanged) setSurfaces(bodies, kept);
        kept.total = kept.approach = 0;
      }
    }
    pair.first = first;
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

}  // namespace smokebox
