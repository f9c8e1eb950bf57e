#include "rigid/joint_set.h"

#include <algorithm>
#include <cmath>

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
