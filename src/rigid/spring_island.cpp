#include "rigid/spring_island.h"

#include <algorithm>
#include <cmath>

#include "rigid/islands.h"

namespace smokebox {

namespace {

// The stretch at the end is not quite linear in the impulses.
constexpr int kMostIterations = 6;
constexpr double kSettled = 1e-9;  // of the first change

double inertiaOf(Vec2 direction, Vec2 arm, const InverseMass& m) {
  const double lever = cross(arm, direction);
  return m.mass * dot(direction, direction) + m.inertia * lever * lever;
}

/// Whether the distance changes almost as its rate along the line says.
bool isFar(double distance, Vec2 change) { return 4 * dot(change, change) < distance * distance; }

InverseMass inverseOf(const Bodies& bodies, int body) {
  return body < 0 ? InverseMass{} : bodies.inverse[body];
}

}  // namespace

SpringEnd springEnd(const Anchor& anchor, const Spring& spring, const Bodies& bodies,
                    const StepClock& clock) {
  if (anchor.body >= 0) {
    const Vec2 centre = bodies.unwrappedNow(anchor.body);
    if (anchor.at == Vec2{}) return {centre, {}};
    const Vec2 arm = rotate(bodies.frameNow(anchor.body).turn, anchor.at);
    return {centre + arm, arm};
  }
  if (!spring.carried) return {anchor.at, {}};
  const double share = std::min(1.0, clock.elapsed / clock.dt);
  return {spring.carriedFrom + share * (spring.carriedTo - spring.carriedFrom), {}};
}

Vec2 carriedVelocity(const Spring& spring, const StepClock& clock) {
  if (!spring.carried) return {};
  const Vec2 v = (1 / clock.dt) * (spring.carriedTo - spring.carriedFrom);
  return spring.def.to.body < 0 ? v : -v;
}

bool SpringIsland::layOut(const std::vector<int>& springs, const std::vector<Spring>& all,
                          const Bodies& bodies) {
  links_.clear();
  couplings_.clear();
  std::vector<std::array<int, 2>> ends;
  for (const int k : springs) {
    Link link;
    link.spring = k;
    link.a = all[k].def.from.body, link.b = all[k].def.to.body;
    ends.push_back({link.a, link.b});
    links_.push_back(link);
  }
  const std::vector<SharedBody> shared = sharedBodies(ends, bodies);
  const long count = static_cast<long>(springs.size()), mostProducts = 2000 + 3 * count;
  if (static_cast<long>(shared.size()) > mostProducts) return false;
  std::vector<std::array<int, 2>> pairs;
  for (const SharedBody& s : shared) pairs.push_back({s.first, s.second});
  if (!matrix_.layOut(static_cast<int>(count), pairs, mostProducts)) return false;
  for (const SharedBody& s : shared) {
    const bool firstLater = matrix_.comesAfter(s.first, s.second);
    couplings_.push_back({matrix_.slot(s.first, s.second), firstLater ? s.first : s.second,
                          firstLater ? s.second : s.first, s.body});
  }
  unknowns_.assign(count, {});
  return true;
}

void SpringIsland::warmStart(std::vector<Spring>& springs, Bodies& bodies, const StepClock& clock, double h,
                             double hBefore) {
  for (Link& link : links_) {
    Spring& spring = springs[link.spring];
    const SpringDef& def = spring.def;
    const SpringEnd from = springEnd(def.from, spring, bodies, clock);
    const SpringEnd to = springEnd(def.to, spring, bodies, clock);
    const Vec2 between = to.at - from.at;
    const double distance = length(between);
    link.armA = from.arm, link.armB = to.arm;
    link.carried = carriedVelocity(spring, clock);
    if (distance > 0) spring.line = (1 / distance) * between;
    link.direction[0] = spring.line, link.direction[1] = perpendicular(spring.line);
    auto velocity = [&](int body, Vec2 arm) { return body < 0 ? Vec2{} : bodies.velocityAt(body, arm); };
    const Vec2 before = spring.started ? (1 / hBefore) * (between - spring.between)
                                       : velocity(link.b, to.arm) - velocity(link.a, from.arm) + link.carried;
    // Of the distance itself, unless the ends went past each other.
    const double distanceBefore = length(between - hBefore * before);
    const double rateBefore =
        isFar(distance, hBefore * before) ? (distance - distanceBefore) / hBefore : dot(before, spring.line);
    spring.started = true;
    spring.between = link.between = between;
    link.distance = distance;

    const InverseMass a = inverseOf(bodies, link.a), b = inverseOf(bodies, link.b);
    for (int r = 0; r < 2; ++r)
      link.inertia[r] =
          inertiaOf(link.direction[r], link.armA, a) + inertiaOf(link.direction[r], link.armB, b);
    const double stretch = stretchOf(def, distance);
    link.row[0] = SoftRow{};
    if (stretch != 0 || def.slack == 0)
      link.row[0] =
          SoftRow::of(def.stiffness, def.damping,
                      springShares(def.stiffness, def.damping, link.inertia[0], h), stretch, rateBefore, h);
    // How fast the force grows across: its tension by its length.
    const double tight = def.length == 0 ? def.stiffness
                         : stretch > 0   ? def.stiffness * stretch / distance
                                         : 0;
    const double weight = smoothStep((h * h * tight * link.inertia[1] - 0.25) / 0.75);
    link.row[1] = SoftRow::of(weight * tight, 0, springShares(tight, 0, link.inertia[1], h), 0,
                              dot(before, link.direction[1]), h);
    link.across = 0;
    if (!link.row[0].on) spring.impulse = 0;
    const Vec2 impulse = spring.impulse * spring.line;
    if (link.a >= 0) bodies.push(link.a, link.armA, -impulse);
    if (link.b >= 0) bodies.push(link.b, link.armB, impulse);
  }
  factor(bodies);
}

void SpringIsland::factor(const Bodies& bodies) {
  matrix_.clear();
  for (int k = 0; k < matrix_.count(); ++k) {
    Link& link = links_[k];
    BlockFactor<2>::Block& block = matrix_.diagonal(k);
    const InverseMass a = inverseOf(bodies, link.a), b = inverseOf(bodies, link.b);
    for (int r = 0; r < 2; ++r)
      block[3 * r] = link.row[r].on && link.inertia[r] > 0 ? link.inertia[r] + link.row[r].softness : 1;
    if (link.row[0].on && link.row[1].on) {
      // The directions are at right angles: only the levers join the rows.
      block[1] = block[2] =
          a.inertia * (cross(link.armA, link.direction[0]) * cross(link.armA, link.direction[1])) +
          b.inertia * (cross(link.armB, link.direction[0]) * cross(link.armB, link.direction[1]));
    }
  }
  for (const Coupling& c : couplings_) {
    const Link &row = links_[c.row], &column = links_[c.column];
    const InverseMass& m = bodies.inverse[c.body];
    BlockFactor<2>::Block& block = matrix_.lower(c.slot);
    const bool rowAtA = row.a == c.body, columnAtA = column.a == c.body;
    const Vec2 rowArm = rowAtA ? row.armA : row.armB, columnArm = columnAtA ? column.armA : column.armB;
    const double sign = rowAtA == columnAtA ? 1 : -1;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        if (row.row[i].on && column.row[j].on)
          block[2 * i + j] +=
              sign * (m.mass * dot(row.direction[i], column.direction[j]) +
                      m.inertia * (cross(rowArm, row.direction[i]) * cross(columnArm, column.direction[j])));
  }
  for (const Coupling& c : couplings_) matrix_.upper(c.slot) = matrix_.lower(c.slot);
  matrix_.factor();
}

std::array<double, 2> SpringIsland::ratesOf(const Link& link, const Bodies& bodies, double h) {
  Vec2 v = link.carried;
  if (link.b >= 0) v = v + bodies.velocityAt(link.b, link.armB);
  if (link.a >= 0) v = v - bodies.velocityAt(link.a, link.armA);
  const double along = isFar(link.distance, h * v) ? (length(link.between + h * v) - link.distance) / h
                                                   : dot(link.direction[0], v);
  return {along, dot(link.direction[1], v)};
}

double SpringIsland::solve(std::vector<Spring>& springs, Bodies& bodies, double h) {
  double first = 0;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    double change = 0;
    for (std::size_t k = 0; k < links_.size(); ++k) {
      const Link& link = links_[k];
      const double impulse[2] = {springs[link.spring].impulse, link.across};
      const std::array<double, 2> rates = ratesOf(link, bodies, h);
      for (int r = 0; r < 2; ++r) {
        const SoftRow& row = link.row[r];
        unknowns_[k][r] =
            row.on && link.inertia[r] > 0 ? -(rates[r] + row.softness * impulse[r] + row.offset) : 0;
      }
    }
    matrix_.solve(unknowns_);
    for (std::size_t k = 0; k < links_.size(); ++k) {
      Link& link = links_[k];
      const std::array<double, 2>& more = unknowns_[k];
      springs[link.spring].impulse += more[0];
      link.across += more[1];
      change = std::max({change, std::fabs(more[0]) * link.inertia[0], std::fabs(more[1]) * link.inertia[1]});
      const Vec2 impulse = more[0] * link.direction[0] + more[1] * link.direction[1];
      if (link.a >= 0) bodies.push(link.a, link.armA, -impulse);
      if (link.b >= 0) bodies.push(link.b, link.armB, impulse);
    }
    if (iteration == 0) first = change;
    if (change <= kSettled * first) break;
  }
  return first;
}

std::size_t SpringIsland::bytes() const {
  return links_.size() * sizeof(Link) + couplings_.size() * sizeof(Coupling) + matrix_.bytes() +
         unknowns_.size() * sizeof(unknowns_[0]);
}

}  // namespace smokebox
