// Puts the corners of a union of polygons, which was found on a grid of integers, where they are: on a corner
// of the polygons, or where edges of theirs cross. A polygon and its mirror image then have mirrored unions
// but for the rounding of float64; on the grid of integers they part by about its spacing.
//
// A corner is one of the polygons' if one of them is within a spacing; else it is the point nearest to the
// lines of all edges within two (least squares: of two edges, their crossing; of several that meet there, all
// count alike; of parallel ones, the foot on them). What collapses is dropped.
#pragma once
#include <vector>

#include "geometry/shape.h"

namespace smokebox {

/// Around some points.
struct OutlineBox {
  Vec2 lo{1e300, 1e300}, hi{-1e300, -1e300};
  bool reaches(Vec2 p, double within) const {
    return p.x >= lo.x - within && p.x <= hi.x + within && p.y >= lo.y - within && p.y <= hi.y + within;
  }
};
OutlineBox boxOf(const Outline& outline);

/// `spacing`: of the grid of integers, m. `outlines` is the union of `originals`, found on that grid.
void snapOutlines(const std::vector<Outline>& originals, double spacing, std::vector<Outline>& outlines);

}  // namespace smokebox
