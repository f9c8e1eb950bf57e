// The union of polygons, on a grid of integers fine enough not to matter (Vatti 1992, by the Clipper
// library).
#pragma once
#include <vector>

#include "geometry/shape.h"

namespace smokebox {

/// Every edge moved outwards (to the right of its direction) by `distance` metres, corners mitred. For
/// distances far smaller than the edges: nothing is done about edges that vanish.
void growOutline(const Outline& outline, double distance, Outline& grown);

/// Outlines of the union. What is nearer to each other than about `near` metres (never less than 2^-40 of the
/// extent) may become one; else corners are where they are (snap_outlines.h). Outer outlines come out
/// counterclockwise, holes clockwise.
std::vector<Outline> unionOfOutlines(const std::vector<Outline>& outlines, double near);

}  // namespace smokebox
