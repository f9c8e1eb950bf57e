// How the cells of a grid hang together, for the work on lists of cut cells: cells are numbered c = j nx + i,
// their faces 0 left, 1 right, 2 lower, 3 upper.
#pragma once
#include "fluid/boundary.h"

namespace smokebox {

struct SmokeCells {
  int nx = 0, ny = 0;
  bool periodicX = false, periodicY = false;

  explicit SmokeCells(const Boundary& b)
      : nx(b.grid.nx), ny(b.grid.ny), periodicX(b.periodicX()), periodicY(b.periodicY()) {}

  std::size_t count() const { return static_cast<std::size_t>(nx) * ny; }
  int i(int cell) const { return cell % nx; }
  int j(int cell) const { return cell / nx; }
  int cell(int i, int j) const { return j * nx + i; }

  /// The cell behind a face; -1 beyond a side that is not periodic.
  int neighbour(int cell, int face) const { return neighbour(i(cell), j(cell), face); }
  int neighbour(int x, int y, int face) const {
    switch (face) {
      case 0:
        if (--x < 0) x = periodicX ? nx - 1 : -1;
        break;
      case 1:
        if (++x == nx) x = periodicX ? 0 : -1;
        break;
      case 2:
        if (--y < 0) y = periodicY ? ny - 1 : -1;
        break;
      default:
        if (++y == ny) y = periodicY ? 0 : -1;
    }
    return x < 0 || y < 0 ? -1 : y * nx + x;
  }

  /// A quantity of that face, kept in one field for x-faces and one for y-faces.
  template <class F>
  static decltype(auto) atFace(F& x, F& y, int i, int j, int face) {
    switch (face) {
      case 0:
        return x(i, j);
      case 1:
        return x(i + 1, j);
      case 2:
        return y(i, j);
      default:
        return y(i, j + 1);
    }
  }
  template <class F>
  decltype(auto) atFace(F& x, F& y, int cell, int face) const {
    return atFace(x, y, i(cell), j(cell), face);
  }
};

/// 1 for faces through which a positive flow leaves the cell, -1 for the others.
constexpr float outwards(int face) { return face & 1 ? 1.0f : -1.0f; }

}  // namespace smokebox
