// Triangles of a region by its own corners: ear clipping (Meisters 1975), holes joined to their surroundings
// by bridges (Eberly 2002). Reflex corners lie in a grid: nearly linear time for most outlines, O(n^2) at
// worst.
#pragma once
#include <array>
#include <vector>

#include "geometry/shape.h"

namespace smokebox {

/// `points`: corners of all outlines of the region, one after the other; ends[k]: one past the last corner of
/// outline k. Outer outlines run counterclockwise, holes clockwise. Triangles are counterclockwise triples of
/// corners.
std::vector<std::array<int, 3>> triangulate(const std::vector<Vec2>& points, const std::vector<int>& ends);

}  // namespace smokebox
