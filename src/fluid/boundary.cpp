#include "fluid/boundary.h"

namespace smokebox {

void fillRim(const Boundary& boundary, Field& cells) {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  const bool wrapX = boundary.periodicX(), wrapY = boundary.periodicY();
  for (int j = 0; j < ny; ++j) {
    cells(-1, j) = cells(wrapX ? nx - 1 : 0, j);
    cells(nx, j) = cells(wrapX ? 0 : nx - 1, j);
  }
  for (int i = -1; i <= nx; ++i) {
    cells(i, -1) = cells(i, wrapY ? ny - 1 : 0);
    cells(i, ny) = cells(i, wrapY ? 0 : ny - 1);
  }
}

}  // namespace smokebox
