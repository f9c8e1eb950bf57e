// Outlines made fit for cutting: without corners that are none, and parted where they touch in a corner.
#pragma once
#include <vector>

#include "geometry/shape.h"

namespace smokebox {

/// Larger side of the box around all outlines.
double extentOf(const std::vector<Outline>& outlines);

/// Without doubled corners, spikes, and corners that do not turn (sine below 1e-9). Corners of all outlines
/// that are within 1e-8 of the extent of each other become one point; there each edge goes on to the one that
/// keeps the region's sectors apart, so that no outline passes through the region: two parts that meet in a
/// corner become two outlines, and a hole that meets the outside becomes a part of it.
std::vector<Outline> cleanOutlines(const std::vector<Outline>& outlines);

}  // namespace smokebox
