// Follows a straight edge from cell to cell. The path is a chain of cells that share faces, whatever the
// rounding: a closed outline gives a closed chain, so that what lies inside and what outside never
// contradicts itself from one grid line to the next. A point on a grid line belongs to the cell on its upper
// or right side.
//
// Cells are counted from -1 (everything left of or below the grid) to nx, ny (everything beyond it).
#pragma once
#include <algorithm>

#include "geometry/grid.h"

namespace smokebox {

class GridWalk {
 public:
  explicit GridWalk(const Grid& grid) : grid_(grid), perMetre_(1 / grid.h) {}

  int column(double x) const { return index(x, grid_.nx); }
  int row(double y) const { return index(y, grid_.ny); }

  /// Where the edge meets the line x = `x`; the same for the edge run backwards.
  static double heightAt(Vec2 a, Vec2 b, double x) {
    if (b.x < a.x) std::swap(a, b);
    return std::clamp(a.y + (x - a.x) / (b.x - a.x) * (b.y - a.y), std::min(a.y, b.y), std::max(a.y, b.y));
  }
  static double acrossAt(Vec2 a, Vec2 b, double y) { return heightAt({a.y, a.x}, {b.y, b.x}, y); }

  /// From a, in cell (i, j), to b; leaves (i, j) at the cell of b. At each face on the way, before (i, j)
  /// moves on, calls
  ///   crossed(vertical, line, point, forward)
  /// vertical: the face lies on x = line * h (else y = line * h); forward: towards larger x (y).
  template <class Crossed>
  void edge(Vec2 a, Vec2 b, int& i, int& j, Crossed&& crossed) const {
    const int iEnd = column(b.x), jEnd = row(b.y);
    if (i == iEnd && j == jEnd) return;
    const int di = iEnd > i ? 1 : -1, dj = jEnd > j ? 1 : -1;
    const double dx = b.x - a.x, dy = b.y - a.y;
    while (i != iEnd || j != jEnd) {
      const int lineX = di > 0 ? i + 1 : i, lineY = dj > 0 ? j + 1 : j;
      const double x = lineX * grid_.h, y = lineY * grid_.h;
      // Compares (x - a.x) / dx with (y - a.y) / dy.
      const bool vertical =
          j == jEnd || (i != iEnd && di * (x - a.x) * (dj * dy) <= dj * (y - a.y) * (di * dx));
      if (vertical) {
        crossed(true, lineX, Vec2{x, intoCell(heightAt(a, b, x), j, grid_.ny)}, di > 0);
        i += di;
      } else {
        crossed(false, lineY, Vec2{intoCell(acrossAt(a, b, y), i, grid_.nx), y}, dj > 0);
        j += dj;
      }
    }
  }

 private:
  int index(double x, int n) const {
    const double scaled = x * perMetre_;
    if (!(scaled >= 0)) return -1;
    return scaled < n ? static_cast<int>(scaled) : n;
  }
  /// Against rounding: the point is on the face that is crossed.
  double intoCell(double s, int k, int n) const {
    const double lo = k * grid_.h, hi = (k + 1) * grid_.h;
    if (k < 0) return std::min(s, hi);
    return k >= n ? std::max(s, lo) : std::clamp(s, lo, hi);
  }

  Grid grid_;
  double perMetre_;
};

}  // namespace smokebox
