// The pressure on a surface, from the cells on its fluid side: the plane that fits the nearest of them best
// (weighted least squares), so exact for linear pressure. Only cells that open faces join to the nearest one
// count, so what lies behind a thin wall has no say.
#pragma once
#include "fluid/boundary.h"

namespace smokebox {

struct PressurePlane {
  bool known = false;  // false: no fluid near
  Vec2 place;
  double value = 0;  // Pa, at `place`
  Vec2 slope;        // Pa/m
  double at(Vec2 p) const { return value + dot(slope, p - place); }
};

/// `outwards`: unit normal of the surface at `place`, into the fluid.
PressurePlane pressureNear(const Boundary& boundary, const Field& pressure, Vec2 place, Vec2 outwards);

}  // namespace smokebox
