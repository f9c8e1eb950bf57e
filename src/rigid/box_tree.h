// A tree of boxes over items, for questions such as "which boxes meet this one": built top-down by medians
// (O(n log n)), refitted in O(n) when boxes have changed a little, in O(log n) for each one when few have.
#pragma once
#include <algorithm>
#include <vector>

#include "geometry/vec2.h"

namespace smokebox {

struct Box {
  Vec2 low, high;
  bool meets(const Box& o) const {
    return low.x <= o.high.x && o.low.x <= high.x && low.y <= o.high.y && o.low.y <= high.y;
  }
  bool holds(const Box& o) const {
    return low.x <= o.low.x && o.high.x <= high.x && low.y <= o.low.y && o.high.y <= high.y;
  }
};
inline Box joined(const Box& a, const Box& b) {
  return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y)},
          {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y)}};
}
inline Box grown(const Box& a, double by) {
  return {{a.low.x - by, a.low.y - by}, {a.high.x + by, a.high.y + by}};
}
inline Box shifted(const Box& a, Vec2 by) { return {a.low + by, a.high + by}; }

class BoxTree {
 public:
  /// Over the items whose numbers are listed.
  void build(const std::vector<Box>& boxes, const std::vector<int>& items);
  void refit(const std::vector<Box>& boxes);
  /// The same where only that item's box has changed.
  void refit(const std::vector<Box>& boxes, int item);

  /// Calls visit(item) for every item whose box meets `box`.
  template <class Visit>
  void query(const Box& box, Visit&& visit) const {
    if (nodes_.empty()) return;
    int stack[96];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const Node& node = nodes_[stack[--top]];
      if (!node.box.meets(box)) continue;
      if (node.count > 0) {
        for (int k = node.first; k < node.first + node.count; ++k)
          if (boxes_[k].meets(box)) visit(items_[k]);
      } else {
        stack[top++] = node.first;
        stack[top++] = node.first + 1;
      }
    }
  }

 private:
  struct Node {
    Box box;
    int first = 0;  // the first of two children, or of `count` items
    int count = 0;  // 0: an inner node
    int parent = -1;
  };
  Box boxOf(const Node& node) const;

  std::vector<Node> nodes_;  // children come after their parent
  std::vector<int> items_;
  std::vector<Box> boxes_;          // of items_
  std::vector<int> place_, leaf_;  // by item: in items_; node
};

}  // namespace smokebox
