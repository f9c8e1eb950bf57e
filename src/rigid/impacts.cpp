#include "rigid/impacts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "rigid/collide.h"
#include "rigid/contact_sweeps.h"

namespace smokebox {

namespace {
// Points of one contact that close within this share of a sub-step of each other strike together.
constexpr double kTogether = 0.02;
// Impacts of one body within a sub-step, at most.
constexpr int kMostTimes = 8;
// After so many, the slowest approach that still bounces doubles with each one: a heap comes to rest soon.
constexpr int kFreeTimes = 2, kFreeTimesFlying = 6;

// Of the slowest approach that bounces, where both fly freely: their speeds are true to the last bit, while
// what lies on something seems to fall by up to a sub-step's gravity before the contact solver holds it.
constexpr double kOfFlying = 0.05;

// Impacts of a step, beyond so many and so many for each body: the slowest approach that still bounces
// doubles with each further so many. A crowd that is driven together settles what is left in the contact
// solver.
constexpr long kFreeOfStep = 1000, kFreeOfBody = 2, kDoubling = 100;

// An impact whose outcome is off by more than this share of the approach does not happen.
constexpr double kAsReckoned = 0.1;
// Joints that leave less than this share of what the bodies would do alone hold them altogether.
constexpr double kHeld = 1e-7;

/// What displacements make of a point's gap.
double gapOf(const std::vector<Motion>& way, const Contact& contact, const ContactPoint& point) {
  const Motion &wa = way[contact.a], &wb = way[contact.b];
  return dot(contact.normal, wb.linear() - wa.linear()) + wb.turn * cross(point.armB, contact.normal) -
         wa.turn * cross(point.armA, contact.normal);
}
}  // namespace

Vec2 Impacts::acceleration(const Bodies& bodies, const Contact& contact) const {
  const double b = bodies.moves(contact.b) ? bodies.surface[contact.b].gravityScale : 0;
  const double a = bodies.moves(contact.a) ? bodies.surface[contact.a].gravityScale : 0;
  return (b - a) * gravity_;
}

Impacts::Approach Impacts::approach(const Bodies& bodies, const std::vector<Motion>& way,
                                    const Contact& contact, const ContactPoint& point, double h, double now,
                                    double least) const {
  const double a = dot(acceleration(bodies, contact), contact.normal);
  const double v = partingSpeed(bodies, contact, point) - 0.5 * a * h;  // at the sub-step's start
  if (v + std::min(a * h, 0.0) >= -least) return {};                    // never that fast
  const double gap = point.gap + gapMoved(bodies, contact, point) + gapOf(way, contact, point);
  double t = now;
  if (gap + (v + 0.5 * a * now) * now > 0) {
    const double root = v * v - 2 * a * gap;
    if (root < 0 || (v >= 0 && a >= 0)) return {};  // thrown up, it may fall back
    t = std::max(2 * gap / (-v + std::sqrt(root)), now);
    if (t > h) return {};
  }
  return {t, v + a * t};
}

void Impacts::schedule(const Bodies& bodies, const std::vector<Motion>& way,
                       const std::vector<Contact*>& contacts, int k, double h, double least) {
  const Contact& contact = *contacts[k];
  const double now = std::max(struckAt_[contact.a], struckAt_[contact.b]);
  least = leastOf(contact, least);
  ++stamps_[k];
  double first = h;
  bool any = false;
  for (int p = 0; p < contact.count; ++p) {
    const Approach at = approach(bodies, way, contact, contact.points[p], h, now, least);
    if (at.speed >= -least) continue;
    any = true;
    first = std::min(first, at.time);
  }
  if (!any) return;
  heap_.push_back({first, k, stamps_[k]});
  std::push_heap(heap_.begin(), heap_.end());
}

void Impacts::pushTied(Bodies& bodies, const Contact& contact, Vec2 armA, Vec2 armB, Vec2 impulse) {
  const Motion a = bodies.velocity[contact.a], b = bodies.velocity[contact.b];
  bodies.push(contact.a, armA, -impulse);
  bodies.push(contact.b, armB, impulse);
  const Motion &nowA = bodies.velocity[contact.a], &nowB = bodies.velocity[contact.b];
  joints_.react(bodies, contact.a, {nowA.x - a.x, nowA.y - a.y, nowA.turn - a.turn}, contact.b,
                {nowB.x - b.x, nowB.y - b.y, nowB.turn - b.turn});
}

double Impacts::response(Bodies& bodies, const Contact& contact, const ContactPoint& p, Vec2 d,
                         const ContactPoint& q, Vec2 e) {
  const InverseMass &ma = bodies.inverse[contact.a], &mb = bodies.inverse[contact.b];
  const double alone = dot(d, e) * (ma.mass + mb.mass) + ma.inertia * cross(p.armA, d) * cross(q.armA, e) +
                       mb.inertia * cross(p.armB, d) * cross(q.armB, e);
  if (!isTied(contact)) return alone;
  const auto parting = [&] {
    return dot(d, bodies.velocityAt(contact.b, p.armB) - bodies.velocityAt(contact.a, p.armA));
  };
  before_.clear();
  for (const int body : together_) {
    before_.push_back(bodies.velocity[body]);
    bodies.velocity[body] = {};
  }
  const double still = parting();
  pushTied(bodies, contact, q.armA, q.armB, e);
  const double made = parting() - still;
  for (std::size_t k = 0; k < together_.size(); ++k) bodies.velocity[together_[k]] = before_[k];
  return std::fabs(made) > kHeld * std::fabs(alone) ? made : 0;
}

void Impacts::push(Bodies& bodies, const Contact& contact, Vec2 armA, Vec2 armB, Vec2 impulse, double time,
                   std::vector<Motion>& way) {
  if (isTied(contact)) {
    before_.clear();
    for (const int body : together_) before_.push_back(bodies.velocity[body]);
    pushTied(bodies, contact, armA, armB, impulse);
    for (std::size_t k = 0; k < together_.size(); ++k) {
      const Motion &after = bodies.velocity[together_[k]], &before = before_[k];
      Motion& w = way[together_[k]];
      w.x -= time * (after.x - before.x);
      w.y -= time * (after.y - before.y);
      w.turn -= time * (after.turn - before.turn);
    }
    return;
  }
  auto one = [&](int body, Vec2 arm, Vec2 j) {
    const Motion before = bodies.velocity[body];
    bodies.push(body, arm, j);
    const Motion& after = bodies.velocity[body];
    way[body].x -= time * (after.x - before.x);
    way[body].y -= time * (after.y - before.y);
    way[body].turn -= time * (after.turn - before.turn);
  };
  one(contact.a, armA, -impulse);
  one(contact.b, armB, impulse);
}

void Impacts::remember(const Bodies& bodies, const std::vector<Motion>& way) {
  kept_.clear();
  for (const int body : together_) kept_.push_back({bodies.velocity[body], way[body]});
}

void Impacts::restore(Bodies& bodies, std::vector<Motion>& way) const {
  for (std::size_t k = 0; k < together_.size(); ++k) {
    bodies.velocity[together_[k]] = kept_[k][0];
    way[together_[k]] = kept_[k][1];
  }
}

Frame Impacts::frameAt(const Bodies& bodies, const std::vector<Motion>& way, int body, double h,
                       double time) const {
  const Motion &m = bodies.moved[body], &w = way[body], &v = bodies.velocity[body];
  // Gravity bends the way within the sub-step; at its start and its end the bend is 0.
  const double bend = bodies.moves(body) ? 0.5 * bodies.surface[body].gravityScale * time * (time - h) : 0;
  return {bodies.position[body] + m.linear() + w.linear() + time * v.linear() + bend * gravity_,
          turnedBy(bodies.turn[body], m.turn + w.turn + time * v.turn)};
}

bool Impacts::meet(const Bodies& bodies, const std::vector<Motion>& way, Contact& contact, double h,
                   double& now) const {
  constexpr int kRounds = 4;
  const BodyShape &sa = *bodies.def[contact.a].shape, &sb = *bodies.def[contact.b].shape;
  const ConvexPiece &pa = sa.pieces[contact.pieceA], &pb = sb.pieces[contact.pieceB];
  const double margin = 0.1 * std::min(sa.thinnest, sb.thinnest), close = 1e-9 * margin;
  const double earliest = std::max(struckAt_[contact.a], struckAt_[contact.b]);
  Manifold manifold;
  Contact met = contact;
  for (int round = 0; round < kRounds; ++round) {
    const Frame fa = frameAt(bodies, way, contact.a, h, now);
    Frame fb = frameAt(bodies, way, contact.b, h, now);
    fb.position = fb.position + bodies.shiftOf(contact);
    if (!collide(pa, fa, pb, fb, margin, manifold)) return false;
    met.normal = manifold.normal;
    met.count = static_cast<std::int8_t>(manifold.count);
    const double late = dot(acceleration(bodies, met), met.normal) * (now - 0.5 * h);
    double gap = margin, speed = 0;
    for (int k = 0; k < met.count; ++k) {
      ContactPoint& p = met.points[k];
      p.armA = manifold.points[k].point - fa.position;
      p.armB = manifold.points[k].point - fb.position;
      p.gap = manifold.points[k].gap;
      met.feature[k] = manifold.points[k].feature;
      const double v = partingSpeed(bodies, met, p) + late;
      if (v < 0 && p.gap < gap) {
        gap = p.gap;
        speed = v;
      }
    }
    if (speed == 0) return false;
    const double then = std::clamp(now - gap / speed, earliest, h);
    const bool settled = std::abs(gap) <= close || then == now;
    if (settled || round == kRounds - 1) break;
    now = then;
  }
  contact = met;
  contact.met = true;
  return true;
}

bool Impacts::strike(Bodies& bodies, Contact& contact, double h, double least, double& now,
                     std::vector<Motion>& way) {
  if (isTied(contact)) joints_.beginImpact(bodies, contact.a, contact.b);
  if (!meet(bodies, way, contact, h, now)) {
    // They pass each other by: nothing holds them in this sub-step.
    for (int k = 0; k < contact.count; ++k) {
      ContactPoint& p = contact.points[k];
      const double closing = std::max(-partingSpeed(bodies, contact, p), 0.0);
      p.gap = 2 * h * closing - gapMoved(bodies, contact, p);
    }
    return false;
  }
  const Vec2 n = contact.normal, tangent = perpendicular(n);
  const double late = dot(acceleration(bodies, contact), n) * (now - 0.5 * h);

  const Vec2 xa = frameAt(bodies, way, contact.a, h, now).position,
             xb = frameAt(bodies, way, contact.b, h, now).position + bodies.shiftOf(contact);

  // The points that strike now, with arms from where the centres of mass are at this moment.
  ContactPoint struck[2];
  int count = 0;
  for (int p = 0; p < contact.count; ++p) {
    ContactPoint& point = contact.points[p];
    const double speed = partingSpeed(bodies, contact, point) + late;
    if (speed >= -least || point.gap + kTogether * h * speed > 0) continue;
    struck[count++] = point;
  }
  // For the contact solver, whose impulses act where the bodies' straight ways of after the impacts begin:
  // gaps and arms that come to the same places at the sub-step's end. Now the ways are bent against the
  // straight ones.
  const double bend = 0.5 * dot(acceleration(bodies, contact), n) * now * (now - h);
  auto settle = [&] {
    const Vec2 atA = bodies.positionNow(contact.a) + way[contact.a].linear(),
               atB = bodies.positionNow(contact.b) + way[contact.b].linear() + bodies.shiftOf(contact);
    for (int p = 0; p < contact.count; ++p) {
      ContactPoint& point = contact.points[p];
      const double speed = partingSpeed(bodies, contact, point);
      point.armA = point.armA + (xa - atA);
      point.armB = point.armB + (xb - atB);
      point.gap -= bend + now * speed + gapMoved(bodies, contact, point) + gapOf(way, contact, point);
    }
    contact.met = true;
  };
  if (count == 0) {
    settle();
    return false;
  }

  if (isTied(contact)) joints_.listTogether(bodies, contact.a, contact.b, together_);
  auto responseOf = [&](const ContactPoint& p, Vec2 d, const ContactPoint& q, Vec2 e) {
    return response(bodies, contact, p, d, q, e);
  };
  auto approaching = [&](const ContactPoint& p) { return partingSpeed(bodies, contact, p) + late; };
  auto pushNormal = [&](const ContactPoint& p, double impulse) {
    push(bodies, contact, p.armA, p.armB, impulse * n, now, way);
    contact.total += impulse;
  };
  double normal[2] = {0, 0};
  const double keep = 1 + contact.bounce;
  for (int k = 0; k < count; ++k) contact.approach = std::max(contact.approach, -approaching(struck[k]));
  const double k00 = responseOf(struck[0], n, struck[0], n);
  const double k01 = count == 2 ? responseOf(struck[0], n, struck[1], n) : 0;
  const double k11 = count == 2 ? responseOf(struck[1], n, struck[1], n) : 0;
  if (!(k00 > 0) || (count == 2 && !(k11 > 0))) {  // joints hold them: there is nothing to strike
    settle();
    return false;
  }
  const double det = k00 * k11 - k01 * k01;
  if (count == 2 && det > 1e-9 * k00 * k11) {  // both at once
    const double k[4] = {k00, k01, k11, 1 / det};
    const double speed[2] = {keep * approaching(struck[0]), keep * approaching(struck[1])};
    solveBoth(k, speed, normal);
  } else {  // one, or two at one place
    normal[0] = -keep * approaching(struck[0]) / k00;
  }
  const std::array<double, 2> came{approaching(struck[0]), count == 2 ? approaching(struck[1]) : 0};
  if (isTied(contact)) remember(bodies, way);
  for (int k = 0; k < count; ++k)
    if (normal[k] > 0) pushNormal(struck[k], normal[k]);
  if (isTied(contact)) {
    // Joints that all but hold them leave a response of which nothing is certain.
    bool asReckoned = true;
    for (int k = 0; k < count; ++k)
      asReckoned &= !(normal[k] > 0) || std::fabs(approaching(struck[k]) + contact.bounce * came[k]) <=
                                            kAsReckoned * std::fabs(came[k]);
    if (!asReckoned) {
      restore(bodies, way);
      contact.total -= std::max(normal[0], 0.0) + std::max(normal[1], 0.0);
      settle();
      return false;
    }
  }
  // After the normal impulses: friction at most stops the sliding, so it can only take energy.
  for (int k = 0; k < count; ++k) {
    const Vec2 slip =
        bodies.velocityAt(contact.b, struck[k].armB) - bodies.velocityAt(contact.a, struck[k].armA);
    const double most = contact.friction * normal[k],
                 own = responseOf(struck[k], tangent, struck[k], tangent);
    if (!(own > 0)) continue;
    const double stop = -dot(tangent, slip) / own;
    push(bodies, contact, struck[k].armA, struck[k].armB, std::clamp(stop, -most, most) * tangent, now, way);
  }
  contact.struck = true;
  settle();
  return true;
}

double Impacts::leastOf(const Contact& contact, double least) const {
  const bool flying = flying_[contact.a] && flying_[contact.b];
  if (flying) least *= kOfFlying;
  const int times = std::max(times_[contact.a], times_[contact.b]);
  const long bodies = static_cast<long>(times_.size()), over = inStep_ - kFreeOfStep - kFreeOfBody * bodies;
  const long doublings = std::max(0, times - (flying ? kFreeTimesFlying : kFreeTimes)) +
                         std::max(0L, over) / (kDoubling + bodies / 4);
  return doublings == 0 ? least : least * static_cast<double>(1L << std::min(doublings, 40L));
}

void Impacts::begin(const std::vector<char>& flying) {
  if (!joints_.empty()) joints_.beginImpacts();
  struckAt_.assign(flying.size(), 0);
  times_.assign(flying.size(), 0);
  flying_ = flying;
}

void Impacts::run(Bodies& bodies, const std::vector<Contact*>& contacts, double h, Vec2 gravity, double least,
                  std::vector<Motion>& way, bool again) {
  gravity_ = gravity;
  count_ = 0;
  const int n = static_cast<int>(contacts.size());
  heap_.clear();
  stamps_.assign(n, 0);
  for (int k = 0; k < n; ++k)
    if (!again || wasStruck(contacts[k]->a) || wasStruck(contacts[k]->b))
      schedule(bodies, way, contacts, k, h, least);
  if (heap_.empty()) return;

  firstAt_.assign(bodies.count(), -1);
  nextA_.resize(n);
  nextB_.resize(n);
  for (int k = n - 1; k >= 0; --k) {
    nextA_[k] = firstAt_[contacts[k]->a];
    firstAt_[contacts[k]->a] = 2 * k;
    nextB_[k] = firstAt_[contacts[k]->b];
    firstAt_[contacts[k]->b] = 2 * k + 1;
  }
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end());
    const Event event = heap_.back();
    heap_.pop_back();
    if (stamps_[event.contact] != event.stamp) continue;
    Contact& contact = *contacts[event.contact];
    double now = event.time;
    ++stamps_[event.contact];
    // A body that is struck over and over is squeezed: the contact solver ends that.
    if (times_[contact.a] >= kMostTimes || times_[contact.b] >= kMostTimes) continue;
    if (!strike(bodies, contact, h, leastOf(contact, least), now, way)) continue;
    for (const int body : {contact.a, contact.b})
      if (bodies.moves(body)) {
        struckAt_[body] = std::max(struckAt_[body], now);
        ++times_[body];
      }
    ++count_;
    ++inStep_;
    const auto scheduleAt = [&](int body) {
      for (int at = firstAt_[body]; at >= 0; at = at % 2 == 0 ? nextA_[at / 2] : nextB_[at / 2])
        schedule(bodies, way, contacts, at / 2, h, least);
    };
    if (isTied(contact)) {  // all that hang together have been struck
      for (const int body : together_) {
        struckAt_[body] = std::max(struckAt_[body], now);
        times_[body] = std::max(times_[body], 1);
      }
      for (const int body : together_) scheduleAt(body);
      continue;
    }
    for (const int body : {contact.a, contact.b})
      if (bodies.moves(body)) scheduleAt(body);
  }
}

}  // namespace smokebox
