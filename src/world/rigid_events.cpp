// What events do to bodies, particles, cloths, springs and joints.
#include <algorithm>
#include <charconv>

#include "scene/tree_path.h"
#include "world/rigid_stage.h"

namespace smokebox {

namespace {

/// Does a step of a path lead to this item of a list: its name, or its position?
bool isStep(const std::string& step, const std::string& name, int position) {
  if (!name.empty() && step == name) return true;
  int number = -1;
  const auto [end, fault] = std::from_chars(step.data(), step.data() + step.size(), number);
  return fault == std::errc() && end == step.data() + step.size() && number == position;
}

}  // namespace

void RigidStage::impulse(const ImpulseAction& action) {
  for (const int index : action.on.bodies) {
    const Body& body = bodies_[index];
    if (!isThere(body)) continue;
    const HoldSpec hold{HoldSpec::Of::body, index, -1, action.at};
    system_.applyImpulse(body.id, system_.anchorPoint(*anchorOf(hold)), action.value);
  }
  for (const int index : action.on.cloths) {
    const ClothMesh& cloth = cloths_[index];
    const double share = 1.0 / static_cast<double>(cloth.bodies().size());
    for (const int id : cloth.bodies())
      if (system_.isThere(id)) system_.applyImpulse(id, system_.position(id), share * action.value);
  }
  for (const auto [index, node] : action.on.nodes)
    if (const int id = cloths_[index].body(node); system_.isThere(id))
      system_.applyImpulse(id, system_.position(id), action.value);
}

void RigidStage::pull(const PullAction& action, double time) {
  const auto from = anchorOf(action.from);
  if (!from) return;
  SpringDef spring;
  spring.from = *from;
  spring.to = {-1, {action.to[0](0, 0, time), action.to[1](0, 0, time)}};
  spring.length = action.length;
  spring.stiffness = action.stiffness;
  spring.damping = action.damping;
  pulls_.push_back({action, system_.addSpring(spring), time + action.duration});
}

void RigidStage::hold(const HoldAction& action) {
  for (const int index : action.what.bodies) {
    hold(bodies_[index].id, action.held);
    std::erase(held_, index);  // the event has the last word
  }
  for (const int index : action.what.cloths)
    for (const int id : cloths_[index].bodies()) hold(id, action.held);
  for (const auto [index, node] : action.what.nodes) hold(cloths_[index].body(node), action.held);
}

void RigidStage::hold(int id, bool held) {
  if (!system_.isThere(id)) return;
  if (held)
    system_.hold(id);
  else
    system_.release(id);
}

void RigidStage::remove(const RemoveAction& action) {
  for (const int index : action.what.bodies)
    if (isThere(bodies_[index])) system_.remove(bodies_[index].id);
  for (const auto [index, node] : action.what.nodes)
    if (const int id = cloths_[index].body(node); system_.isThere(id)) system_.remove(id);
  for (const int index : action.what.cloths) {
    cloths_[index].remove(system_);
    clothIsThere_[index] = 0;
  }
}

void RigidStage::add(const AddAction& action, int event) {
  const int times = added_[event]++;
  for (int k = 0; k < action.count; ++k) {
    const std::size_t index = action.first + times * action.count + k;
    if (index < bodies_.size() && bodies_[index].id < 0) addBody(bodies_[index]);
  }
}

void RigidStage::cut(const CutAction& action) {
  for (const int spring : action.springs)
    if (system_.springIsThere(springs_[spring])) system_.removeSpring(springs_[spring]);
  for (const int joint : action.joints)
    if (system_.jointIsThere(joints_[joint])) system_.removeJoint(joints_[joint]);
}

void RigidStage::setShown(const std::string& name, bool shown) {
  for (Body& body : bodies_)
    if (body.spec.family == name || body.spec.name == name) body.shown = shown;
  for (ClothMesh& cloth : cloths_)
    if (cloth.spec().name == name) cloth.shown = shown;
}

void RigidStage::adopt(const SceneSpec& spec, const std::string& path) {
  const std::vector<std::string> steps = pathSteps(path);
  if (steps[0] == "gravity") system_.setGravity(spec.gravity);
  for (int side = 0; steps[0] == "walls" && side < 4; ++side)
    system_.setWallSpeed(side, wallSpeed(spec.domain, side));
  for (std::size_t k = 0; steps[0] == "solids" && k < solids_.size(); ++k)
    system_.setSurface(solids_[k].id, spec.solids[k].bounce, spec.solids[k].friction);
  if (steps.size() < 3) return;
  adoptLinks(spec, steps);
  const bool particles = steps[0] == "particles";
  if (particles || steps[0] == "bodies")
    for (std::size_t k = 0; k < spec.bodies.size(); ++k) {
      const BodySpec& now = spec.bodies[k];
      if (now.particle == particles && !now.later && isStep(steps[1], now.family, now.item))
        adoptBody(bodies_[k], now, steps[2]);
    }
  for (std::size_t k = 0; steps[0] == "cloth" && k < cloths_.size(); ++k)
    if (isStep(steps[1], spec.cloths[k].name, static_cast<int>(k))) cloths_[k].setColor(spec.cloths[k].color);
}

void RigidStage::adoptBody(Body& body, const BodySpec& now, const std::string& key) {
  body.spec = now;
  if (!isThere(body)) return;
  const int id = body.id;
  if (key == "velocity") system_.setVelocity(id, now.velocity);
  if (key == "spin") system_.setSpin(id, now.spinRad);
  if (key == "mass" || key == "density") system_.setMass(id, massOf(body), inertiaOf(body));
  if (key == "bounce" || key == "friction") system_.setSurface(id, now.bounce, now.friction);
  if (key == "linear_damping" || key == "angular_damping")
    system_.setDamping(id, now.linearDamping, now.angularDamping);
  if (key == "gravity_scale") system_.setGravityScale(id, now.gravityScale);
}

void RigidStage::adoptLinks(const SceneSpec& spec, const std::vector<std::string>& steps) {
  for (std::size_t k = 0; steps[0] == "springs" && k < springs_.size(); ++k) {
    const SpringSpec& now = spec.springs[k];
    if (!isStep(steps[1], now.name, static_cast<int>(k))) continue;
    springColors_[k] = now.color;
    if (!system_.springIsThere(springs_[k])) continue;
    const double length = now.length.value_or(system_.spring(springs_[k]).length);
    system_.setSpring(springs_[k], length, now.stiffness, now.damping);
  }
  for (std::size_t k = 0; steps[0] == "joints" && k < joints_.size(); ++k) {
    const JointSpec& now = spec.joints[k];
    if (isStep(steps[1], now.name, static_cast<int>(k)) && system_.jointIsThere(joints_[k]))
      system_.setMotor(joints_[k], now.motorSpeed, now.motorLimit);
  }
}

}  // namespace smokebox
