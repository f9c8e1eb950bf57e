// Exact coverage of a grid by polygons: which parts of the grid's lines lie inside solids, how much of each
// cell is open, and which faces must be shut because a wall thinner than a cell parts the cells on its two
// sides.
//
// The outlines are followed from cell to cell (grid_walk.h), as a scan converter does, so the work is
// proportional to their length in cells. Solids whose boxes overlap are merged first. Every outline is grown
// by 1e-6 h: what touches a grid line, the side of the domain or another solid then overlaps it, whatever the
// rounding.
//
// A thin wall never leaks: where outlines part the fluid of a cell into several pieces, the cell keeps the
// largest (of two that are each other's mirror image about the middle of the grid: none); the parts of its
// faces that lead to the others only are shut. So every pair of open faces of a
// cell is joined by fluid inside it, and a chain of open faces is a way through the true geometry.
#pragma once
#include <vector>

#include "base/field.h"
#include "geometry/cover_work.h"
#include "geometry/grid.h"
#include "geometry/region_map.h"
#include "geometry/shape.h"

namespace smokebox {

/// A piece of a line that lies inside solids. `solidLo`, `solidHi`: whose surface ends it; `solidLo` also
/// stands for the solid that covers it where several overlap.
struct CoveredInterval {
  double lo = 0, hi = 0;  // metres along the line
  int solidLo = -1, solidHi = -1;
};
using LineCover = std::vector<CoveredInterval>;  // sorted, disjoint

/// The outlines of one solid at one moment.
struct SolidOutline {
  std::vector<Outline>
      outlines;  // world coordinates; they do not overlap (outlinesOf a shape merges its parts)
};

struct GridCover {
  /// Lines y = k h/2, k = 0..2 ny (along x), and x = k h/2, k = 0..2 nx (along y).
  std::vector<LineCover> alongX, alongY;
  /// Open share of faces (0..1) and of cells; shares of faces under 1e-3 are 0, over 1 - 1e-3 are 1. Margins:
  /// 0.
  Field openX, openY, volume;
  /// Sorted by kind (x first), j, i, lo; disjoint, or the same stretch.
  std::vector<ShutPart> shut;
  /// The regions that the solids part from each other.
  RegionMap regions;
  CoverWork work;
};

/// Which opposite sides of the grid are joined: their faces are the same. Solids that cross such a side must
/// be given once more on the other.
struct JoinedSides {
  bool x = false, y = false;
};

/// Reuses the memory of `cover`. Solids may overlap, touch, be thinner than a cell, and stick out of the
/// grid. Outer outlines are counterclockwise, holes clockwise.
void coverGrid(const Grid& grid, const std::vector<SolidOutline>& solids, GridCover& cover,
               JoinedSides joined = {});

/// Share of each cell's area inside one placed shape (sources, bursts, probes), into `share` (0..1); exact.
/// Outlines must not overlap.
void coverShare(const Grid& grid, const std::vector<Outline>& outlines, Field& share);

}  // namespace smokebox
