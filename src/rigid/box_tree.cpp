#include "rigid/box_tree.h"

namespace smokebox {

namespace {
constexpr int kLeaf = 4;  // items
}

void BoxTree::build(const std::vector<Box>& boxes, const std::vector<int>& items) {
  items_ = items;
  nodes_.clear();
  if (items.empty()) return;
  nodes_.push_back({{}, 0, static_cast<int>(items.size())});
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const int first = nodes_[n].first, count = nodes_[n].count;
    if (count <= kLeaf) continue;
    Box middles{{1e300, 1e300}, {-1e300, -1e300}};
    for (int k = first; k < first + count; ++k) {
      const Vec2 m = boxes[items_[k]].low + boxes[items_[k]].high;
      middles = joined(middles, {m, m});
    }
    const Vec2 spread = middles.high - middles.low;
    const auto begin = items_.begin() + first;
    const int half = count / 2;
    if (spread.x > spread.y)
      std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
        const double ma = boxes[a].low.x + boxes[a].high.x, mb = boxes[b].low.x + boxes[b].high.x;
        return ma < mb || (ma == mb && a < b);
      });
    else
      std::nth_element(begin, begin + half, begin + count, [&](int a, int b) {
        const double ma = boxes[a].low.y + boxes[a].high.y, mb = boxes[b].low.y + boxes[b].high.y;
        return ma < mb || (ma == mb && a < b);
      });
    nodes_[n].first = static_cast<int>(nodes_.size());
    nodes_[n].count = 0;
    nodes_.push_back({{}, first, half});
    nodes_.push_back({{}, first + half, count - half});
  }
  refit(boxes);
}

Box BoxTree::boxOf(const std::vector<Box>& boxes, const Node& node) const {
  if (node.count == 0) return joined(nodes_[node.first].box, nodes_[node.first + 1].box);
  Box box = boxes[items_[node.first]];
  for (int k = node.first + 1; k < node.first + node.count; ++k) box = joined(box, boxes[items_[k]]);
  return box;
}

void BoxTree::refit(const std::vector<Box>& boxes) {
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) node->box = boxOf(boxes, *node);
}

}  // namespace smokebox
