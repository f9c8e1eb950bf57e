#include "rigid/passing.h"

#include <algorithm>
#include <cmath>

#include "rigid/collide.h"
#include "rigid/distance.h"

namespace smokebox {

namespace {

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
    const auto hit = timeOfImpact(a, sa, b, sb, kSweptTarget * thin);
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

Frame frameAfter(const Bodies& bodies, int body, const Motion& moved) {
  const Frame now = bodies.frameNow(body);
  return {now.position + moved.linear(), turnedBy(now.turn, moved.turn)};
}

}  // namespace

Motion Passing::displaced(const Bodies& bodies, const std::vector<Motion>& way, int body,
                          double share) const {
  const Stop& stop = stops_[body];
  const Motion& w = way[body];
  const double own = std::min(share, stop.share);
  Motion to{own * w.x, own * w.y, own * w.turn};
  if (share <= stop.share || stop.carrier < 0) return to;
  const Motion& c = way[stop.carrier];
  const double rest = share - stop.share;
  const Vec2 centre = bodies.positionNow(stop.carrier) + stop.shift + stop.share * c.linear();
  const Vec2 from = bodies.positionNow(body) + to.linear() - centre;
  const Vec2 by = rest * c.linear() + rotate(turnBy(rest * c.turn), from) - from;
  return {to.x + by.x, to.y + by.y, to.turn + rest * c.turn};
}

bool Passing::waits(const Bodies& bodies, const std::vector<Motion>& way, int body, int other, double share,
                    Vec2 shift) {
  Stop& stop = stops_[body];
  if (!bodies.moves(body) || share >= stop.share) return false;
  stop = {share, -1, {}};
  const Motion& w = way[other];
  if (bodies.moves(other)) {
    if (stops_[other].share <= share && stops_[other].carrier >= 0)
      stop = {share, stops_[other].carrier, stops_[other].shift + shift};
  } else if (w.x != 0 || w.y != 0 || w.turn != 0) {
    stop = {share, other, shift};
  }
  return true;
}

bool Passing::stopPair(const Bodies& bodies, const std::vector<Motion>& way, const PairKey& key, Vec2 shift,
                       double past) {
  const int a = key.a, b = key.b;
  const BodyShape &sa = *bodies.def[a].shape, &sb = *bodies.def[b].shape;
  const double thin = std::min(bodies.extent[a].thinnest, bodies.extent[b].thinnest);
  if (stops_[a].share >= 1 && stops_[b].share >= 1) {
    const Motion &wa = way[a], &wb = way[b];
    const double most = length(wa.linear() - wb.linear()) +
                        std::abs(wa.turn) * bodies.extent[a].turningReach() +
                        std::abs(wb.turn) * bodies.extent[b].turningReach();
    if (most <= kSwept * thin) return false;
  }
  // Until the first of the two waits, until the other one does, and then.
  double ends[3] = {stops_[a].share, stops_[b].share, 1};
  if (ends[0] > ends[1]) std::swap(ends[0], ends[1]);
  double from = past;
  for (const double end : ends) {
    if (end <= from) continue;
    const Motion a0 = displaced(bodies, way, a, from), a1 = displaced(bodies, way, a, end);
    const Motion b0 = displaced(bodies, way, b, from), b1 = displaced(bodies, way, b, end);
    const Vec2 wa = a1.linear() - a0.linear(), wb = b1.linear() - b0.linear();
    const double ta = a1.turn - a0.turn, tb = b1.turn - b0.turn;
    const double most = length(wa - wb) + std::abs(ta) * bodies.extent[a].turningReach() +
                        std::abs(tb) * bodies.extent[b].turningReach();
    if (most > kSwept * thin) {
      const Frame fa = frameAfter(bodies, a, a0);
      Frame fb = frameAfter(bodies, b, b0);
      fb.position = fb.position + shift;
      findPiecePairs(sa, fa, sb, fb, most, pieces_);
      double first = 1;
      for (const PiecePair& pieces : pieces_)
        first = std::min(first, safeShare(sa.pieces[pieces.a], {fa, wa, ta}, sb.pieces[pieces.b],
                                          {fb, wb, tb}, thin, most));
      if (first < 1) {
        const double share = from + (end - from) * first;
        const bool one = waits(bodies, way, a, b, share, shift);
        return waits(bodies, way, b, a, share, -shift) || one;
      }
    }
    from = end;
  }
  return false;
}

void Passing::stop(const Bodies& bodies, const BroadPhase& broad, const std::vector<PairKey>& pairs, double h,
                   const std::vector<double>* since, std::vector<Motion>& way) {
  constexpr int kRounds = 6;
  stops_.assign(bodies.count(), {});
  bool any = false;
  for (int round = 0; round < kRounds; ++round) {
    bool more = false;
    for (const PairKey& key : pairs) {
      // In later rounds only what has waited is new.
      if (round > 0 && stops_[key.a].share >= 1 && stops_[key.b].share >= 1) continue;
      // Before the last impact the ways were other ones.
      const double past = since ? std::max((*since)[key.a], (*since)[key.b]) / h : 0;
      more |= stopPair(bodies, way, key, broad.shiftOf(key), past);
    }
    any |= more;
    if (!more) break;
  }
  if (!any) return;
  for (int b = 0; b < bodies.count(); ++b)
    if (stops_[b].share < 1) way[b] = displaced(bodies, way, b, 1);
}

}  // namespace smokebox
