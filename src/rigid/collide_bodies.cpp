#include "rigid/collide_bodies.h"

#include <algorithm>
#include <cmath>

namespace smokebox {
namespace {

/// Descends two trees against each other. Boxes of B are turned against A's: four axes tell whether they are
/// apart.
class Descent {
 public:
  Descent(const BodyShape& a, const BodyShape& b, const Frame& bInA, double margin,
          std::vector<PiecePair>& pairs)
      : a_(a.tree.nodes()),
        b_(b.tree.nodes()),
        bInA_(bInA),
        margin_(margin),
        pairs_(pairs),
        c_(std::fabs(bInA.turn.c)),
        s_(std::fabs(bInA.turn.s)) {}

  void visit(int i, int j) {
    const PieceTree::Node &a = a_[i], &b = b_[j];
    if (apart(a, b)) return;
    if (a.left < 0 && b.left < 0) {
      pairs_.push_back({a.piece, b.piece});
    } else if (b.left < 0 || (a.left >= 0 && a.half.x + a.half.y >= b.half.x + b.half.y)) {
      visit(a.left, j);
      visit(a.right, j);
    } else {
      visit(i, b.left);
      visit(i, b.right);
    }
  }

 private:
  bool apart(const PieceTree::Node& a, const PieceTree::Node& b) const {
    const Vec2 between = toWorld(bInA_, b.centre) - a.centre;
    if (std::fabs(between.x) > a.half.x + c_ * b.half.x + s_ * b.half.y + margin_) return true;
    if (std::fabs(between.y) > a.half.y + s_ * b.half.x + c_ * b.half.y + margin_) return true;
    const Vec2 turned = inverseRotate(bInA_.turn, between);
    return std::fabs(turned.x) > b.half.x + c_ * a.half.x + s_ * a.half.y + margin_ ||
           std::fabs(turned.y) > b.half.y + s_ * a.half.x + c_ * a.half.y + margin_;
  }

  const std::vector<PieceTree::Node>&a_, &b_;
  Frame bInA_;
  double margin_;
  std::vector<PiecePair>& pairs_;
  double c_, s_;
};

}  // namespace

void findPiecePairs(const BodyShape& a, const Frame& fa, const BodyShape& b, const Frame& fb, double margin,
                    std::vector<PiecePair>& pairs) {
  pairs.clear();
  if (a.pieces.size() == 1 && b.pieces.size() == 1) {  // collide() looks first whether they are near
    pairs.push_back({0, 0});
    return;
  }
  if (a.tree.nodes().empty() || b.tree.nodes().empty()) return;
  Descent(a, b, relativeFrame(fa, fb), margin, pairs).visit(0, 0);
  std::sort(pairs.begin(), pairs.end(),
            [](PiecePair x, PiecePair y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
}

}  // namespace smokebox
