// Where a scripted solid is at a time: fixed, constant velocity and spin, keyframes, or expressions of t.
//
// Between two keyframes a solid moves in a straight line; `smooth` eases the time, s -> s^2 (3 - 2 s), so
// that the velocity is continuous and zero at every key. It stands still before the first key and after the
// last; `repeat` starts over from the first key instead (the jump back is the scene's own if the two poses
// differ).
#pragma once
#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "geometry/shape.h"
#include "scene/expression.h"

namespace smokebox {

struct Keyframe {
  double at = 0;
  Pose pose;  // complete: what the file leaves out is held from the keyframe before
};

class MotionScript {
 public:
  struct Steady {
    Vec2 velocity;
    double spinRad = 0;
  };  // m/s, rad/s
  struct Keyframes {
    std::vector<Keyframe> frames;
    bool smooth = false, repeat = false;
  };
  struct Formula {
    std::optional<Expression> x, y, angleDegrees;
  };  // of t; what is left out is held

  MotionScript() = default;  // stands still
  explicit MotionScript(Steady steady) : how_(steady) {}
  explicit MotionScript(Keyframes keyframes) : how_(std::move(keyframes)) {}
  explicit MotionScript(Formula formula) : how_(std::move(formula)) {}

  /// The absolute pose at time t of a solid whose pose at rest (position and angle of the file) is `rest`.
  Pose poseAt(double t, const Pose& rest) const;
  bool isStill() const { return std::holds_alternative<std::monostate>(how_); }
  bool isSteady() const { return std::holds_alternative<Steady>(how_); }

 private:
  std::variant<std::monostate, Steady, Keyframes, Formula> how_;
};

}  // namespace smokebox
