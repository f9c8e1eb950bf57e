// A tree of boxes over items, for questions such as "which boxes meet this one": built top-down by medians
// (O(n log n)), refitted in O(n) when boxes have changed a little, in O(log n) for each one when few have. A
// few boxes far larger than most (walls) would widen every node above them: they are kept beside the tree.
// Items may be in groups, as bits: two that share one never meet.
#pragma once
#include <algorithm>
#include <cstdint>
#include <utility>
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
  /// Over the items whose numbers are listed. `groups`: by item.
  void build(const std::vector<Box>& boxes, const std::vector<int>& items,
             const std::vector<std::uint64_t>& groups);
  void refit(const std::vector<Box>& boxes);
  /// The same where only that item's box has changed.
  void refit(const std::vector<Box>& boxes, int item);

  /// Calls visit(item) for every item whose box meets `box` and who is in none of `groups`.
  template <class Visit>
  void query(const Box& box, std::uint64_t groups, Visit&& visit) const {
    const auto meet = [&](std::size_t k) {
      if ((groups_[k] & groups) == 0 && boxes_[k].meets(box)) visit(items_[k]);
    };
    for (std::size_t k = small_; k < items_.size(); ++k) meet(k);
    if (nodes_.empty()) return;
    int stack[96];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const Node& node = nodes_[stack[--top]];
      if ((node.groups & groups) != 0 || !node.box.meets(box)) continue;
      if (node.count > 0) {
        for (int k = node.first; k < node.first + node.count; ++k) meet(k);
      } else {
        stack[top++] = node.first;
        stack[top++] = node.first + 1;
      }
    }
  }

  /// Calls visit(item, item) once for every two items whose boxes meet, if one at least is `marked`: both
  /// trees of a pair of nodes are descended together, which costs far less than a query for each item.
  template <class Visit>
  void eachPair(const std::vector<char>& marked, Visit&& visit) {
    auto meet = [&](std::size_t k, std::size_t l) {
      if ((groups_[k] & groups_[l]) != 0 || !boxes_[k].meets(boxes_[l])) return;
      const int a = items_[k], b = items_[l];
      if (marked[a] || marked[b]) visit(a, b);
    };
    for (std::size_t large = small_; large < items_.size(); ++large)
      for (std::size_t k = 0; k < large; ++k) meet(k, large);
    if (nodes_.empty()) return;
    markNodes(marked);
    pairs_.assign(1, {0, 0});
    while (!pairs_.empty()) {
      const auto [i, j] = pairs_.back();
      pairs_.pop_back();
      if (!marked_[i] && !marked_[j]) continue;
      const Node &a = nodes_[i], &b = nodes_[j];
      if ((a.groups & b.groups) != 0) continue;
      if (i == j && a.count == 0) {
        pairs_.push_back({a.first, a.first});
        pairs_.push_back({a.first + 1, a.first + 1});
        pairs_.push_back({a.first, a.first + 1});
      } else if (i == j) {
        for (int k = a.first; k < a.first + a.count; ++k)
          for (int l = k + 1; l < a.first + a.count; ++l) meet(k, l);
      } else if (!a.box.meets(b.box)) {
        continue;
      } else if (a.count > 0 && b.count > 0) {
        for (int k = a.first; k < a.first + a.count; ++k)
          if (boxes_[k].meets(b.box))
            for (int l = b.first; l < b.first + b.count; ++l) meet(k, l);
      } else if (b.count > 0 || (a.count == 0 && sizeOf(a.box) >= sizeOf(b.box))) {
        pairs_.push_back({a.first, j});
        pairs_.push_back({a.first + 1, j});
      } else {
        pairs_.push_back({i, b.first});
        pairs_.push_back({i, b.first + 1});
      }
    }
  }

 private:
  struct Node {
    Box box;
    int first = 0;  // the first of two children, or of `count` items
    int count = 0;  // 0: an inner node
    int parent = -1;
    std::uint64_t groups = 0;  // those that all its items share
  };
  static double sizeOf(const Box& box) { return box.high.x - box.low.x + box.high.y - box.low.y; }
  Box boxOf(const Node& node) const;
  /// Moves what is large to the end of items_.
  void setLargeApart(const std::vector<Box>& boxes);
  void markNodes(const std::vector<char>& marked);

  std::vector<Node> nodes_;  // children come after their parent
  std::vector<int> items_;
  std::size_t small_ = 0;  // so many of them are in the tree
  std::vector<double> sizes_;
  std::vector<Box> boxes_;                  // of items_
  std::vector<std::uint64_t> groups_;       // of items_
  std::vector<int> place_, leaf_;           // by item: in items_; node, -1 beside the tree
  std::vector<char> marked_;                // by node: an item in it is
  std::vector<std::pair<int, int>> pairs_;  // of nodes, still to be looked at
};

}  // namespace smokebox
