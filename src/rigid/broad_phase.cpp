#include "rigid/broad_phase.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace smokebox {

namespace {
constexpr double kRoom = 0.1;  // of a fat box around what it has to hold, in reaches of the body
constexpr double kStepsAhead = 3;
// The tree is built anew when boxes have been fitted so many times each.
constexpr long kRebuild = 2;
// All pairs are searched for together if this share of the bodies, as a divisor, has new boxes.
constexpr long kFewTimes = 8;
// Boxes of so many times fewer bodies than there are, are fitted into the tree one by one.
constexpr long kFewer = 16;

bool mayMeet(const Bodies& bodies, int a, int b) {
  return (bodies.moves(a) || bodies.moves(b)) && !bodies.areJoined(a, b);
}

/// Box of a body whose frame is `frame`.
Box boxOf(const Extent& own, const Frame& frame) {
  const Vec2 middle = toWorld(frame, own.centre), half = own.half;
  if (own.radius > 0) return grown({middle, middle}, own.radius);
  const double c = std::abs(frame.turn.c), s = std::abs(frame.turn.s);
  const Vec2 reach{c * half.x + s * half.y, s * half.x + c * half.y};
  return {middle - reach, middle + reach};
}
}  // namespace

bool BroadPhase::fit(const Bodies& bodies, int body, Vec2 gravity, double dt, Vec2 later) {
  const Extent& shape = bodies.extent[body];
  const Motion& v = bodies.velocity[body];
  const double turns = std::abs(v.turn) * dt;
  Box box = boxOf(shape, bodies.frameNow(body));
  if (turns > 0) {
    // What a turn can add: the farthest point's way, or the whole circle about the centre of mass.
    const Vec2 p = bodies.positionNow(body);
    const Box circle = grown({p, p}, shape.reach);
    const Box swung = grown(box, turns * shape.reach);
    box = {{std::max(swung.low.x, std::min(circle.low.x, box.low.x)),
            std::max(swung.low.y, std::min(circle.low.y, box.low.y))},
           {std::min(swung.high.x, std::max(circle.high.x, box.high.x)),
            std::min(swung.high.y, std::max(circle.high.y, box.high.y))}};
  }
  const Vec2 way = dt * v.linear();
  box = joined(box, shifted(box, later));
  box = joined(box, shifted(box, way));
  if (bodies.moves(body))
    box = joined(box, shifted(box, dt * dt * bodies.surface[body].gravityScale * gravity));
  if (listed_[body] && fat_[body].holds(box)) return false;
  // Along its way some more: what flies on does not ask for a new box in every step.
  const double ahead = std::min(kStepsAhead, 0.5 * shape.reach / (length(way) + 1e-12));
  const double room = kRoom * (bodies.moves(body) ? shape.reach : 0);
  fat_[body] = grown(joined(box, shifted(box, ahead * way)), room);
  listed_[body] = 1;
  return true;
}

void BroadPhase::search(const Bodies& bodies, int body, bool imagesOnly, std::vector<PairKey>& found) const {
  const bool wrapX = walls_.sides[0] == RigidWalls::Kind::periodic,
             wrapY = walls_.sides[2] == RigidWalls::Kind::periodic;
  for (int sy = wrapY ? -1 : 0; sy <= (wrapY ? 1 : 0); ++sy)
    for (int sx = wrapX ? -1 : 0; sx <= (wrapX ? 1 : 0); ++sx) {
      if (imagesOnly && sx == 0 && sy == 0) continue;
      // The other one's image at +shift meets this body where the other one meets this body's image at
      // -shift.
      const Box box = shifted(fat_[body], {-sx * walls_.width, -sy * walls_.height});
      tree_.query(box, groups_[body], [&](int other) {
        if (other == body || (refitted_[other] && other < body)) return;  // that one finds this one
        if (!mayMeet(bodies, body, other)) return;
        if (body < other)
          found.push_back({body, other, static_cast<std::int8_t>(sx), static_cast<std::int8_t>(sy)});
        else
          found.push_back({other, body, static_cast<std::int8_t>(-sx), static_cast<std::int8_t>(-sy)});
      });
    }
}

void BroadPhase::searchAll(const Bodies& bodies, long moved, std::vector<PairKey>& found) {
  const bool together = kFewTimes * moved > bodies.count();
  if (together)
    tree_.eachPair(refitted_, [&](int a, int b) {
      if (mayMeet(bodies, a, b)) found.push_back({std::min(a, b), std::max(a, b)});
    });
  for (int b = 0; b < bodies.count(); ++b)
    if (refitted_[b] && listed_[b]) search(bodies, b, together, found);
}

void BroadPhase::refitTree(long moved) {
  if (kFewer * moved > static_cast<long>(fat_.size())) return tree_.refit(fat_);
  for (std::size_t b = 0; b < fat_.size(); ++b)
    if (refitted_[b]) tree_.refit(fat_, static_cast<int>(b));
}

void BroadPhase::update(const Bodies& bodies, Vec2 gravity, double dt) {
  const int count = bodies.count();
  fat_.resize(count);
  listed_.resize(count, 0);
  refitted_.assign(count, 0);
  bool listChanged = false;
  long moved = 0;
  constexpr char kNew = 2;
  constexpr int kGrain = 512;
  pool_.blocks(0, count, kGrain, [&](int b, int end) {
    for (; b < end; ++b) {
      const bool was = listed_[b];
      if (bodies.there[b] && fit(bodies, b, gravity, dt)) refitted_[b] = was ? 1 : kNew;
    }
  });
  for (int b = 0; b < count; ++b) {
    if (!bodies.there[b]) {
      listChanged |= listed_[b] != 0;
      refitted_[b] = listed_[b];
      listed_[b] = 0;
    } else if (refitted_[b]) {
      ++moved;
      listChanged |= refitted_[b] == kNew;
      refitted_[b] = 1;
    }
  }
  sinceBuild_ += moved;
  if (bodies.defsChanged) {
    groups_.resize(count);
    for (int b = 0; b < count; ++b)
      listChanged |= std::exchange(groups_[b], bodies.def[b].ignore) != bodies.def[b].ignore;
  }
  if (listChanged || sinceBuild_ > kRebuild * count) {
    items_.clear();
    for (int b = 0; b < count; ++b)
      if (listed_[b]) items_.push_back(b);
    tree_.build(fat_, items_, groups_);
    sinceBuild_ = 0;
  } else if (moved > 0) {
    refitTree(moved);
  } else if (late_.empty()) {
    refitted_.assign(count, 0);
    return;
  }

  found_.assign(late_.begin(), late_.end());
  late_.clear();
  searchAll(bodies, moved, found_);
  std::sort(found_.begin(), found_.end());
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());

  dropAndInsert(bodies);
  refitted_.assign(count, 0);
}

/// Takes out the pairs whose boxes have parted and puts in those of found_ that are new; all stay in order.
void BroadPhase::dropAndInsert(const Bodies& bodies) {
  const auto isOver = [&](const PairKey& key) {
    if (!refitted_[key.a] && !refitted_[key.b]) return false;
    return !listed_[key.a] || !listed_[key.b] || bodies.areJoined(key.a, key.b) ||
           !fat_[key.a].meets(shifted(fat_[key.b], shiftOf(key)));
  };
  next_.clear();
  auto at = found_.begin();
  for (const BodyPair& pair : pairs_) {
    for (; at != found_.end() && *at < pair.key; ++at) next_.push_back({*at});
    if (at != found_.end() && *at == pair.key) ++at;
    if (!isOver(pair.key)) next_.push_back(pair);
  }
  for (; at != found_.end(); ++at) next_.push_back({*at});
  pairs_.swap(next_);
}

void BroadPhase::extend(const Bodies& bodies, const std::vector<int>& which, const std::vector<Motion>& way,
                        Vec2 gravity, double dt, std::vector<PairKey>& found) {
  found_.clear();
  bool any = false;
  for (const int b : which) any |= (refitted_[b] = fit(bodies, b, gravity, dt, way[b].linear()));
  if (any) {
    for (const int b : which)
      if (refitted_[b]) tree_.refit(fat_, b);
    for (const int b : which)
      if (refitted_[b]) search(bodies, b, false, found_);
    sinceBuild_ += static_cast<long>(which.size());
    for (const int b : which) refitted_[b] = 0;
  }
  std::sort(found_.begin(), found_.end());
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  const auto known = static_cast<std::ptrdiff_t>(late_.size());
  for (const PairKey& key : found_) {
    const auto at = std::lower_bound(pairs_.begin(), pairs_.end(), key,
                                     [](const BodyPair& pair, const PairKey& k) { return pair.key < k; });
    if (at != pairs_.end() && at->key == key) continue;
    if (std::binary_search(late_.begin(), late_.begin() + known, key)) continue;
    found.push_back(key);
    late_.push_back(key);
  }
  std::inplace_merge(late_.begin(), late_.begin() + known, late_.end());
}

}  // namespace smokebox
