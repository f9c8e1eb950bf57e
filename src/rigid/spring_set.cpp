#include "rigid/spring_set.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/hash.h"
#include "rigid/islands.h"
#include "rigid/spring_row.h"

namespace smokebox {

int SpringSet::add(const SpringDef& def, const Bodies& bodies) {
  Spring spring;
  spring.def = def;
  for (Anchor* end : {&spring.def.from, &spring.def.to}) {
    const int other = end == &spring.def.to ? def.from.body : def.to.body;
    if (end->body >= 0 || other < 0) continue;
    spring.shift = bodies.wound[other];
    end->at = end->at + spring.shift;
  }
  springs_.push_back(spring);
  fresh_ = true;
  firstAt_.clear();
  ++there_;
  stale_ = true;
  return count() - 1;
}

void SpringSet::remove(int spring) {
  Spring& s = springs_[spring];
  if (!s.there) return;
  s.there = false;
  s.impulse = 0;
  --there_;
  ++removed_;
  stale_ = true;
}

void SpringSet::listByBody() {
  const auto eachEnd = [&](auto&& visit) {
    for (int k = 0; k < count(); ++k)
      for (const int body : {springs_[k].def.from.body, springs_[k].def.to.body})
        if (body >= 0) visit(body, k);
  };
  int bodies = 0;
  eachEnd([&](int body, int) { bodies = std::max(bodies, body + 1); });
  firstAt_.assign(bodies + 2, 0);
  eachEnd([&](int body, int) { ++firstAt_[body + 2]; });
  std::partial_sum(firstAt_.begin(), firstAt_.end(), firstAt_.begin());
  springsAt_.resize(firstAt_.back());
  eachEnd([&](int body, int spring) { springsAt_[firstAt_[body + 1]++] = spring; });
}

void SpringSet::removeAt(int body) {
  if (firstAt_.empty()) listByBody();
  if (body + 2 > static_cast<int>(firstAt_.size())) return;
  for (int at = firstAt_[body]; at < firstAt_[body + 1]; ++at) remove(springsAt_[at]);
}

bool SpringSet::ties(int body) {
  if (there_ == 0) return false;
  if (firstAt_.empty()) listByBody();
  if (body + 2 > static_cast<int>(firstAt_.size())) return false;
  return std::any_of(springsAt_.begin() + firstAt_[body], springsAt_.begin() + firstAt_[body + 1],
                     [&](int spring) { return springs_[spring].there; });
}

void SpringSet::moveEnd(int spring, Vec2 to) {
  Spring& s = springs_[spring];
  const Anchor& end = s.def.to.body < 0 ? s.def.to : s.def.from;
  s.carried = true;
  s.carriedFrom = end.at;
  s.carriedTo = to + s.shift;
  carrying_ = true;
}

void SpringSet::beginStep(Bodies& bodies, double dt, int subSteps) {
  clock_ = {dt, 0};
  for (int k = 0; k < static_cast<int>(moved_.size()); ++k)
    stale_ |= moved_[k] != 2 && moved_[k] != static_cast<char>(bodies.moves(k));
  if (stale_) layOut(bodies);
  for (SpringSheet& sheet : sheets_) sheet.beginStep(springs_, bodies, dt / subSteps, changed_);
  changed_ = false;
}

void SpringSet::layOut(const Bodies& bodies) {
  stale_ = tearing_ = false;
  islands_.clear();
  const std::vector<SpringSheet> before = std::move(sheets_);
  sheets_.clear();
  moved_.assign(bodies.count(), 2);
  std::vector<int> numbers, many;
  std::vector<std::array<int, 2>> ends;
  for (int k = 0; k < count(); ++k) {
    const SpringDef& def = springs_[k].def;
    if (!springs_[k].there) continue;
    tearing_ |= def.tear < std::numeric_limits<double>::infinity();
    for (const int body : {def.from.body, def.to.body})
      if (body >= 0) moved_[body] = static_cast<char>(bodies.moves(body));
    if (def.from.body == def.to.body) continue;
    numbers.push_back(k);
    ends.push_back({def.from.body, def.to.body});
  }
  auto solveAtOnce = [&](const std::vector<int>& group) {
    SpringIsland island;
    if (!island.layOut(group, springs_, bodies)) return false;
    islands_.push_back(std::move(island));
    return true;
  };
  for (std::vector<int>& group : islandsOf(ends, bodies)) {
    for (int& link : group) link = numbers[link];
    if (solveAtOnce(group)) continue;
    for (const int k : group)
      if (SpringSheet::takes(springs_[k], bodies))
        many.push_back(k);
      else
        solveAtOnce({k});
    if (many.empty()) continue;
    sheets_.emplace_back(*pool_);
    sheets_.back().layOut(many, springs_, before);
    many.clear();
  }
  sheetOf_.assign(springs_.size(), -1);
  for (std::size_t k = 0; k < sheets_.size(); ++k) sheets_[k].mark(sheetOf_, static_cast<int>(k));
}

void SpringSet::warmStart(Bodies& bodies, double h) {
  const double before = h_ > 0 ? h_ : h;
  h_ = h;
  for (SpringIsland& island : islands_) island.warmStart(springs_, bodies, clock_, h, before);
  for (SpringSheet& sheet : sheets_) sheet.warmStart(bodies, h, before);
  clock_.elapsed += h;
}

double SpringSet::solve(Bodies& bodies, double h) {
  double change = 0;
  for (SpringIsland& island : islands_) change = std::max(change, island.solve(springs_, bodies, h));
  for (SpringSheet& sheet : sheets_) change = std::max(change, sheet.solve(bodies));
  return change;
}

long SpringSet::sweepCost() const {
  constexpr long kAtOnce = 20;  // springs of a sheet that take as long as a point
  long springs = 0;
  for (const SpringSheet& sheet : sheets_) springs += sheet.count();
  return springs / kAtOnce;
}

void SpringSet::endStep(Bodies& bodies) {
  for (SpringSheet& sheet : sheets_) sheet.endStep(bodies);
  if (carrying_) {
    for (Spring& spring : springs_) {
      if (!spring.carried) continue;
      (spring.def.to.body < 0 ? spring.def.to : spring.def.from).at = spring.carriedTo;
      spring.carried = false;
    }
    carrying_ = false;
  }
  if (tearing_) {
    for (int k = 0; k < count(); ++k) {
      const Spring& spring = springs_[k];
      if (spring.there && distance(k, bodies) > (1 + spring.def.tear) * spring.def.length) remove(k);
    }
  }
}

void SpringSet::push(int spring, Bodies& bodies, double share, const std::vector<char>* fresh) const {
  const Spring& s = springs_[spring];
  if (!s.there || (spring < static_cast<int>(sheetOf_.size()) && sheetOf_[spring] >= 0)) return;
  const Anchor* ends[2] = {&s.def.from, &s.def.to};
  Vec2 arms[2];
  double inertia = 0;
  for (int e = 0; e < 2; ++e) {
    if (ends[e]->body < 0) continue;
    arms[e] = rotate(bodies.frameNow(ends[e]->body).turn, ends[e]->at);
    const InverseMass& m = bodies.inverse[ends[e]->body];
    inertia += m.mass + m.inertia * cross(arms[e], s.line) * cross(arms[e], s.line);
  }
  // Only where the sub-step follows the spring: what is stiffer is brought to rest at once.
  const double part = share * (1 - smoothStep((h_ * h_ * s.def.stiffness * inertia - 0.25) / 0.75));
  for (int e = 0; e < 2; ++e)
    if (ends[e]->body >= 0 && (!fresh || s.fresh || ((*fresh)[ends[e]->body] & 1)))
      bodies.push(ends[e]->body, arms[e], (e == 0 ? -part : part) * s.impulse * s.line);
}

void SpringSet::takeBackHalf(Bodies& bodies, const std::vector<char>& fresh, double h) {
  h_ = h;
  if (islands_.empty() && !fresh_) return;  // a sheet has no halves
  fresh_ = false;
  for (int k = 0; k < count(); ++k) {
    Spring& spring = springs_[k];
    auto isFresh = [&](int body) { return body >= 0 && (fresh[body] & 1); };
    if (spring.fresh || isFresh(spring.def.from.body) || isFresh(spring.def.to.body))
      push(k, bodies, -0.5, &fresh);
    spring.fresh = false;
  }
}

void SpringSet::giveHalf(int spring, Bodies& bodies) const {
  if (!springs_[spring].fresh) push(spring, bodies, 0.5, nullptr);
}

double SpringSet::tension(int spring) const {
  if (!(h_ > 0) || !springs_[spring].there) return 0;
  const int sheet = spring < static_cast<int>(sheetOf_.size()) ? sheetOf_[spring] : -1;
  return sheet >= 0 ? sheets_[sheet].tension(spring) : -springs_[spring].impulse / h_;
}

double SpringSet::distance(int spring, const Bodies& bodies) const {
  const Spring& s = springs_[spring];
  return length(springEnd(s.def.to, s, bodies, clock_).at - springEnd(s.def.from, s, bodies, clock_).at);
}

double SpringSet::energy(const Bodies& bodies) const {
  double sum = 0;
  for (int k = 0; k < count(); ++k) {
    if (!springs_[k].there) continue;
    const double stretch = stretchOf(springs_[k].def, distance(k, bodies));
    sum += 0.5 * springs_[k].def.stiffness * stretch * stretch;
  }
  return sum;
}

void SpringSet::hashInto(Fnv1a& hash) const {
  for (int k = 0; k < count(); ++k) {
    hash.update(&springs_[k].there, sizeof springs_[k].there);
    const double last = tension(k);
    hash.update(&last, sizeof last);
  }
}

long SpringSet::iterations() const {
  long sum = 0;
  for (const SpringSheet& sheet : sheets_) sum += sheet.iterations();
  return sum;
}

std::size_t SpringSet::bytes() const {
  std::size_t sum = springs_.size() * sizeof(Spring) + moved_.size() + sheetOf_.size() * sizeof(int);
  for (const SpringSheet& sheet : sheets_) sum += sheet.bytes();
  for (const SpringIsland& island : islands_) sum += island.bytes();
  return sum;
}

}  // namespace smokebox
