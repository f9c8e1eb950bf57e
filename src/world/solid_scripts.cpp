#include "world/solid_scripts.h"

#include <cmath>
#include <utility>

namespace smokebox {

namespace {
constexpr double kLeastTurn = 1.0 / (1LL << 44);  // rad

double whole(double value, double quantum) { return std::nearbyint(value / quantum) * quantum; }
}  // namespace

SolidScripts::SolidScripts(const std::vector<SolidSpec>& specs, double tolerance)
    : leastMove_(std::ldexp(tolerance, -24)) {
  scripts_.reserve(specs.size());
  moving_.resize(specs.size());
  for (int k = 0; k < static_cast<int>(specs.size()); ++k) {
    Script script;
    script.spec = specs[k];
    script.local = outlinesOf({specs[k].shape.shape, Pose{}}, tolerance);
    script.mass = massProperties(script.local);
    script.rest = specs[k].shape.pose;
    script.pose = script.start = specs[k].motion.poseAt(0, script.rest);
    scripts_.push_back(std::move(script));
    moving_[k].outlines.resize(scripts_[k].local.size());
    moving_[k].drag = specs[k].drag;
    place(k, scripts_[k].pose);
  }
}

void SolidScripts::place(int solid, const Pose& pose) {
  Script& script = scripts_[solid];
  MovingSolid& moving = moving_[solid];
  script.pose = pose;
  moving.origin = pose.position;
  for (std::size_t k = 0; k < script.local.size(); ++k)
    moving.outlines[k] = transformed(script.local[k], pose);
}

void SolidScripts::move(double time, double dt) {
  shapesMoved_ = false;
  for (int k = 0; k < count(); ++k) {
    Script& script = scripts_[k];
    MovingSolid& moving = moving_[k];
    moving.velocity = {};
    moving.spin = 0;
    if (script.stopped || script.spec.motion.isStill()) continue;
    const Pose next = script.spec.motion.poseAt(time + dt - script.since, script.rest);
    if (next == script.pose) continue;
    // Less is the rounding of positions, which differs from mirror image to mirror image.
    const Vec2 by = next.position - script.pose.position;
    moving.velocity = (1 / dt) * Vec2{whole(by.x, leastMove_), whole(by.y, leastMove_)};
    moving.spin = whole(next.angleRad - script.pose.angleRad, kLeastTurn) / dt;
    place(k, next);
    shapesMoved_ = true;
  }
}

void SolidScripts::adopt(const std::vector<SolidSpec>& specs) {
  for (int k = 0; k < count(); ++k) {
    scripts_[k].spec.drag = moving_[k].drag = specs[k].drag;
    scripts_[k].spec.color = specs[k].color;
    scripts_[k].spec.motion = specs[k].motion;
  }
}

void SolidScripts::motionReplaced(int solid, double time) {
  Script& script = scripts_[solid];
  script.stopped = false;
  if (!script.spec.motion.isSteady()) {
    script.rest = script.spec.shape.pose;
    script.since = 0;
    return;
  }
  script.rest = script.pose;
  script.since = time;
}

void SolidScripts::stop(int solid) { scripts_[solid].stopped = true; }

int SolidScripts::find(const std::string& name) const {
  for (int k = 0; k < count(); ++k)
    if (scripts_[k].spec.name == name) return k;
  return -1;
}

bool SolidScripts::anyCanMove() const {
  for (const Script& script : scripts_)
    if (!script.spec.motion.isStill()) return true;
  return false;
}

}  // namespace smokebox
