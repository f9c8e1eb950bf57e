// Where things of a scene are at the start.
#pragma once
#include "scene/spec.h"

namespace smokebox {

/// Centre of mass in the shape's own coordinates.
Vec2 centreOfMass(const Shape& shape);

/// May it move by itself (a body, a particle, part of a cloth)?
inline bool canMove(const HoldSpec& hold) {
  return hold.of == HoldSpec::Of::body || hold.of == HoldSpec::Of::cloth;
}

/// The point that is held, in the world, at time 0; of a body without `at` its centre of mass.
Vec2 placeAtStart(const SceneSpec& spec, const HoldSpec& hold);

}  // namespace smokebox
