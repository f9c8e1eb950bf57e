// The line that shows how a body has turned: a spoke from its centre of mass to its outline along its own x
// axis. Where that cannot be seen (a hook around its centre of mass, a thin part there), the longest line
// across the body in that direction.
#pragma once
#include <optional>

#include "geometry/shape.h"

namespace smokebox {

/// In the coordinates of the outlines. It begins inside, and ends on an outline.
struct BodyMark {
  Vec2 from, to;
};

/// `pose`: of the centre of mass. Nothing for a body without an area.
std::optional<BodyMark> markOf(const std::vector<Outline>& outlines, const Pose& pose);

}  // namespace smokebox
