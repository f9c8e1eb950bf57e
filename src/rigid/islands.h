// Links that hang together: what must be solved at once, and what need not.
#pragma once
#include <array>
#include <vector>

#include "rigid/bodies.h"

namespace smokebox {

/// Groups links by the bodies that they share and that can move. `ends` are the two bodies of each link (-1:
/// the world). Links, and groups by their first link, come in order; a link without an end that moves is in
/// none.
std::vector<std::vector<int>> islandsOf(const std::vector<std::array<int, 2>>& ends, const Bodies& bodies);

/// The pairs of links of a group that share a body that can move, each with that body; links are given by
/// their place in the group.
struct SharedBody {
  int first = 0, second = 0;  // links; first < second
  int body = 0;
};
std::vector<SharedBody> sharedBodies(const std::vector<std::array<int, 2>>& ends, const Bodies& bodies);

}  // namespace smokebox
