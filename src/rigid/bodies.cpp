#include "rigid/bodies.h"

namespace smokebox {

Extent extentOf(const BodyShape& shape) {
  Extent extent;
  extent.reach = shape.reach;
  extent.thinnest = shape.thinnest;
  if (!shape.tree.nodes().empty()) {
    extent.centre = shape.tree.nodes()[0].centre;
    extent.half = shape.tree.nodes()[0].half;
  }
  const ConvexPiece& first = shape.pieces[0];
  if (shape.pieces.size() == 1) extent.only = &first;
  if (extent.only && first.points.size() == 1) {
    extent.centre = first.points[0];
    extent.radius = first.radius;
  }
  return extent;
}

}  // namespace smokebox
