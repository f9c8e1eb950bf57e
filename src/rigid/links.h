// What joins bodies to one another or to the world: springs and joints, as they are asked for.
#pragma once
#include <limits>

#include "geometry/vec2.h"

namespace smokebox {

/// A point of a body, in its own coordinates from the centre of mass, or a point of the world (body -1), m.
struct Anchor {
  int body = -1;
  Vec2 at;
};

/// Force along the line between the anchors: stiffness (distance - length) + damping (rate of the distance).
/// With slack it pulls when it is longer than `length`, pushes when it is shorter than length - slack (by the
/// stiffness times what is missing to that), and does nothing between: a string has all its length as slack.
struct SpringDef {
  Anchor from, to;
  double length = 0;     // at rest, m
  double stiffness = 0;  // N/m, 0 or more
  double damping = 0;    // N s/m, 0 or more
  double slack = 0;      // m, 0 or more
  /// Breaks at a step's end when the distance is over (1 + tear) length.
  double tear = std::numeric_limits<double>::infinity();
};

enum class JointKind { pin, weld, slide, rope };

/// - pin: the anchors coincide; turns freely between `lower` and `upper` (angle of b less that of a, less
///   that at the start, rad); the motor turns b against a at `motorSpeed` rad/s with at most `motorLimit` N
///   m.
/// - weld: the anchors coincide, and the angle between the bodies stays as it was at the start.
/// - slide: b's anchor stays on the line through a's anchor along `axis` (in a's own coordinates; the world's
///   if a is the world), the angle stays; `lower` and `upper` bound the way along it, m; the motor moves b at
///   `motorSpeed` m/s with at most `motorLimit` N.
/// - rope: the anchors are never farther apart than `length`, m.
/// Bodies that a pin, weld or slide joins pass through each other.
struct JointDef {
  JointKind kind = JointKind::pin;
  Anchor a, b;
  Vec2 axis{1, 0};
  double length = 0;
  double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
  double motorSpeed = 0, motorLimit = 0;  // no motor while the limit is 0
};

}  // namespace smokebox
