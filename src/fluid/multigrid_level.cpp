#include "fluid/multigrid_level.h"

#include <algorithm>

namespace smokebox::multigrid {

namespace {

template <class V>
std::size_t bytesOf(const V& v) {
  return v.capacity() * sizeof(typename V::value_type);
}

}  // namespace

void Level::wrapRows(Floats& f) const {
  if (!periodicY) return;
  std::copy_n(row(f, ny - 1) - 1, nx + 2, row(f, -1) - 1);
  std::copy_n(row(f, 0) - 1, nx + 2, row(f, ny) - 1);
}

void Level::shape(int columns, int rows, bool wrapX, bool wrapY, bool wholeResidual) {
  nx = columns;
  ny = rows;
  periodicX = wrapX;
  periodicY = wrapY;
  chunks = (nx + kLanes - 1) / kLanes;
  stride = static_cast<std::ptrdiff_t>(chunks) * kLanes + kLanes;
  if (stride % 1024 == 0) stride += kLanes;  // columns must not share a handful of cache sets
  origin = stride + kLanes;
  extrasBegin = origin + (ny + 2) * stride;
  extras = 0;

  x.assign(extrasBegin, 0);
  b.assign(extrasBegin, 0);
  ax.assign(extrasBegin, 0);
  ay.assign(extrasBegin, 0);
  id.assign(extrasBegin, 0);
  chunk.assign(static_cast<std::size_t>(ny) * chunks, 0);
  runBegin.assign(ny + 1, 0);
  bandBegin.assign(ny + 1, 0);
  const std::size_t cells = static_cast<std::size_t>(nx) * ny;
  part.assign(cells, 0);
  sideCells.assign(2 * ny, {});
  rowKind.assign(ny, 0);
  middlePairs.assign(ny, {});
  seamPairs.assign(ny, {});
  specialBegin.assign(2 * ny + 1, 0);
  specialPairBegin.assign(2 * ny + 1, 0);
  prolongBegin.assign(ny + 1, 0);

  middle.assign((periodicY ? 6 : 3) * (nx + 2 + kLanes), 0);
  joinX = Joining(nx);
  joinY = Joining(ny);
  residualRows = wholeResidual ? ny : std::min(ny, ny % 2 == 0 ? 2 : 3);
  residualStride = (chunks + 1) / 2 * 2 * kLanes;
  residual.assign(residualRows * residualStride + 2 * kLanes,
                  0);  // rows are read from a cell before, or after
  bandCells.assign(nx % kLanes == 0 || nx < kLanes ? 0 : chunk.size(), 0);
}

std::size_t Level::bytes() const {
  return bytesOf(x) + bytesOf(b) + bytesOf(ax) + bytesOf(ay) + bytesOf(id) + bytesOf(chunk) + bytesOf(runs) +
         bytesOf(bandRuns) + bytesOf(sideCells) + bytesOf(rowKind) + bytesOf(middlePairs) +
         bytesOf(seamPairs) + bytesOf(extraBase) + bytesOf(extraCell) + bytesOf(specialBegin) +
         bytesOf(specialAt) + bytesOf(specialCell) + bytesOf(specialInverse) + bytesOf(specialValue) +
         bytesOf(specialShare) + bytesOf(specialPairs) + bytesOf(specialPairBegin) + bytesOf(star) +
         bytesOf(starred) + bytesOf(bandCells) + bytesOf(entryBegin) + bytesOf(entries) + bytesOf(part) +
         bytesOf(prolongBegin) + bytesOf(prolong) + bytesOf(splitBegin) + bytesOf(split) + bytesOf(child) +
         bytesOf(residual) + bytesOf(residualExtra) + bytesOf(middle);
}

}  // namespace smokebox::multigrid
