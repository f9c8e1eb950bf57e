#include "scene/places.h"

#include <algorithm>

namespace smokebox {

Vec2 centreOfMass(const Shape& shape) {
  if (!std::holds_alternative<PolygonShape>(shape) && !std::holds_alternative<UnionShape>(shape)) return {};
  constexpr double kFine = 1e-3;  // of its size: only unions of curves depend on it
  const std::vector<Outline> rough = outlinesOf({shape, {}}, 1e9);
  double size = 0;
  for (const Outline& outline : rough)
    for (const Vec2 p : outline) size = std::max(size, length(p - rough[0][0]));
  return massProperties(outlinesOf({shape, {}}, kFine * size)).centre;
}

Vec2 placeAtStart(const SceneSpec& spec, const HoldSpec& hold) {
  auto onShape = [&](const Shape& shape, const Pose& pose) {
    return transformed(hold.at ? *hold.at : centreOfMass(shape), pose);
  };
  switch (hold.of) {
    case HoldSpec::Of::body:
      return onShape(*spec.bodies[hold.index].shape, spec.bodies[hold.index].pose);
    case HoldSpec::Of::solid: {
      const SolidSpec& solid = spec.solids[hold.index];
      return onShape(solid.shape.shape, solid.motion.poseAt(0, solid.shape.pose));
    }
    case HoldSpec::Of::cloth:
      return spec.cloths[hold.index].nodeAt(hold.node);
    case HoldSpec::Of::world:
      break;
  }
  return hold.at.value_or(Vec2{});
}

}  // namespace smokebox
