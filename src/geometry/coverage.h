// Exact coverage of a grid by polygons: which parts of the grid's lines lie inside solids, how much of each
// cell is open, and which faces must be shut because a wall thinner than a cell parts the cells on its two
// sides.
#pragma once
#include <vector>

#include "base/field.h"
#include "geometry/grid.h"
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
  std::vector<Outline> outlines;  // world coordinates
};

struct GridCover {
  /// Lines y = k h/2, k = 0..2 ny (along x), and x = k h/2, k = 0..2 nx (along y).
  std::vector<LineCover> alongX, alongY;
  /// Open share of faces (0..1) and of cells; shares under 1e-3 are 0, over 1 - 1e-3 of a face are 1.
  Field openX, openY, volume;
};

/// Reuses the memory of `cover`. Solids may overlap, touch, be thinner than a cell, and stick out of the
/// grid.
void coverGrid(const Grid& grid, const std::vector<SolidOutline>& solids, GridCover& cover);

/// Share of each cell's area inside one placed shape (sources, bursts, probes), into `share` (0..1); exact.
void coverShare(const Grid& grid, const std::vector<Outline>& outlines, Field& share);

}  // namespace smokebox
