// What is drawn of a cloth, from which of its cells are whole: its rims, its weave, its shading. Nodes are
// numbered row by row from the lower left, as in a ClothPicture.
#pragma once
#include <vector>

#include "world/snapshot.h"

namespace smokebox {

/// Closed lines along the edges that have a whole cell on one side only: the outer rim with the cloth on its
/// left, and holes.
std::vector<std::vector<int>> hemOf(const ClothPicture& cloth);

/// Lines of the weave between whole cells: every `every`-th column and row.
std::vector<std::vector<int>> weaveOf(const ClothPicture& cloth, int every);

/// For each node, -1 (dark) to 1 (bright): stretched cells are lighter, sheared and turned ones catch the
/// light from one side, the back is dark.
std::vector<float> shadingOf(const ClothPicture& cloth);

/// Nodes without a whole cell at them.
std::vector<int> looseNodes(const ClothPicture& cloth);

}  // namespace smokebox
