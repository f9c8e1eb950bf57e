#include "rigid/piece_tree.h"

#include <algorithm>

namespace smokebox {
namespace {

struct Bounds {
  Vec2 lo{1e300, 1e300}, hi{-1e300, -1e300};
  void add(const Bounds& other) {
    lo = {std::min(lo.x, other.lo.x), std::min(lo.y, other.lo.y)};
    hi = {std::max(hi.x, other.hi.x), std::max(hi.y, other.hi.y)};
  }
};

Bounds boundsOf(const ConvexPiece& piece) {
  Bounds bounds;
  for (Vec2 p : piece.points) bounds.add({p, p});
  const Vec2 r{piece.radius, piece.radius};
  return {bounds.lo - r, bounds.hi + r};
}

/// Splits at the median of the boxes' centres along the longer side; nodes[at] is the one to fill.
void build(const std::vector<Bounds>& bounds, int* first, int* last, int at,
           std::vector<PieceTree::Node>& nodes) {
  Bounds all;
  for (int* k = first; k != last; ++k) all.add(bounds[*k]);
  nodes[at].centre = 0.5 * (all.lo + all.hi);
  nodes[at].half = 0.5 * (all.hi - all.lo);
  if (last - first == 1) {
    nodes[at].piece = *first;
    return;
  }
  const bool alongX = nodes[at].half.x >= nodes[at].half.y;
  auto centre = [&](int k) {
    return alongX ? bounds[k].lo.x + bounds[k].hi.x : bounds[k].lo.y + bounds[k].hi.y;
  };
  std::sort(first, last, [&](int a, int b) {
    const double ca = centre(a), cb = centre(b);
    return ca != cb ? ca < cb : a < b;
  });
  int* middle = first + (last - first) / 2;
  for (int child = 0; child < 2; ++child) {
    const int index = static_cast<int>(nodes.size());
    nodes.emplace_back();
    (child == 0 ? nodes[at].left : nodes[at].right) = index;
    build(bounds, child == 0 ? first : middle, child == 0 ? middle : last, index, nodes);
  }
}

}  // namespace

PieceTree::PieceTree(const std::vector<ConvexPiece>& pieces) {
  std::vector<Bounds> bounds;
  std::vector<int> order;
  for (const ConvexPiece& piece : pieces) {
    if (!piece.buried) order.push_back(static_cast<int>(bounds.size()));
    bounds.push_back(boundsOf(piece));
  }
  if (order.empty()) return;
  nodes_.reserve(2 * order.size());
  nodes_.emplace_back();
  build(bounds, order.data(), order.data() + order.size(), 0, nodes_);
}

}  // namespace smokebox
