// Which parts the fluid of one cell falls into, where outlines cut it, and how large they are.
//
//        top               Walking counterclockwise around the cell, entries and exits of the outlines'
//        pieces take turns.
//      +--x---+            The solid lies left of a piece, so an arc of the perimeter is open from an entry
//      to the next |  |###|            exit. The fluid's boundary goes on along that piece, backwards to its
//      entry, and then along
// left |  \###| right      the next open arc: each such cycle bounds one part.
//      |   x##x
//      +------+
#pragma once
#include "geometry/coverage.h"

namespace smokebox {

/// Finds what cell (i, j) keeps. Sets its volume, adds to cover.shut, and notes in cover.work to which faces
/// each of its parts leads. `perimeterOpen`: what holds of its
/// faces if no outline crosses them.
void keepLargestPart(const Grid& grid, int i, int j, bool perimeterOpen, GridCover& cover);

}  // namespace smokebox
