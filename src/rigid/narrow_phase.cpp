#include "rigid/narrow_phase.h"

#include <algorithm>
#include <cmath>

#include "rigid/collide.h"
#include "rigid/contact_sweeps.h"
#include "rigid/distance.h"

namespace smokebox {

namespace {

// A pair is calm while its bodies move against each other by less than this share of the thinner one's width
// in a step (less if they bounce): the contact's normal and corners then still hold at its end.
constexpr double kCalm = 0.25, kCalmTurning = 0.05, kCalmBouncing = 0.01;
constexpr double kCalmTurn = 0.1;  // rad
// A body may stray by this share of its width from the way expected of it.
constexpr double kStray = 0.02;
// Contacts are found anew once the bodies have moved by this share of the thinner one's width.
constexpr double kReuse = 2e-3;
// Lively ones, after this share: less where they bounce.
constexpr double kReuseLively = 4e-2, kReuseBouncing = 1e-2;
// A lively pair that is this many sub-steps apart is left alone for as long.
constexpr double kAhead = 4;
// Beyond this share of the thinner one's width in a sub-step, a pair is swept.
constexpr double kSwept = 0.25;
// What overlaps by more than this share of the thinner one's width, and goes on closing in faster than that
// (m/s) against all impulses, is crushed.
constexpr double kCrushed = 0.03, kCrushSpeed = 0.2;
// Lively pairs are looked at while they are this share of the thinner one's width apart, beyond their way and
// what they may move until they are looked at again.
constexpr double kNear = 0.01;
// Swept pairs are stopped at this share of the thinner one's width from each other.
constexpr double kTarget = 1e-3;

/// How far from the centre of mass a turn moves anything: nothing of a disk that turns about its centre.
double turningReach(const BodyShape& shape) {
  const ConvexPiece& first = shape.pieces[0];
  return shape.pieces.size() == 1 && first.points.size() == 1 && first.points[0] == Vec2{0, 0} ? 0
                                                                                               : shape.reach;
}

bool touching(const ConvexPiece& a, const Frame& fa, const ConvexPiece& b, const Frame& fb, double margin) {
  Manifold manifold;
  return collide(a, fa, b, fb, margin, manifold);
}

/// The share of their motion that two pieces can make before they overlap by more than a quarter of `thin`:
/// conservative advancement (Mirtich 1996) on the signed gap, for no point moves by more than `most`. Ends
/// after a bounded number of rounds, at a share that is safe.
double safeShare(const ConvexPiece& a, const Sweep& sa, const ConvexPiece& b, const Sweep& sb, double thin,
                 double most) {
  constexpr int kRounds = 64;
  const double deep = 0.25 * thin;
  double share = 0;
  if (!touching(a, sa.start, b, sb.start, deep)) {
    const auto hit = timeOfImpact(a, sa, b, sb, kTarget * thin);
    if (!hit) return 1;
    share = *hit;
  }
  auto gapAt = [&](double at) {
    Manifold manifold;
    const Frame fa = frameAt(sa, at), fb = frameAt(sb, at);
    if (!collide(a, fa, b, fb, deep, manifold)) return std::max(closestPoints(a, fa, b, fb).distance, deep);
    const double gap = manifold.points[0].gap;
    return manifold.count == 2 ? std::min(gap, manifold.points[1].gap) : gap;
  };
  if (share == 0) {  // what overlaps already may at least part
    const double before = gapAt(0), soon = std::min(deep / most, 1.0);
    if (before < -0.8 * deep) {
      if (gapAt(soon) < before) return 0;
      share = soon;
    }
  }
  for (int round = 0; round < kRounds; ++round) {
    const double gap = gapAt(share);
    if (gap < -0.8 * deep) return share;
    share += (gap + deep) / most;
    if (share >= 1) return 1;
  }
  return share;
}

bool isMoving(const Bodies& bodies, int body) {
  const Motion& v = bodies.velocity[body];
  return v.x != 0 || v.y != 0 || v.turn != 0;
}

/// Distance of the point from the box around a body's pieces.
double distanceFrom(const BodyShape& shape, const Frame& frame, Vec2 point) {
  const PieceTree::Node& box = shape.tree.nodes()[0];
  const Vec2 p = toLocal(frame, point) - box.centre;
  const Vec2 out{std::max(std::abs(p.x) - box.half.x, 0.0), std::max(std::abs(p.y) - box.half.y, 0.0)};
  return length(out);
}

/// Are they surely farther apart than `margin`? A body that does not turn tells more.
bool surelyApartByBoxes(const Bodies& bodies, const PairKey& key, Vec2 shift, double margin) {
  const BodyShape &a = *bodies.def[key.a].shape, &b = *bodies.def[key.b].shape;
  if (a.tree.nodes().empty() || b.tree.nodes().empty()) return true;
  const Vec2 pa = bodies.positionNow(key.a), pb = bodies.positionNow(key.b) + shift;
  if (bodies.moved[key.a].turn == 0 && distanceFrom(a, {pa, bodies.turn[key.a]}, pb) > b.reach + margin)
    return true;
  return bodies.moved[key.b].turn == 0 && distanceFrom(b, {pb, bodies.turn[key.b]}, pa) > a.reach + margin;
}

}  // namespace

double NarrowPhase::relativeSpeed(const Bodies& bodies, int a, int b) const {
  const Motion &va = bodies.velocity[a], &vb = bodies.velocity[b];
  return length(va.linear() - vb.linear()) + std::abs(va.turn) * measures_[a].turningReach +
         std::abs(vb.turn) * measures_[b].turningReach;
}

bool NarrowPhase::surelyApart(const Bodies& bodies, const PairKey& key, Vec2 shift, double margin) const {
  const Vec2 between = bodies.positionNow(key.b) + shift - bodies.positionNow(key.a);
  const double reach = measures_[key.a].reach + measures_[key.b].reach + margin;
  return dot(between, between) > reach * reach || surelyApartByBoxes(bodies, key, shift, margin);
}

double NarrowPhase::thinner(int a, int b) const {
  return std::min(measures_[a].thinnest, measures_[b].thinnest);
}

void NarrowPhase::find(const Bodies& bodies, const PairKey& key, Vec2 shift, double margin, double h,
                       bool swept, const Contact* old, int oldCount, std::vector<Contact>& found,
                       const Later& later) {
  const BodyDef &a = bodies.def[key.a], &b = bodies.def[key.b];
  auto ahead = [&](int body, const Motion& struck) -> Motion {
    const Motion& v = bodies.velocity[body];
    return {struck.x + later.time * v.x, struck.y + later.time * v.y, struck.turn + later.time * v.turn};
  };
  const Motion aheadA = ahead(key.a, later.struckA), aheadB = ahead(key.b, later.struckB);
  Frame fa = bodies.frameNow(key.a), fb = bodies.frameNow(key.b);
  if (later.time > 0) {
    fa = {fa.position + aheadA.linear(), turnedBy(fa.turn, aheadA.turn)};
    fb = {fb.position + aheadB.linear(), turnedBy(fb.turn, aheadB.turn)};
  }
  fb.position = fb.position + shift;
  const double rest = h - later.time;
  findPiecePairs(*a.shape, fa, *b.shape, fb, margin, pieces_);
  Manifold manifold;
  for (const PiecePair& pieces : pieces_) {
    const ConvexPiece &pa = a.shape->pieces[pieces.a], &pb = b.shape->pieces[pieces.b];
    const Vec2 apart = toWorld(fb, pb.centre) - toWorld(fa, pa.centre);
    const double near = pa.reach + pb.reach + margin;
    if (dot(apart, apart) > near * near) continue;
    double share = 0;
    Frame ta = fa, tb = fb;
    if (swept) {
      const double target = kTarget * thinner(key.a, key.b);
      if (!collide(pa, fa, pb, fb, 2 * target, manifold)) {
        const Motion &va = bodies.velocity[key.a], &vb = bodies.velocity[key.b];
        const Sweep sa{fa, rest * va.linear(), rest * va.turn}, sb{fb, rest * vb.linear(), rest * vb.turn};
        const auto hit = timeOfImpact(pa, sa, pb, sb, target);
        if (!hit) continue;
        share = *hit;
        ta = frameAt(sa, share);
        tb = frameAt(sb, share);
        if (!collide(pa, ta, pb, tb, 4 * target, manifold)) continue;
      }
    } else if (!collide(pa, fa, pb, fb, margin, manifold)) {
      continue;
    }
    Contact contact;
    contact.a = key.a;
    contact.b = key.b;
    contact.pieceA = pieces.a;
    contact.pieceB = pieces.b;
    contact.normal = manifold.normal;
    contact.shift = shift;
    contact.count = manifold.count;
    contact.friction = std::sqrt(a.friction * b.friction);
    contact.bounce = std::max(a.bounce, b.bounce);
    for (int k = 0; k < manifold.count; ++k) {
      ContactPoint& p = contact.points[k];
      p.armA = manifold.points[k].point - ta.position;
      p.armB = manifold.points[k].point - tb.position;
      p.feature = manifold.points[k].feature;
      const double speed = partingSpeed(bodies, contact, p);
      contact.approach = std::max(contact.approach, -speed);
      // As of the step's start, by the same straight-line rule that brings it up to date.
      p.gap = manifold.points[k].gap - share * rest * speed - gapMoved(bodies, contact, p) -
              dot(contact.normal, aheadB.linear() - aheadA.linear()) -
              aheadB.turn * cross(p.armB, contact.normal) + aheadA.turn * cross(p.armA, contact.normal);
      p.armA = p.armA + later.time * bodies.velocity[key.a].linear();
      p.armB = p.armB + later.time * bodies.velocity[key.b].linear();
    }
    setMasses(bodies, contact);
    for (int o = 0; o < oldCount; ++o) {
      const Contact& before = old[o];
      if (before.pieceA != contact.pieceA || before.pieceB != contact.pieceB) continue;
      contact.approach = std::max(contact.approach, before.approach);
      for (int k = 0; k < contact.count; ++k)
        for (int l = 0; l < before.count; ++l)
          if (before.points[l].feature == contact.points[k].feature) {
            contact.points[k].impulseN = before.points[l].impulseN;
            contact.points[k].impulseT = before.points[l].impulseT;
          }
    }
    found.push_back(contact);
  }
}

void NarrowPhase::beginStep(const Bodies& bodies, BroadPhase& broad, Vec2 gravity, double dt, int subSteps) {
  const int count = bodies.count();
  h_ = dt / subSteps;
  elapsed_ = 0;
  expected_.resize(count);
  measures_.resize(count);
  travelled_.resize(count, 0);
  stirred_.assign(count, 0);
  for (int b = 0; b < count; ++b) {
    if (!bodies.there[b]) continue;
    const BodyShape& shape = *bodies.def[b].shape;
    measures_[b] = {turningReach(shape), shape.thinnest, shape.reach};
    const double fall = length(gravity) * std::abs(bodies.def[b].gravityScale) * dt * dt;
    expected_[b] = {bodies.velocity[b], bodies.moves(b) ? fall + kStray * shape.thinnest : 0};
  }
  auto& pairs = broad.pairs();
  livelyPair_.assign(pairs.size(), 0);
  calmFirst_.assign(pairs.size() + 1, 0);
  pairsListed_ = false;
  calm_.clear();
  lively_.clear();
  pairs_.clear();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    BodyPair& pair = pairs[k];
    const int a = pair.key.a, b = pair.key.b;
    calmFirst_[k] = static_cast<int>(calm_.size());
    const double thin = thinner(a, b);
    const double way = relativeSpeed(bodies, a, b) * dt;
    const bool bounces = bodies.def[a].bounce > 0 || bodies.def[b].bounce > 0;
    const double turn = std::max(std::abs(bodies.velocity[a].turn), std::abs(bodies.velocity[b].turn)) * dt;
    const bool pushed =
        (!bodies.moves(a) && isMoving(bodies, a)) || (!bodies.moves(b) && isMoving(bodies, b));
    if ((pushed && way > kReuse * thin) || way > (bounces ? kCalmBouncing : kCalm) * thin ||
        (way > kCalmTurning * thin && turn > kCalmTurn)) {
      livelyPair_[k] = 1;
      makeLively(pair.key, static_cast<int>(k), memory_.data() + pair.first, pair.count);
      continue;
    }
    const double margin = way + expected_[a].room + expected_[b].room;
    const double since = travelled_[a] + travelled_[b] - pair.travelled;
    if (since <= kReuse * thin && margin + since <= pair.margin) {
      calm_.insert(calm_.end(), memory_.begin() + pair.first, memory_.begin() + pair.first + pair.count);
      for (auto c = calm_.end() - pair.count; c != calm_.end(); ++c) {
        setMasses(bodies, *c);
        c->friction = std::sqrt(bodies.def[a].friction * bodies.def[b].friction);
        c->bounce = std::max(bodies.def[a].bounce, bodies.def[b].bounce);
        c->approach = 0;
      }
      continue;
    }
    pair.margin = margin + 2 * kReuse * thin;
    pair.travelled = travelled_[a] + travelled_[b];
    if (surelyApart(bodies, pair.key, broad.shiftOf(pair.key), pair.margin)) continue;
    find(bodies, pair.key, broad.shiftOf(pair.key), pair.margin, h_, false, memory_.data() + pair.first,
         pair.count, calm_, {});
  }
  calmFirst_[pairs.size()] = static_cast<int>(calm_.size());
  for (Contact& contact : calm_) contact.total = 0;
  for (Contact& contact : lively_) contact.total = contact.approach = 0;
  dropped_.assign(calm_.size(), 0);
}

void NarrowPhase::makeLively(const PairKey& key, int pair, const Contact* old, int count) {
  LivelyPair made{key, static_cast<int>(lively_.size()), count, false, 0, pair};
  lively_.insert(lively_.end(), old, old + count);
  pairs_.push_back(made);
}

void NarrowPhase::listPairs(const Bodies& bodies, const std::vector<BodyPair>& pairs) {
  pairsFirst_.assign(bodies.count() + 2, 0);
  for (const BodyPair& pair : pairs) {
    ++pairsFirst_[pair.key.a + 2];
    ++pairsFirst_[pair.key.b + 2];
  }
  for (int b = 2; b < bodies.count() + 2; ++b) pairsFirst_[b] += pairsFirst_[b - 1];
  pairsAt_.resize(2 * pairs.size());
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    pairsAt_[pairsFirst_[pairs[k].key.a + 1]++] = static_cast<int>(k);
    pairsAt_[pairsFirst_[pairs[k].key.b + 1]++] = static_cast<int>(k);
  }
  pairsListed_ = true;
}

void NarrowPhase::refresh(const Bodies& bodies, const BroadPhase& broad, double h,
                          const std::vector<double>* since) {
  next_.clear();
  for (LivelyPair& pair : pairs_) {
    const int a = pair.key.a, b = pair.key.b;
    const double thin = thinner(a, b);
    const double way = relativeSpeed(bodies, a, b) * h;
    pair.swept = way > kSwept * thin;
    const int first = static_cast<int>(next_.size());
    pair.clear -= way;
    if (pair.clear < 0) {
      const bool bounces = bodies.def[a].bounce > 0 || bodies.def[b].bounce > 0;
      const double reuse = (bounces ? kReuseBouncing : kReuseLively) * thin;
      const double near = way + kNear * thin + reuse, margin = pair.swept ? way : kAhead * near;
      if (surelyApart(bodies, pair.key, broad.shiftOf(pair.key), margin)) {
        pair.clear = margin - near;
      } else {
        find(bodies, pair.key, broad.shiftOf(pair.key), pair.swept ? way : near, h, pair.swept,
             lively_.data() + pair.first, pair.count, next_,
             {since ? std::max((*since)[a], (*since)[b]) : 0, {}, {}});
        if (static_cast<int>(next_.size()) > first && !pair.swept) pair.clear = reuse;
      }
    } else {
      next_.insert(next_.end(), lively_.begin() + pair.first, lively_.begin() + pair.first + pair.count);
      for (std::size_t k = first; k < next_.size(); ++k) {
        next_[k].total = next_[k].approach = 0;
        next_[k].struck = false;
      }
    }
    pair.first = first;
    pair.count = static_cast<int>(next_.size()) - first;
  }
  lively_.swap(next_);
}

void NarrowPhase::refreshAfterImpacts(const Bodies& bodies, const BroadPhase& broad, double h,
                                      const std::vector<Motion>& struck,
                                      const std::vector<double>& struckAt) {
  next_.clear();
  auto wasStruck = [&](int body) {
    const Motion& m = struck[body];
    return m.x != 0 || m.y != 0 || m.turn != 0;
  };
  for (LivelyPair& pair : pairs_) {
    const int a = pair.key.a, b = pair.key.b;
    const auto begin = lively_.begin() + pair.first, end = begin + pair.count;
    const int first = static_cast<int>(next_.size());
    if ((!wasStruck(a) && !wasStruck(b)) ||
        std::any_of(begin, end, [](const Contact& c) { return c.struck; })) {
      next_.insert(next_.end(), begin, end);
    } else {
      const double thin = thinner(a, b), way = relativeSpeed(bodies, a, b) * h;
      pair.swept = way > kSwept * thin;
      pair.clear = 0;
      const double margin = pair.swept ? way : way + kNear * thin;
      const double reach = margin + length(struck[a].linear()) + length(struck[b].linear());
      if (!surelyApart(bodies, pair.key, broad.shiftOf(pair.key), reach + way))
        find(bodies, pair.key, broad.shiftOf(pair.key), margin, h, pair.swept, lively_.data() + pair.first,
             pair.count, next_, {std::max(struckAt[a], struckAt[b]), struck[a], struck[b]});
    }
    pair.first = first;
    pair.count = static_cast<int>(next_.size()) - first;
  }
  lively_.swap(next_);
}

bool NarrowPhase::stir(const Bodies& bodies, const std::vector<Motion>& way, BroadPhase& broad, Vec2 gravity,
                       ContactBlocks& blocks, double timeLeft) {
  leaving_.clear();
  turned_.clear();
  const double t = elapsed_ + h_;
  for (int b = 0; b < bodies.count(); ++b) {
    if (!bodies.moves(b) || !bodies.there[b]) continue;
    Expected& e = expected_[b];
    if (stirred_[b]) {  // its pairs are lively, but does its box still hold its way?
      const Motion& v = bodies.velocity[b];
      const Vec2 changed = v.linear() - e.velocity.linear();
      const double slack = 0.5 * e.room / timeLeft;
      if (dot(changed, changed) <= slack * slack) continue;
      e.velocity = v;
      turned_.push_back(b);
      continue;
    }
    const Motion &m = bodies.moved[b], &w = way[b];
    const Vec2 off = m.linear() + w.linear() - t * e.velocity.linear();
    const double turned = m.turn + w.turn - t * e.velocity.turn;
    const double left = e.room - std::abs(turned) * measures_[b].turningReach;
    if (left >= 0 && dot(off, off) <= left * left) continue;
    stirred_[b] = 1;
    e.velocity = bodies.velocity[b];
    leaving_.push_back(b);
  }
  if (leaving_.empty() && turned_.empty()) return false;
  bool any = false;
  const auto& pairs = broad.pairs();
  if (!pairsListed_) listPairs(bodies, pairs);
  for (const int body : leaving_)
    for (int at = pairsFirst_[body]; at < pairsFirst_[body + 1]; ++at) {
      const int k = pairsAt_[at];
      if (livelyPair_[k]) continue;
      livelyPair_[k] = 1;
      any = true;
      const int first = calmFirst_[k], count = calmFirst_[k + 1] - first;
      for (int c = first; c < first + count; ++c) {
        blocks.drop(c, calm_[c]);
        dropped_[c] = 1;
      }
      makeLively(pairs[k].key, k, calm_.data() + first, count);
    }
  late_.clear();
  leaving_.insert(leaving_.end(), turned_.begin(), turned_.end());
  broad.extend(bodies, leaving_, way, gravity, timeLeft, late_);
  for (const PairKey& key : late_) {
    makeLively(key, -1, nullptr, 0);
    any = true;
  }
  return any;
}

void NarrowPhase::yieldCrushed(Bodies& bodies, const std::vector<Motion>& before) {
  crushed_.clear();
  auto isCrushed = [&](const Contact& c) {
    const double deep = kCrushed * thinner(c.a, c.b);
    for (int k = 0; k < c.count; ++k) {
      const ContactPoint& p = c.points[k];
      if (p.impulseN > 0 && p.gap + gapMoved(bodies, c, p) < -deep &&
          partingSpeed(bodies, c, p) < -kCrushSpeed)
        return true;
    }
    return false;
  };
  for (const Contact& c : lively_)
    if (isCrushed(c)) {
      if (bodies.moves(c.a)) crushed_.push_back(c.a);
      if (bodies.moves(c.b)) crushed_.push_back(c.b);
    }
  if (crushed_.empty()) return;
  std::sort(crushed_.begin(), crushed_.end());
  crushed_.erase(std::unique(crushed_.begin(), crushed_.end()), crushed_.end());
  auto speed = [&](int body) {
    const Motion& v = before[body];
    return length(v.linear()) + std::abs(v.turn) * measures_[body].turningReach;
  };
  // Nothing that gives way can make it faster than the fastest of those around it.
  crushSpeed_.resize(crushed_.size());
  for (std::size_t k = 0; k < crushed_.size(); ++k) crushSpeed_[k] = speed(crushed_[k]);
  auto place = [&](int body) {
    const auto at = std::lower_bound(crushed_.begin(), crushed_.end(), body);
    return at != crushed_.end() && *at == body ? static_cast<int>(at - crushed_.begin()) : -1;
  };
  for (Contact& c : lively_) {
    const int a = place(c.a), b = place(c.b);
    if (a >= 0) crushSpeed_[a] = std::max(crushSpeed_[a], speed(c.b));
    if (b >= 0) crushSpeed_[b] = std::max(crushSpeed_[b], speed(c.a));
  }
  bool any = false;
  for (std::size_t k = 0; k < crushed_.size(); ++k) {
    Motion& v = bodies.velocity[crushed_[k]];
    const double linear = length(v.linear()),
                 turning = std::abs(v.turn) * measures_[crushed_[k]].turningReach;
    const double most = crushSpeed_[k];
    crushSpeed_[k] = linear > most || turning > most ? -1 : 0;  // from here on: whether it was
    any |= crushSpeed_[k] < 0;
    if (linear > most) {
      v.x *= most / linear;
      v.y *= most / linear;
    }
    if (turning > most) v.turn *= most / turning;
  }
  if (!any) return;
  for (Contact& c : lively_) {
    const int a = place(c.a), b = place(c.b);
    if ((a >= 0 && crushSpeed_[a] < 0) || (b >= 0 && crushSpeed_[b] < 0))
      for (ContactPoint& p : c.points) p.impulseN = p.impulseT = 0;
  }
}

void NarrowPhase::stopPassing(const Bodies& bodies, const BroadPhase& broad, double h,
                              const std::vector<double>* since, std::vector<Motion>& way) {
  constexpr int kRounds = 4;  // what one pair stops, another may meet
  for (int round = 0; round < kRounds; ++round)
    if (!stopOnce(bodies, broad, h, since, way)) return;
}

bool NarrowPhase::stopOnce(const Bodies& bodies, const BroadPhase& broad, double h,
                           const std::vector<double>* since, std::vector<Motion>& way) {
  bool any = false;
  for (const LivelyPair& pair : pairs_) {
    const int a = pair.key.a, b = pair.key.b;
    const BodyShape &sa = *bodies.def[a].shape, &sb = *bodies.def[b].shape;
    const double thin = thinner(a, b);
    // What lies ahead after the last impact; before it the ways were other ones.
    const double past = since ? std::max((*since)[a], (*since)[b]) / h : 0;
    auto part = [&](int body, double share) -> Motion {
      const Motion& w = way[body];
      return {share * w.x, share * w.y, share * w.turn};
    };
    auto frame = [&](int body) -> Frame {
      const Frame now = bodies.frameNow(body);
      const Motion m = part(body, past);
      return {now.position + m.linear(), turnedBy(now.turn, m.turn)};
    };
    const Motion wa = part(a, 1 - past), wb = part(b, 1 - past);
    const double most = length(wa.linear() - wb.linear()) + std::abs(wa.turn) * measures_[a].turningReach +
                        std::abs(wb.turn) * measures_[b].turningReach;
    if (most <= kSwept * thin) continue;
    const Frame fa = frame(a);
    Frame fb = frame(b);
    fb.position = fb.position + broad.shiftOf(pair.key);
    findPiecePairs(sa, fa, sb, fb, most, pieces_);
    double first = 1;
    for (const PiecePair& pieces : pieces_)
      first = std::min(first, safeShare(sa.pieces[pieces.a], {fa, wa.linear(), wa.turn}, sb.pieces[pieces.b],
                                        {fb, wb.linear(), wb.turn}, thin, most));
    if (first >= 1) continue;
    const double share = past + (1 - past) * first;
    for (const int body : {a, b})
      if (bodies.moves(body)) way[body] = part(body, share);
    any = true;
  }
  return any;
}

void NarrowPhase::endStep(const Bodies& bodies, BroadPhase& broad) {
  for (int b = 0; b < bodies.count(); ++b) {
    const Motion& m = bodies.moved[b];
    travelled_[b] += length(m.linear()) + std::abs(m.turn) * measures_[b].turningReach;
  }
  for (std::size_t k = 0; k < calm_.size(); ++k)
    for (int p = 0; p < calm_[k].count; ++p)  // bring it up to date: it may be used again
      calm_[k].points[p].gap += gapMoved(bodies, calm_[k], calm_[k].points[p]);
  memory_.swap(calm_);
  auto& pairs = broad.pairs();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    pairs[k].first = calmFirst_[k];
    pairs[k].count = livelyPair_[k] ? 0 : calmFirst_[k + 1] - calmFirst_[k];
    if (livelyPair_[k]) pairs[k].margin = -1;
  }
  for (const LivelyPair& pair : pairs_) {
    if (pair.pair < 0) continue;
    pairs[pair.pair].first = static_cast<int>(memory_.size());
    pairs[pair.pair].count = pair.count;
    memory_.insert(memory_.end(), lively_.begin() + pair.first, lively_.begin() + pair.first + pair.count);
  }
}

std::size_t NarrowPhase::bytes() const {
  return (calm_.capacity() + lively_.capacity() + next_.capacity() + memory_.capacity()) * sizeof(Contact) +
         pairs_.capacity() * sizeof(LivelyPair);
}

}  // namespace smokebox
