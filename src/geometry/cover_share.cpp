// The area of polygons in each cell, by the integral of (distance to the right side of the cell) dy along the
// outlines: what an edge contributes to its own cell, and to all cells of the row to its right.
#include <algorithm>
#include <cmath>

#include "geometry/coverage.h"
#include "geometry/grid_walk.h"

namespace smokebox {
namespace {

struct CellRange {
  int iLo, iHi, jLo, jHi;  // last ones included; i from -1
  int columns() const { return iHi - iLo + 1; }
};

CellRange rangeOf(const Grid& grid, const GridWalk& walk, const std::vector<Outline>& outlines) {
  CellRange range{grid.nx, -1, grid.ny, -1};
  for (const Outline& outline : outlines)
    for (Vec2 p : outline) {
      range.iLo = std::min(range.iLo, walk.column(p.x));
      range.iHi = std::max(range.iHi, walk.column(p.x));
      range.jLo = std::min(range.jLo, walk.row(p.y));
      range.jHi = std::max(range.jHi, walk.row(p.y));
    }
  range.jLo = std::max(range.jLo, 0);
  range.jHi = std::min(range.jHi, grid.ny - 1);
  return range;
}

}  // namespace

void coverShare(const Grid& grid, const std::vector<Outline>& outlines, Field& share) {
  if (share.nx() != grid.nx || share.ny() != grid.ny)
    share = Field(grid.nx, grid.ny);
  else
    share.fill(0);
  const GridWalk walk(grid);
  const CellRange range = rangeOf(grid, walk, outlines);
  if (range.jLo > range.jHi || range.iLo > range.iHi) return;
  const std::size_t count = static_cast<std::size_t>(range.columns()) * (range.jHi - range.jLo + 1);
  std::vector<double> own(count, 0), right(count, 0);  // in cells

  auto add = [&](int i, int j, Vec2 a, Vec2 b) {
    if (j < range.jLo || j > range.jHi || i >= grid.nx) return;
    const std::size_t k = static_cast<std::size_t>(j - range.jLo) * range.columns() + (i - range.iLo);
    const double dy = (b.y - a.y) / grid.h;
    right[k] -= dy;  // an outline that runs downwards has the solid on its right
    if (i >= 0) own[k] -= dy * ((i + 1) - (a.x + b.x) / (2 * grid.h));
  };
  for (const Outline& outline : outlines)
    for (std::size_t e = 0; e < outline.size(); ++e) {
      Vec2 from = outline[e];
      const Vec2 to = outline[e + 1 < outline.size() ? e + 1 : 0];
      int i = walk.column(from.x), j = walk.row(from.y);
      walk.edge(from, to, i, j, [&](bool, int, Vec2 point, bool) {
        add(i, j, from, point);
        from = point;
      });
      add(i, j, from, to);
    }
  for (int j = range.jLo; j <= range.jHi; ++j) {
    double covered = 0;
    for (int i = range.iLo; i <= range.iHi && i < grid.nx; ++i) {
      const std::size_t k = static_cast<std::size_t>(j - range.jLo) * range.columns() + (i - range.iLo);
      if (i >= 0) {
        const double inside = std::clamp(std::fabs(covered + own[k]), 0.0, 1.0);  // either orientation
        share(i, j) = inside < 1e-9 ? 0.0f : static_cast<float>(inside);
      }
      covered += right[k];
    }
  }
}

}  // namespace smokebox
