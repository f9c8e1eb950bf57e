// The stage of a sub-step that makes velocities obey contacts, joints and springs.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "rigid/contact_sweeps.h"
#include "rigid/lanes.h"
#include "rigid/system_state.h"

namespace smokebox {

namespace {
// A sub-step has more than two sweeps while it solves fewer points than this.
constexpr long kManySweeps = 6000, kManySweepsOfFew = 10000;
// Sweeps end when no relative velocity changes by more than this share of what gravity adds in a sub-step.
constexpr double kSettled = 1e-3;
// ... or by this share of what the first sweep changed beyond that: of impacts.
constexpr double kSettledShare = 1e-2;
// Both are this much less for a few points.
constexpr double kSettledFew = 1e-8;
constexpr long kFewPoints = 160;
// A contact that parts faster than it needs by so many times what a sweep changed is left out of the next
// one.
constexpr double kSpare = 4;
// So many sweeps are made before the further ones are drawn along a conjugate direction.
constexpr int kPlainSweeps = 3;
// Sweeps over joints and contacts diverge where one changes more than this times what the first ones did, and
// those at least this much, m/s.
constexpr int kFirstSweeps = 3;
constexpr double kDiverges = 4, kDivergesFrom = 1;
// Beyond these sweeps there are up to so many more where velocities change by this share of the bodies' width
// in a sub-step; over those places alone where they change by this share of that.
constexpr int kRoughSweeps = 16;
// In a press they go over so many times as many contacts as there are, at most: the second where it has no
// room left. There, who is thrown off its way waits for the next sub-step.
constexpr long kRoughTimes = 4, kRoughTimesNoRoom = 1;
constexpr double kRough = 3e-3, kRoughPlace = 0.1;
// Of an overlap, in each sub-step; at this speed at most, m/s.
constexpr double kSeparateShare = 0.25, kSeparateSpeed = 4;
// What overlaps by more than this share of the bodies' width is gone over so many more times, each at this
// share of the speed: gently all the same.
constexpr double kDeep = 0.01, kDeepSpeed = 0.125;
constexpr int kDeepRounds = 3;
}  // namespace

void RigidSystem::State::warmStartAll(double h) {
  switch (carried) {
    case Carried::all:
      bodies.velocity.swap(start);
      break;
    case Carried::share:
      for (int b = 0; b < bodies.count(); ++b) {
        const Lanes v = load(&bodies.velocity[b].x), added = load(&start[b].x);
        store(&start[b].x, v);
        store(&bodies.velocity[b].x, v + added);
      }
      break;
    case Carried::nothing:
      start = bodies.velocity;
      blocks.warmStart(bodies);
  }
  warmStart(bodies, spare);
  warmStart(bodies, narrow.lively());
  springs.warmStart(bodies, h);
  joints.warmStart(bodies, h);
}

void RigidSystem::State::findFlying(double h) {
  constexpr double kTouch = 1e-3;  // of what gravity does
  const double least = kTouch * h * length(gravity);
  for (int b = 0; b < bodies.count(); ++b) {
    const Motion &v = bodies.velocity[b], &was = start[b];
    flying[b] = std::abs(v.x - was.x) + std::abs(v.y - was.y) +
                    bodies.extent[b].reach * std::abs(v.turn - was.turn) <=
                least;
  }
}

// From what is carried on to the next sub-step, the part of the contacts that are solved one by one: they may
// be others then.
void RigidSystem::State::takeOutLone() {
  for (const std::vector<SolvedContact>* contacts : {&spare, &narrow.lively()})
    for (const SolvedContact& contact : *contacts)
      for (int k = 0; k < contact.count; ++k) {
        const ContactPoint& p = contact.points[k];
        const Vec2 j = p.impulseN * contact.normal + p.impulseT * perpendicular(contact.normal);
        auto one = [&](int body, Vec2 arm, double sign) {
          const InverseMass& m = bodies.inverse[body];
          start[body].x -= sign * m.mass * j.x;
          start[body].y -= sign * m.mass * j.y;
          start[body].turn -= sign * m.inertia * cross(arm, j);
        };
        one(contact.a, p.armA, -1);
        one(contact.b, p.armB, 1);
      }
}

MoveApart RigidSystem::State::moveApart(double h) const {
  const double slop = 0.5 * h * h * length(gravity);
  return {slop, kSeparateShare, kSeparateSpeed * h, std::max(kDeep * typicalWidth, slop)};
}

// Those in blocks have been moved apart once as the first sweep came by. That is not enough where a heap
// presses on a few: each is pushed back by the next one.
void RigidSystem::State::separateAll(double h) {
  MoveApart apart = moveApart(h);
  deepOnes.clear();
  for (std::vector<SolvedContact>* contacts : {&spare, &narrow.lively()})
    for (SolvedContact& contact : *contacts) {
      for (int k = 0; k < contact.count; ++k) contact.total += contact.points[k].impulseN;
      if (separate(bodies, contact, apart.share, apart.most) > apart.deep) deepOnes.push_back(&contact);
    }
  apart.most *= kDeepSpeed;
  for (int more = 0; more < kDeepRounds; ++more) {
    const bool any = blocks.separateDeep(bodies, apart);
    if (!any && deepOnes.empty()) return;
    for (SolvedContact* contact : deepOnes) separate(bodies, *contact, apart.share, apart.most);
  }
}

double RigidSystem::State::sweep(double h, bool first, double enough) {
  double change = 0;
  if (!joints.empty()) change = std::max(change, joints.solve(bodies, h));
  if (!springs.empty()) change = std::max(change, springs.solve(bodies, h));
  change = std::max(change, first ? blocks.sweepFirst(bodies, h, moveApart(h)) : blocks.sweep(bodies));
  change = std::max(change, solve(bodies, spare, enough));
  change = std::max(change, solve(bodies, narrow.lively(), enough));
  return change;
}

double RigidSystem::State::roughFrom(double h) const { return kRough * typicalWidth / h; }

// Where heaps land there is no time for sweeps until all is settled, but none may sink into another: those
// places are gone over some more times.
void RigidSystem::State::sweepRough(double h, double change) {
  const double enough = roughFrom(h), place = kRoughPlace * enough;
  if (change <= enough) return;
  blocks.beginRough(place);
  roughOnes.begin(bodies, spare, narrow.lively(), place);
  // In a press all may be rough, and no time is enough.
  long left = std::numeric_limits<long>::max();
  if (press.isOn()) {
    const long all = roughOnes.all() + static_cast<long>(narrow.calm().size());
    left = (press.hasRoom() ? kRoughTimes : kRoughTimesNoRoom) * all;
  }
  for (int more = 0; more < kRoughSweeps && change > enough && left > 0; ++more) {
    left -= roughOnes.size() + blocks.roughSize();
    change = std::max(blocks.sweepRough(bodies, place), roughOnes.sweep(bodies, place));
  }
}

void RigidSystem::State::solveContacts(double h) {
  warmStartAll(h);
  auto points = [&] {
    return 1 + blocks.points() + 8 * static_cast<long>(spare.size() + narrow.lively().size());
  };
  // The more there are, the less it matters that each one is settled to the last; few are solved to rounding.
  const bool few = points() <= kFewPoints && blocks.empty() && springs.empty() && joints.empty();
  const double care = few ? kSettledFew : 1;
  double settled = care * kSettled * (1 + 1e-3 * points()) * h * length(gravity) + care * 1e-9;
  const bool accelerates = !few && springs.empty() && joints.empty();
  stirred = false;
  prepare(bodies, spare, h);
  long left = few ? kManySweepsOfFew : kManySweeps;
  for (int round = 0; round < 3; ++round) {
    prepare(bodies, narrow.lively(), h);
    const long work = points(), cost = work + springs.sweepCost();
    conjugate.restart();
    double enough = std::numeric_limits<double>::infinity();  // the first sweep leaves none out
    double last = 0, most = 0;                                // m/s; most: of the first sweeps
    for (int sweeps = 1; sweeps <= method.maxSweeps; ++sweeps) {
      if (accelerates && sweeps >= kPlainSweeps) conjugate.remember(bodies, blocks, spare, narrow.lively());
      const double change = sweep(h, round == 0 && sweeps == 1, enough);
      enough = kSpare * change;
      last = change;
      if (sweeps <= kFirstSweeps)
        most = std::max({most, change, kDivergesFrom});
      else if (change > kDiverges * most)
        joints.stayLinear(bodies);
      left -= cost;
      if (sweeps == 1)
        settled =
            std::max(settled, care * std::min(kSettledShare, 1e-6 * work) * (change - h * length(gravity)));
      if (change <= settled) break;
      if (left < cost && (sweeps > 1 || blocks.areMany())) {
        sweepRough(h, change);
        break;
      }
      if (accelerates && sweeps >= kPlainSweeps)
        conjugate.extrapolate(bodies, blocks, spare, narrow.lively());
    }
    leftUndone = std::max(leftUndone, last);
    giveBackSpare();
    // Who would stray from the way expected of it has its pairs looked at again, before it moves.
    const auto stir = narrow.stir(bodies, nullptr, broad, gravity, blocks, timeLeft);
    if (stir == NarrowPhase::Stir::none) break;
    stirred = true;
    for (std::size_t k = 0; k < spare.size(); ++k)
      if (narrow.isDropped(uncoloured[k])) spare[k].count = 0;
    if (stir == NarrowPhase::Stir::later || (!press.hasRoom() && last > roughFrom(h))) break;
    narrow.refreshNew(bodies, broad, h, anyStruck ? &impact.moments() : nullptr);
  }
  if (firstOfStep) {
    if (!springs.empty()) springs.takeBackHalf(bodies, fresh, h);
    std::fill(fresh.begin(), fresh.end(), 0);
    firstOfStep = false;
  }
  if (!joints.empty()) yieldTorn();
  stirred |= narrow.yieldCrushed(bodies, start);
  press.yield(bodies);
  if (mayBounce) findFlying(h);
}

// Writes the impulses of those that are solved one by one where the others' are: whoever drops them finds
// them.
void RigidSystem::State::giveBackSpare() {
  for (std::size_t k = 0; k < spare.size(); ++k) {
    Contact& to = narrow.calm()[uncoloured[k]];
    for (int p = 0; p < spare[k].count; ++p) {
      to.points[p].impulseN = spare[k].points[p].impulseN;
      to.points[p].impulseT = spare[k].points[p].impulseT;
    }
    to.total += std::exchange(spare[k].total, 0);
  }
}

}  // namespace smokebox
