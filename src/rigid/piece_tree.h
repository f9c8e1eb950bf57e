// A tree of boxes over the convex pieces of one body, built once and never changed.
#pragma once
#include <vector>

#include "rigid/convex.h"

namespace smokebox {

class PieceTree {
 public:
  struct Node {
    Vec2 centre, half;          // of the box, own coordinates of the body, radius of pieces included
    int left = -1, right = -1;  // children; a leaf has none
    int piece = -1;             // of a leaf
  };

  PieceTree() = default;
  /// Over the pieces that can touch something: those with an edge on the outline.
  explicit PieceTree(const std::vector<ConvexPiece>& pieces);

  /// [0] is the root; empty if no piece can touch anything. Children follow their parents.
  const std::vector<Node>& nodes() const { return nodes_; }

 private:
  std::vector<Node> nodes_;
};

}  // namespace smokebox
