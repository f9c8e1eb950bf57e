#include "scene/motion.h"

#include <algorithm>
#include <cmath>

#include "base/maths.h"

namespace smokebox {
namespace {

Pose between(const Pose& a, const Pose& b, double share) {
  return {a.position + share * (b.position - a.position), a.angleRad + share * (b.angleRad - a.angleRad)};
}

Pose keyframed(const MotionScript::Keyframes& motion, double t) {
  const std::vector<Keyframe>& frames = motion.frames;
  const double first = frames.front().at, last = frames.back().at;
  if (motion.repeat && t > first && last > first)
    t = first + std::fmod(t - first, last - first);  // fmod is exact
  if (t <= first) return frames.front().pose;
  if (t >= last) return frames.back().pose;
  const auto next = std::upper_bound(frames.begin(), frames.end(), t,
                                     [](double time, const Keyframe& frame) { return time < frame.at; });
  const Keyframe &a = next[-1], &b = *next;
  double share = (t - a.at) / (b.at - a.at);
  if (motion.smooth) share = share * share * (3 - 2 * share);
  return between(a.pose, b.pose, share);
}

}  // namespace

Pose MotionScript::poseAt(double t, const Pose& rest) const {
  if (const auto* steady = std::get_if<Steady>(&how_))
    return {rest.position + t * steady->velocity, rest.angleRad + t * steady->spinRad};
  if (const auto* keyframes = std::get_if<Keyframes>(&how_))
    return keyframes->frames.empty() ? rest : keyframed(*keyframes, t);
  if (const auto* formula = std::get_if<Formula>(&how_)) {
    Pose pose = rest;
    if (formula->x) pose.position.x = (*formula->x)(0, 0, t);
    if (formula->y) pose.position.y = (*formula->y)(0, 0, t);
    if (formula->angleDegrees) pose.angleRad = radians((*formula->angleDegrees)(0, 0, t));
    return pose;
  }
  return rest;
}

}  // namespace smokebox
