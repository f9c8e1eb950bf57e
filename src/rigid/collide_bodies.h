// Which pieces of two bodies may touch.
#pragma once
#include <vector>

#include "rigid/pieces.h"

namespace smokebox {

struct PiecePair {
  int a, b;
  bool operator==(const PiecePair&) const = default;
};

/// Pairs of pieces whose boxes come within `margin`, in ascending order (a, then b): the two trees are
/// descended against each other. `pairs` is emptied first; nothing is allocated once it is large enough.
/// Where each has one piece, that pair is listed, near or far.
void findPiecePairs(const BodyShape& a, const Frame& fa, const BodyShape& b, const Frame& fb, double margin,
                    std::vector<PiecePair>& pairs);

}  // namespace smokebox
