#include "rigid/joint_set.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/hash.h"
#include "rigid/islands.h"

namespace smokebox {

int JointSet::add(const JointDef& def, const Bodies& bodies) {
  Joint joint;
  joint.def = def;
  const double size = length(def.axis);
  joint.def.axis = size > 0 ? (1 / size) * def.axis : Vec2{1, 0};
  auto angle = [&](int body) { return body < 0 ? 0.0 : bodies.angleNow(body); };
  joint.startAngle = angle(def.b.body) - angle(def.a.body);
  joints_.push_back(joint);
  stale_ = true;
  return count() - 1;
}

void JointSet::remove(int joint) {
  joints_[joint].there = false;
  joints_[joint].impulse = {};
  stale_ = true;
}

void JointSet::removeAt(int body) {
  for (int k = 0; k < count(); ++k)
    if (joints_[k].there && (joints_[k].def.a.body == body || joints_[k].def.b.body == body)) remove(k);
}

bool JointSet::ties(int body) const {
  return std::any_of(joints_.begin(), joints_.end(), [&](const Joint& joint) {
    return joint.there && (joint.def.a.body == body || joint.def.b.body == body);
  });
}

void JointSet::setMotor(int joint, double speed, double limit) {
  joints_[joint].def.motorSpeed = speed;
  joints_[joint].def.motorLimit = limit;
}

bool JointSet::empty() const {
  return std::none_of(joints_.begin(), joints_.end(), [](const Joint& joint) { return joint.there; });
}

void JointSet::beginStep(Bodies& bodies, double, int) {
  auto moves = [&](int body) { return static_cast<char>(body >= 0 && bodies.moves(body)); };
  moved_.resize(joints_.size());
  for (int k = 0; k < count(); ++k) {
    if (!joints_[k].there) continue;
    const std::array<char, 2> now{moves(joints_[k].def.a.body), moves(joints_[k].def.b.body)};
    stale_ |= now != moved_[k];
    moved_[k] = now;
  }
  if (stale_) layOut(bodies);
}

void JointSet::layOut(const Bodies& bodies) {
  stale_ = false;
  islands_.clear();
  islandOf_.assign(bodies.count(), -1);
  std::vector<int> numbers;
  std::vector<std::array<int, 2>> ends;
  for (int k = 0; k < count(); ++k) {
    if (!joints_[k].there) continue;
    numbers.push_back(k);
    ends.push_back({joints_[k].def.a.body, joints_[k].def.b.body});
  }
  for (std::vector<int>& group : islandsOf(ends, bodies)) {
    for (int& link : group) link = numbers[link];
    JointIsland island;
    if (island.layOut(group, joints_, bodies)) {
      island.eachBody(bodies, [&](int body) { islandOf_[body] = static_cast<int>(islands_.size()); });
      islands_.push_back(std::move(island));
      continue;
    }
    // Too dense: each by itself, in turn.
    for (const int joint : group) {
      islands_.emplace_back();
      islands_.back().layOut({joint}, joints_, bodies);
    }
  }
}

void JointSet::warmStart(Bodies& bodies, double h) {
  h_ = h;
  for (JointIsland& island : islands_) island.warmStart(joints_, bodies, h);
}

double JointSet::solve(Bodies& bodies, double h) {
  double change = 0;
  for (JointIsland& island : islands_) change = std::max(change, island.solve(joints_, bodies, h));
  return change;
}

void JointSet::listTogether(const Bodies& bodies, int a, int b, std::vector<int>& all) const {
  all.clear();
  const auto add = [&](int body) { all.push_back(body); };
  const int ofA = holds(a) ? islandOf_[a] : -1, ofB = holds(b) ? islandOf_[b] : -1;
  if (ofA >= 0)
    islands_[ofA].eachBody(bodies, add);
  else if (bodies.moves(a))
    add(a);
  if (ofB >= 0 && ofB != ofA)
    islands_[ofB].eachBody(bodies, add);
  else if (ofB < 0 && bodies.moves(b))
    add(b);
}

void JointSet::beginImpact(Bodies& bodies, int a, int b) {
  for (const int body : {a, b})
    if (holds(body) && !std::exchange(isReady_[islandOf_[body]], 1))
      islands_[islandOf_[body]].beginImpacts(joints_, bodies);
}

void JointSet::react(Bodies& bodies, int a, const Motion& changeA, int b, const Motion& changeB) {
  const int ofA = holds(a) ? islandOf_[a] : -1, ofB = holds(b) ? islandOf_[b] : -1;
  const auto one = [&](int island, const std::array<int, 2>& struck) {
    if (island < 0) return;
    islands_[island].react(struck, {changeA, changeB}, bodies);
  };
  if (ofA == ofB) return one(ofA, {a, b});
  one(ofA, {a, -1});
  one(ofB, {-1, b});
}

void JointSet::stayLinear(const Bodies& bodies) {
  for (JointIsland& island : islands_) island.stayLinear(joints_, bodies);
}

void JointSet::doubt(const Bodies& bodies) {
  for (JointIsland& island : islands_) island.doubt(joints_, bodies);
}

bool JointSet::anyTorn() const {
  return std::any_of(islands_.begin(), islands_.end(), [](const JointIsland& each) { return each.isTorn(); });
}

bool JointSet::mark(std::vector<char>& marked) const {
  bool changed = false;
  for (const JointIsland& island : islands_) changed |= island.mark(marked);
  return changed;
}

void JointSet::endStep(Bodies&) {}

double JointSet::tension(int joint) const {
  if (h_ <= 0) return 0;
  const Joint& j = joints_[joint];
  const JointRow& impulse = j.impulse;
  switch (j.def.kind) {
    case JointKind::slide:
      return std::sqrt(impulse[0] * impulse[0] + impulse[2] * impulse[2]) / h_;
    case JointKind::rope:
      return -impulse[2] / h_;
    default:
      return std::sqrt(impulse[0] * impulse[0] + impulse[1] * impulse[1]) / h_;
  }
}

double JointSet::torque(int joint) const {
  const Joint& j = joints_[joint];
  if (h_ <= 0 || j.def.kind == JointKind::rope) return 0;
  return j.impulse[j.def.kind == JointKind::slide ? 1 : 2] / h_;
}

void JointSet::hashInto(Fnv1a& hash) const {
  for (const Joint& joint : joints_) {
    hash.update(&joint.there, sizeof joint.there);
    hash.update(joint.impulse.data(), sizeof joint.impulse);
  }
}

std::size_t JointSet::bytes() const {
  std::size_t sum = joints_.size() * sizeof(Joint);
  for (const JointIsland& island : islands_) sum += island.bytes();
  return sum;
}

}  // namespace smokebox
