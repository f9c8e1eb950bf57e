#include "rigid/joint_island.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rigid/islands.h"
#include "rigid/spring_row.h"

namespace smokebox {

namespace {

constexpr int kMostIterations = 40;
// Kinetic energy that a solution may have, times that of the linear one.
constexpr double kMostGain = 1.02;
// ... and that joints may make of what there is without them, and at this speed, m/s.
constexpr double kFlung = 4, kGentle = 2;
constexpr int kLastToJoin = 8;  // iterations after which drives only let go
// What the other joints leave less of than this share of a row's inertia they imply already: it is left out.
// Where a joint is off by a gap, the directions of its rows are, too: by that share of its reach.
constexpr double kImplied = 1e-10, kImpliedByGap = 4, kImpliedMost = 1e-3;
// Added to the diagonal of joints that are open, as a share of it: where they pull against each other the
// forces have bounds.
constexpr double kSofteningOpen = 0.5;
// What a gap may shrink by in a sub-step, as a share of the joint's reach: a joint that does not fit when it
// is made, or is torn apart by a script, closes within tens of sub-steps.
constexpr double kClosing = 0.01;
// Seconds in which most of what is beyond a limit comes back: the speed of the way back stays.
constexpr double kLimitClosing = 0.1;

double inertiaBetween(const Jacobian& i, const Jacobian& j, const InverseMass& m) {
  return m.mass * (i.x * j.x + i.y * j.y) + m.inertia * (i.turn * j.turn);
}

double kineticOf(const InverseMass& m, const Motion& v) {
  return (m.mass > 0 ? 0.5 * (v.x * v.x + v.y * v.y) / m.mass : 0) +
         (m.inertia > 0 ? 0.5 * v.turn * v.turn / m.inertia : 0);
}

void pushBody(Motion& v, const InverseMass& m, const std::array<Jacobian, 3>& rows, const JointRow& impulse) {
  for (int r = 0; r < 3; ++r) {
    v.x += m.mass * (rows[r].x * impulse[r]);
    v.y += m.mass * (rows[r].y * impulse[r]);
    v.turn += m.inertia * (rows[r].turn * impulse[r]);
  }
}

}  // namespace

bool JointIsland::layOut(const std::vector<int>& joints, const std::vector<Joint>& all,
                         const Bodies& bodies) {
  links_.clear();
  places_.clear();
  couplings_.clear();
  std::vector<std::array<int, 2>> ends;
  for (const int joint : joints) ends.push_back({all[joint].def.a.body, all[joint].def.b.body});
  for (const auto& pair : ends)
    for (const int body : pair)
      if (body >= 0) places_.push_back({body, {}, 0, {}, 1, 0, {}});
  std::sort(places_.begin(), places_.end(), [](const Place& p, const Place& q) { return p.body < q.body; });
  places_.erase(std::unique(places_.begin(), places_.end(),
                            [](const Place& p, const Place& q) { return p.body == q.body; }),
                places_.end());
  auto placeOfBody = [&](int body) {
    if (body < 0) return -1;
    return static_cast<int>(std::lower_bound(places_.begin(), places_.end(), body,
                                             [](const Place& p, int wanted) { return p.body < wanted; }) -
                            places_.begin());
  };
  for (std::size_t k = 0; k < joints.size(); ++k) {
    Link link;
    link.joint = joints[k];
    link.a = ends[k][0], link.b = ends[k][1];
    link.placeA = placeOfBody(link.a), link.placeB = placeOfBody(link.b);
    links_.push_back(link);
  }
  const std::vector<SharedBody> shared = sharedBodies(ends, bodies);
  std::vector<std::array<int, 2>> pairs;
  for (const SharedBody& s : shared) pairs.push_back({s.first, s.second});
  const int count = static_cast<int>(joints.size());
  if (!matrix_.layOut(count, pairs, 20000 + 60L * count)) return false;
  for (const SharedBody& s : shared) {
    const bool firstLater = matrix_.comesAfter(s.first, s.second);
    couplings_.push_back({matrix_.slot(s.first, s.second), firstLater ? s.first : s.second,
                          firstLater ? s.second : s.first, s.body});
  }
  unknowns_.assign(count, JointRow{});
  implied_.assign(count, JointRow{});
  return true;
}

void JointIsland::place(const Bodies& bodies, double h) {
  for (Place& p : places_) {
    const Motion& v = bodies.velocity[p.body];
    const Vec2 position = bodies.unwrappedNow(p.body);
    const double angle = bodies.angleNow(p.body);
    p.frame.position = position + h * v.linear();
    p.angle = angle + h * v.turn;
    p.frame.turn = p.angle == bodies.angleRad[p.body] ? bodies.turn[p.body] : turnBy(p.angle);
  }
}

JointPlace JointIsland::placeOf(const Link& link) const {
  JointPlace place;
  if (link.placeA >= 0) place.a = places_[link.placeA].frame, place.angleA = places_[link.placeA].angle;
  if (link.placeB >= 0) place.b = places_[link.placeB].frame, place.angleB = places_[link.placeB].angle;
  return place;
}

void JointIsland::apply(const Link& link, const JointRow& impulse, Bodies& bodies) const {
  if (link.a >= 0) pushBody(bodies.velocity[link.a], places_[link.placeA].inverse, link.rows.a, impulse);
  if (link.b >= 0) pushBody(bodies.velocity[link.b], places_[link.placeB].inverse, link.rows.b, impulse);
}

void JointIsland::warmStart(std::vector<Joint>& joints, Bodies& bodies, double h) {
  place(bodies, 0);
  linear_ = curved_ = isOpen_ = stays_ = false;
  phase_ = Phase::asTheyAre;
  for (Link& link : links_) {
    Joint& joint = joints[link.joint];
    if (!settled_) joint.impulse = {};
    prepare(link, joint, h);
  }
  settled_ = true;
  stiffen(joints, bodies, h);
  for (const Link& link : links_) apply(link, joints[link.joint].impulse, bodies);
  factor(joints);
}

/// Whatever the rows of a joint need to know of the sub-step's start.
void JointIsland::prepare(Link& link, Joint& joint, double h) {
  const JointDef& def = joint.def;
  const JointPlace now = placeOf(link);
  link.rows = link.atEnd = jacobiansOf(def, now);
  link.gap = gapsOf(def, joint.startAngle, now);
  const double arms = length(def.a.at) + length(def.b.at);
  link.reach = std::max({arms, def.kind == JointKind::rope ? def.length : 0.0,
                         def.kind == JointKind::slide ? std::fabs(link.gap[2]) : 0.0, 1e-3});
  const double away = std::fabs(now.a.position.x) + std::fabs(now.a.position.y) +
                      std::fabs(now.b.position.x) + std::fabs(now.b.position.y);
  const int kept = equalities(def.kind);
  link.open = {};
  link.off = 0;
  for (int r = 0; r < 3; ++r) {
    const bool angle = isAngle(def.kind, r);
    if (r < kept) link.off = std::max(link.off, std::fabs(link.gap[r]) / (angle ? 1.0 : link.reach));
    link.tolerance[r] = angle ? 1e-13 + 1e-15 * (std::fabs(now.angleA) + std::fabs(now.angleB))
                              : 1e-13 * link.reach + 1e-15 * away;
    const double most = kClosing * (angle ? 1.0 : link.reach);
    link.goal[r] = link.gap[r] - std::clamp(link.gap[r], -most, most);
    if (r >= kept) continue;
    joint.on[r] = true;
    isOpen_ |= link.open[r] = std::fabs(link.gap[r]) > most;
  }
  if (hasDrive(def)) {
    auto rate = [&](double room, double inside) {
      return room * inside >= 0 ? room / h : room / std::max(kLimitClosing, h);
    };
    Drive& drive = link.drive;
    const double lower = def.kind == JointKind::rope ? -std::numeric_limits<double>::infinity() : def.lower;
    const double upper = def.kind == JointKind::rope ? def.length : def.upper;
    drive.low = rate(lower - link.gap[2], -1);
    drive.high = rate(upper - link.gap[2], 1);
    const double beyond = std::max(lower - link.gap[2], link.gap[2] - upper);
    isOpen_ |= link.open[2] = beyond > kClosing * (isAngle(def.kind, 2) ? 1.0 : link.reach);
    drive.push = def.kind == JointKind::rope ? 0 : def.motorLimit * h;
    drive.speed = std::clamp(def.motorSpeed, drive.low, std::max(drive.low, drive.high));
  } else if (kept < 3) {
    joint.on[2] = false;
  }
}

/// Inertia of light bodies that are pulled strongly, from the impulses of the last sub-step.
void JointIsland::stiffen(const std::vector<Joint>& joints, Bodies& bodies, double h) {
  for (Place& p : places_) p.inverse = bodies.inverse[p.body], p.swing = 0, p.kept = 1;
  for (const Link& link : links_) {
    const Joint& joint = joints[link.joint];
    Vec2 onB;
    for (int r = 0; r < 3; ++r) onB = onB + joint.impulse[r] * Vec2{link.rows.b[r].x, link.rows.b[r].y};
    if (link.a >= 0) {
      Place& p = places_[link.placeA];
      p.swing -= dot(rotate(p.frame.turn, joint.def.a.at), onB);
    }
    if (link.b >= 0) {
      Place& p = places_[link.placeB];
      p.swing += dot(rotate(p.frame.turn, joint.def.b.at), onB);
    }
  }
  for (Place& p : places_) {
    const double inverse = p.inverse.inertia, squared = h * p.swing * inverse;
    if (!(squared > 0.25)) continue;
    const SpringShares shares = springShares(p.swing / h, 0, inverse, h);
    const double weight = smoothStep((squared - 0.25) / 0.75);
    const double now = 1 + weight * shares.now * squared, before = 1 + weight * shares.before * squared;
    p.inverse.inertia = inverse / now;
    p.kept = before / now;
    bodies.velocity[p.body].turn *= p.kept;
  }
}

/// The same with the impulses that are known now.
void JointIsland::stiffenAgain(const std::vector<Joint>& joints, Bodies& bodies, double h) {
  for (const Link& link : links_) {
    const JointRow& made = joints[link.joint].impulse;
    apply(link, {-made[0], -made[1], -made[2]}, bodies);
  }
  for (const Place& p : places_) bodies.velocity[p.body].turn /= p.kept;
  stiffen(joints, bodies, h);
  for (const Link& link : links_) apply(link, joints[link.joint].impulse, bodies);
  linear_ = curved_ = false;
  factor(joints);
}

double JointIsland::kinetic(const Bodies& bodies) const {
  double sum = 0;
  for (const Place& p : places_) sum += kineticOf(bodies.inverse[p.body], bodies.velocity[p.body]);
  return sum;
}

void JointIsland::doubt(const std::vector<Joint>& joints, const Bodies& bodies) {
  for (Place& p : places_) {
    p.free = bodies.velocity[p.body];
    if (!bodies.moves(p.body) && (p.free.x != 0 || p.free.y != 0 || p.free.turn != 0)) return;  // it drives
  }
  for (const Link& link : links_) {
    const Joint& joint = joints[link.joint];
    if (hasDrive(joint.def) && link.drive.push > 0) return;  // a motor
    const JointRow& made = joint.impulse;
    const JointRow back{-made[0], -made[1], -made[2]};
    if (link.a >= 0) pushBody(places_[link.placeA].free, places_[link.placeA].inverse, link.rows.a, back);
    if (link.b >= 0) pushBody(places_[link.placeB].free, places_[link.placeB].inverse, link.rows.b, back);
  }
  double now = 0, without = 0, mass = 0;
  for (const Place& p : places_) {
    const InverseMass& m = bodies.inverse[p.body];
    now += kineticOf(m, bodies.velocity[p.body]), without += kineticOf(m, p.free);
    if (m.mass > 0) mass += 1 / m.mass;
  }
  if (!(now <= kFlung * (without + 0.5 * mass * kGentle * kGentle))) settled_ = false;
}

bool JointIsland::mark(std::vector<char>& marked) const {
  const auto isMarked = [&](const Place& p) { return marked[p.body] != 0; };
  const bool any = std::any_of(places_.begin(), places_.end(), isMarked);
  if (!isTorn() && (!any || std::all_of(places_.begin(), places_.end(), isMarked))) return false;
  bool changed = false;
  for (const Place& p : places_) changed |= std::exchange(marked[p.body], 1) == 0;
  return changed;
}

void JointIsland::goLinear(const std::vector<Joint>& joints) {
  linear_ = true;
  for (Link& link : links_) link.atEnd = link.rows;
  factor(joints);
}

void JointIsland::stayLinear(const std::vector<Joint>& joints, const Bodies& bodies) {
  if (stays_) return;
  stays_ = true;
  phase_ = Phase::linear;
  for (Place& p : places_) p.inverse = bodies.inverse[p.body];
  goLinear(joints);
}

void JointIsland::factor(const std::vector<Joint>& joints) {
  for (Link& link : links_) link.in = joints[link.joint].on;
  factor();
}

void JointIsland::factor() {
  const InverseMass fixed;
  matrix_.clear();
  for (int k = 0; k < matrix_.count(); ++k) {
    Link& link = links_[k];
    const std::array<bool, 3>& on = link.in;
    const InverseMass& a = link.a < 0 ? fixed : places_[link.placeA].inverse;
    const InverseMass& b = link.b < 0 ? fixed : places_[link.placeB].inverse;
    BlockFactor<3>::Block& block = matrix_.diagonal(k);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        if (i == j || (on[i] && on[j]))
          block[3 * i + j] = inertiaBetween(link.atEnd.a[i], link.rows.a[j], a) +
                             inertiaBetween(link.atEnd.b[i], link.rows.b[j], b);
      link.ownInertia[i] = inertiaBetween(link.rows.a[i], link.rows.a[i], a) +
                           inertiaBetween(link.rows.b[i], link.rows.b[i], b);
      // A row that moves nothing (the angle between two particles) is left out.
      implied_[k][i] =
          std::clamp(kImpliedByGap * link.off * link.off, kImplied, kImpliedMost) * link.ownInertia[i];
      if (!on[i] || !(link.ownInertia[i] > 0)) {
        block[4 * i] = 1;
        implied_[k][i] = 0;
      } else if (link.open[i]) {
        block[4 * i] += kSofteningOpen * link.ownInertia[i];
      }
    }
  }
  for (const Coupling& c : couplings_) {
    const Link &row = links_[c.row], &column = links_[c.column];
    const std::array<bool, 3>&rowOn = row.in, &columnOn = column.in;
    const InverseMass& m = places_[row.a == c.body ? row.placeA : row.placeB].inverse;
    // A joint of a body with itself would have it on both sides; its ends are two bodies.
    const bool rowAtA = row.a == c.body, columnAtA = column.a == c.body;
    const auto &rows = rowAtA ? row.rows.a : row.rows.b, &rowsAtEnd = rowAtA ? row.atEnd.a : row.atEnd.b;
    const auto &columns = columnAtA ? column.rows.a : column.rows.b,
               &columnsAtEnd = columnAtA ? column.atEnd.a : column.atEnd.b;
    BlockFactor<3>::Block &lower = matrix_.lower(c.slot), &upper = matrix_.upper(c.slot);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        if (!rowOn[i] || !columnOn[j]) continue;
        lower[3 * i + j] += inertiaBetween(rowsAtEnd[i], columns[j], m);
        upper[3 * i + j] += inertiaBetween(columnsAtEnd[j], rows[i], m);
      }
  }
  matrix_.factor(implied_);
}

JointRow JointIsland::ratesOf(const Link& link, const Joint& joint, const Bodies& bodies, double h) const {
  JointRow rates;
  if (linear_) {
    const Motion none;
    const Motion& a = link.a < 0 ? none : bodies.velocity[link.a];
    const Motion& b = link.b < 0 ? none : bodies.velocity[link.b];
    for (int r = 0; r < 3; ++r) rates[r] = link.rows.a[r].rate(a) + link.rows.b[r].rate(b);
  } else {
    const JointRow end = gapsOf(joint.def, joint.startAngle, placeOf(link));
    for (int r = 0; r < 3; ++r) rates[r] = (end[r] - link.gap[r]) / h;
  }
  const int kept = equalities(joint.def.kind);
  for (int r = 0; r < kept; ++r) rates[r] += (link.gap[r] - (linear_ ? 0 : link.goal[r])) / h;
  return rates;
}

bool JointIsland::chooseStair(Link& link, Joint& joint, double rate, bool mayJoin, double& impulse) const {
  const Drive& drive = link.drive;
  const double own = link.ownInertia[2], now = joint.impulse[2];
  if (!(own > 0)) {
    joint.on[2] = false;
    impulse = now;
    return false;
  }
  // The impulses that would bring the rate to each of the steps.
  const double toLow = now + (drive.low - rate) / own, toSpeed = now + (drive.speed - rate) / own,
               toHigh = now + (drive.high - rate) / own;
  const bool was = joint.on[2];
  bool on = true;
  if (toLow >= drive.push && toLow > 0) {
    link.driveGoal = drive.low;
  } else if (toHigh <= -drive.push && toHigh < 0) {
    link.driveGoal = drive.high;
  } else if (drive.push > 0 && std::fabs(toSpeed) <= drive.push) {
    link.driveGoal = drive.speed;
  } else {
    on = false;
  }
  if (on && !was && !mayJoin) on = false;
  joint.on[2] = on;
  impulse = on ? now : toSpeed > 0 ? drive.push : -drive.push;
  return on != was;
}

double JointIsland::solve(std::vector<Joint>& joints, Bodies& bodies, double h) {
  double found = 0, before = std::numeric_limits<double>::infinity();
  int started = 0;  // iteration at which the phase began
  for (int iteration = 0;; ++iteration) {
    place(bodies, h);
    bool changed = false, pushed = false;
    double worst = 0;  // in units of what is tolerated
    for (std::size_t k = 0; k < links_.size(); ++k) {
      Link& link = links_[k];
      Joint& joint = joints[link.joint];
      JointRow rates = ratesOf(link, joint, bodies, h);
      if (hasDrive(joint.def)) {
        double impulse = 0;
        changed |= chooseStair(link, joint, rates[2], iteration - started <= kLastToJoin, impulse);
        if (impulse != joint.impulse[2]) {
          const JointRow more{0, 0, impulse - joint.impulse[2]};
          const double rate = std::fabs(more[2]) * link.ownInertia[2];
          if (iteration == 0) found = std::max(found, isAngle(joint.def.kind, 2) ? rate * link.reach : rate);
          joint.impulse[2] = impulse;
          apply(link, more, bodies);
          pushed |= rate * h > link.tolerance[2];
        }
        rates[2] -= link.driveGoal;
      }
      for (int r = 0; r < 3; ++r) {
        unknowns_[k][r] = joint.on[r] && link.ownInertia[r] > 0 ? -rates[r] : 0;
        const double size = std::fabs(unknowns_[k][r]);
        worst = std::max(worst, size * h / link.tolerance[r]);
        if (iteration == 0) found = std::max(found, isAngle(joint.def.kind, r) ? size * link.reach : size);
      }
    }
    if (!changed && !pushed) {
      if (worst <= 1) {
        if (phase_ == Phase::stiffened && kinetic(bodies) > kMostGain * probeEnergy_) {
          phase_ = Phase::linear;
          goLinear(joints);
          before = std::numeric_limits<double>::infinity();
          started = iteration + 1;
          continue;
        }
        if (phase_ != Phase::probe) return found;
        probeEnergy_ = kinetic(bodies);
        phase_ = Phase::stiffened;
        stiffenAgain(joints, bodies, h);
        before = std::numeric_limits<double>::infinity();
        started = iteration + 1;
        continue;
      }
      // It no longer gets better: by rounding, because there is no solution on the curve, or none at all.
      // (A solution that is not approached steadily is another one, with joints turned over.)
      if (iteration >= started + 2 && !(worst < 0.5 * before)) {
        if (worst < 1e3) return found;
        if (linear_) {
          settled_ = worst < 1e6;
          return found;
        }
        phase_ = phase_ == Phase::asTheyAre ? Phase::probe : Phase::linear;
        goLinear(joints);
        started = iteration + 1;
        before = std::numeric_limits<double>::infinity();
        continue;
      }
      if (!linear_ && (curved_ || worst > 0.1 * before)) {
        curved_ = true;
        for (Link& link : links_) link.atEnd = jacobiansOf(joints[link.joint].def, placeOf(link));
        factor(joints);
      }
    }
    if (iteration >= kMostIterations) {
      settled_ = false;
      return found;
    }
    before = changed || pushed ? std::numeric_limits<double>::infinity() : worst;
    if (pushed) {
      place(bodies, h);
      for (std::size_t k = 0; k < links_.size(); ++k) {
        const Link& link = links_[k];
        const Joint& joint = joints[link.joint];
        JointRow rates = ratesOf(link, joint, bodies, h);
        rates[2] -= hasDrive(joint.def) ? link.driveGoal : 0;
        for (int r = 0; r < 3; ++r) unknowns_[k][r] = joint.on[r] && link.ownInertia[r] > 0 ? -rates[r] : 0;
      }
    }
    if (changed) factor(joints);
    matrix_.solve(unknowns_);
    for (std::size_t k = 0; k < links_.size(); ++k) {
      Joint& joint = joints[links_[k].joint];
      for (int r = 0; r < 3; ++r) joint.impulse[r] += unknowns_[k][r];
      apply(links_[k], unknowns_[k], bodies);
    }
  }
}

void JointIsland::beginImpacts(const std::vector<Joint>& joints, Bodies& bodies) {
  place(bodies, 0);
  for (Place& p : places_) p.inverse = bodies.inverse[p.body];
  for (Link& link : links_) {
    const Joint& joint = joints[link.joint];
    const int kept = equalities(joint.def.kind);
    link.rows = link.atEnd = jacobiansOf(joint.def, placeOf(link));
    for (int r = 0; r < 3; ++r) link.in[r] = r < kept;
    link.side = 0;
    link.open = {};
    if (!hasDrive(joint.def) || !joint.on[2]) continue;
    const double impulse = joint.impulse[2];
    link.side = std::fabs(impulse) <= link.drive.push ? 0 : impulse > 0 ? 1 : -1;
    link.in[2] = link.side != 0;
  }
  factor();
  // The velocities are those of the last sub-step's middle: an impact is exact where they obey the joints
  // now.
  for (std::size_t k = 0; k < links_.size(); ++k) {
    const Link& link = links_[k];
    const Motion none;
    const Motion &a = link.a < 0 ? none : bodies.velocity[link.a],
                 &b = link.b < 0 ? none : bodies.velocity[link.b];
    for (int r = 0; r < 3; ++r)
      unknowns_[k][r] =
          link.in[r] && link.ownInertia[r] > 0 ? -link.rows.a[r].rate(a) - link.rows.b[r].rate(b) : 0;
  }
  matrix_.solve(unknowns_);
  for (std::size_t k = 0; k < links_.size(); ++k) apply(links_[k], unknowns_[k], bodies);
}

void JointIsland::findReaction(const std::array<int, 2>& struck, const std::array<Motion, 2>& change) {
  for (std::size_t k = 0; k < links_.size(); ++k) {
    const Link& link = links_[k];
    unknowns_[k] = {};
    for (int r = 0; r < 3; ++r) {
      if (!link.in[r] || !(link.ownInertia[r] > 0)) continue;
      for (int s = 0; s < 2; ++s) {
        if (struck[s] < 0) continue;
        if (link.a == struck[s]) unknowns_[k][r] -= link.rows.a[r].rate(change[s]);
        if (link.b == struck[s]) unknowns_[k][r] -= link.rows.b[r].rate(change[s]);
      }
    }
  }
  matrix_.solve(unknowns_);
}

void JointIsland::react(const std::array<int, 2>& struck, const std::array<Motion, 2>& change,
                        Bodies& bodies) {
  findReaction(struck, change);
  // Ropes and limits only hold one way: those that would pull the other way let go.
  bool anyGoes = false;
  for (std::size_t k = 0; k < links_.size(); ++k) {
    if (links_[k].side == 0 || unknowns_[k][2] * links_[k].side >= 0) continue;
    links_[k].in[2] = false;
    anyGoes = true;
  }
  if (anyGoes) {
    factor();
    findReaction(struck, change);
  }
  for (std::size_t k = 0; k < links_.size(); ++k) apply(links_[k], unknowns_[k], bodies);
  if (!anyGoes) return;
  for (Link& link : links_) link.in[2] = link.in[2] || link.side != 0;
  factor();
}

std::size_t JointIsland::bytes() const {
  return links_.size() * sizeof(Link) + places_.size() * sizeof(Place) +
         couplings_.size() * sizeof(Coupling) + matrix_.bytes() + unknowns_.size() * sizeof(JointRow);
}

}  // namespace smokebox
