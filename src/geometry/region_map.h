// Which cells' fluid hangs together in the true geometry: regions that solids part from each other, however
// thin these are. Joined are the parts into which outlines cut the cells (cell_parts.h) through every opening
// of the faces between them, also through those that the grid shuts because a cell keeps only its largest
// part. So a cell belongs to the region in which the part that it keeps lies, even if all its faces are shut.
//
// Rows of cells without outlines are joined as runs: the work is proportional to the rows and the cut cells.
#pragma once
#include <vector>

#include "geometry/grid.h"

namespace smokebox {

struct GridCover;
struct JoinedSides;

struct RegionMap {
  struct Run {
    int begin = 0, end = 0;  // cells begin <= i < end of one row
    int region = 0;          // 0 .. count - 1
  };
  std::vector<Run> runs;      // of the open cells, by row, then column
  std::vector<int> rowStart;  // ny + 1; empty if nobody has told the regions apart
  int count = 0;

  const Run* begin(int j) const { return runs.data() + rowStart[j]; }
  const Run* end(int j) const { return runs.data() + rowStart[j + 1]; }
  /// The region of an open cell; -1 in closed cells and in an empty map.
  int at(int i, int j) const;
  std::size_t bytes() const { return runs.capacity() * sizeof(Run) + rowStart.capacity() * sizeof(int); }
};

/// Fills cover.regions; needs the parts and volumes of all cut cells. work.pieceOfCell has the place of each
/// cut cell in work.cells, -1 for the others.
void mapRegions(const Grid& grid, JoinedSides joined, GridCover& cover);

}  // namespace smokebox
