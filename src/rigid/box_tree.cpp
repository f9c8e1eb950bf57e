#include "rigid/box_tree.h"

namespace smokebox {

namespace {
constexpr int kLeaf = 4;  // items
// Larger than so many times the median is large, unless there are more than so many.
constexpr double kLarge = 16;
constexpr std::size_t kMostLarge = 16;
}  // namespace

void BoxTree::build(const std::vector<Box>& boxes, const std::vector<int>& items,
                    const std::vector<std::uint64_t>& groups) {
  items_ = items;
  nodes_.clear();
  setLargeApart(boxes);
  if (small_ > 0) nodes_.push_back({{}, 0, static_cast<int>(small_), -1, 0});
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
    nodes_.push_back({{}, first, half, static_cast<int>(n), 0});
    nodes_.push_back({{}, first + half, count - half, static_cast<int>(n), 0});
  }
  place_.resize(boxes.size());
  leaf_.assign(boxes.size(), -1);
  for (std::size_t k = small_; k < items_.size(); ++k) place_[items_[k]] = static_cast<int>(k);
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    for (int k = nodes_[n].first; k < nodes_[n].first + nodes_[n].count; ++k) {
      place_[items_[k]] = k;
      leaf_[items_[k]] = static_cast<int>(n);
    }
  groups_.resize(items_.size());
  for (std::size_t k = 0; k < items_.size(); ++k) groups_[k] = groups[items_[k]];
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) {
    node->groups =
        node->count > 0 ? groups_[node->first] : nodes_[node->first].groups & nodes_[node->first + 1].groups;
    for (int k = node->first; k < node->first + node->count; ++k) node->groups &= groups_[k];
  }
  refit(boxes);
}

void BoxTree::setLargeApart(const std::vector<Box>& boxes) {
  small_ = items_.size();
  if (items_.empty()) return;
  sizes_.clear();
  for (const int item : items_) sizes_.push_back(sizeOf(boxes[item]));
  const auto middle = sizes_.begin() + static_cast<std::ptrdiff_t>(sizes_.size() / 2);
  std::nth_element(sizes_.begin(), middle, sizes_.end());
  const double limit = kLarge * *middle;
  const auto large =
      std::partition(items_.begin(), items_.end(), [&](int item) { return sizeOf(boxes[item]) <= limit; });
  if (static_cast<std::size_t>(items_.end() - large) <= kMostLarge)
    small_ = static_cast<std::size_t>(large - items_.begin());
}

Box BoxTree::boxOf(const Node& node) const {
  if (node.count == 0) return joined(nodes_[node.first].box, nodes_[node.first + 1].box);
  Box box = boxes_[node.first];
  for (int k = node.first + 1; k < node.first + node.count; ++k) box = joined(box, boxes_[k]);
  return box;
}

void BoxTree::refit(const std::vector<Box>& boxes) {
  boxes_.resize(items_.size());
  for (std::size_t k = 0; k < items_.size(); ++k) boxes_[k] = boxes[items_[k]];
  for (auto node = nodes_.rbegin(); node != nodes_.rend(); ++node) node->box = boxOf(*node);
}

void BoxTree::markNodes(const std::vector<char>& marked) {
  marked_.assign(nodes_.size(), 0);
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    const Node& node = nodes_[n];
    if (node.count == 0) marked_[n] = marked_[node.first] || marked_[node.first + 1];
    for (int k = node.first; k < node.first + node.count; ++k) marked_[n] |= marked[items_[k]];
  }
}

void BoxTree::refit(const std::vector<Box>& boxes, int item) {
  boxes_[place_[item]] = boxes[item];
  for (int n = leaf_[item]; n >= 0; n = nodes_[n].parent) {
    const Box was = nodes_[n].box;
    nodes_[n].box = boxOf(nodes_[n]);
    if (nodes_[n].box.holds(was) && was.holds(nodes_[n].box)) return;
  }
}

}  // namespace smokebox
