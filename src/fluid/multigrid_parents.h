// Which block an unknown of the multigrid lies in, and which coarse unknown it belongs to.
#pragma once
#include "fluid/multigrid_level.h"

namespace smokebox::multigrid {

struct Cell {
  int i, j;
};

/// The block of an unknown, or of a ghost beyond a side.
inline Cell cellOf(const Level& level, int at) {
  if (at >= level.extrasBegin) {
    const int cell = level.extraCell[at - level.extrasBegin];
    return {cell % level.nx, cell / level.nx};
  }
  const int shifted = static_cast<int>(at - level.origin + level.stride + 1);  // ghosts at -1 become 0
  const int j = shifted / static_cast<int>(level.stride);
  return {shifted - j * static_cast<int>(level.stride) - 1, j - 1};
}

/// Offset into the coarse x of the unknown that block (i, j)'s unknown number `unknown` belongs to.
inline int parentOf(const Level& fine, const Level& coarse, int i, int j, int unknown) {
  const int I = fine.joinX.coarse(i), J = fine.joinY.coarse(j);
  const int base = coarse.extraBase[J * coarse.nx + I];
  const int part = base < 0 ? 0 : fine.part[unknown];
  return static_cast<int>(part == 0 ? coarse.at(I, J) : coarse.extrasBegin + base + part - 1);
}

inline int parentOf(const Level& fine, const Level& coarse, int i, int j) {
  return parentOf(fine, coarse, i, j, j * fine.nx + i);
}

/// The same for the fine unknown at offset `at`.
inline int parentOf(const Level& fine, const Level& coarse, int at) {
  const Cell c = cellOf(fine, at);
  const int unknown = at >= fine.extrasBegin ? static_cast<int>(fine.nx * fine.ny + (at - fine.extrasBegin))
                                             : c.j * fine.nx + c.i;
  return parentOf(fine, coarse, c.i, c.j, unknown);
}

}  // namespace smokebox::multigrid
