// The tree of boxes against every box with every other.
#include "rigid/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace smokebox {
namespace {

using Pairs = std::vector<std::pair<int, int>>;

/// Boxes about as large as the room between them, and three walls, far larger than the rest.
std::vector<Box> randomBoxes(int count, std::mt19937& random) {
  std::uniform_real_distribution<double> place(0, 20), size(0.1, 1);
  std::vector<Box> boxes = {{{-30, -30}, {0.5, 50}}, {{19.5, -30}, {50, 50}}, {{-30, -30}, {50, 0.5}}};
  for (int k = 0; k < count; ++k) {
    const Vec2 low{place(random), place(random)};
    boxes.push_back({low, low + Vec2{size(random), size(random)}});
  }
  return boxes;
}

std::vector<int> allOf(const std::vector<Box>& boxes) {
  std::vector<int> items;
  for (int k = 0; k < static_cast<int>(boxes.size()); ++k) items.push_back(k);
  return items;
}

Pairs expected(const std::vector<Box>& boxes, const std::vector<char>& marked) {
  Pairs pairs;
  for (int a = 0; a < static_cast<int>(boxes.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(boxes.size()); ++b)
      if ((marked[a] || marked[b]) && boxes[a].meets(boxes[b])) pairs.push_back({a, b});
  return pairs;
}

Pairs found(BoxTree& tree, const std::vector<char>& marked) {
  Pairs pairs;
  tree.eachPair(marked, [&](int a, int b) { pairs.push_back(std::minmax(a, b)); });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

TEST(BoxTree, PairsAreThoseThatMeet) {
  // Truth: every two boxes that meet, once, if one of them is marked; with and without walls, from none to
  // many.
  std::mt19937 random(3);
  for (const int count : {0, 1, 3, 40, 700}) {
    const std::vector<Box> boxes = randomBoxes(count, random);
    BoxTree tree;
    tree.build(boxes, allOf(boxes));
    std::vector<char> marked(boxes.size(), 1);
    EXPECT_EQ(found(tree, marked), expected(boxes, marked)) << count;
    for (char& mark : marked) mark = random() % 5 == 0;
    EXPECT_EQ(found(tree, marked), expected(boxes, marked)) << count << ", a fifth marked";
  }
}

TEST(BoxTree, BoxesThatChangeAreFound) {
  // Truth: after boxes have moved far and were fitted one by one, walls too, queries and pairs are those of
  // the new boxes.
  std::mt19937 random(5);
  std::vector<Box> boxes = randomBoxes(300, random);
  BoxTree tree;
  tree.build(boxes, allOf(boxes));
  for (int k = 0; k < static_cast<int>(boxes.size()); k += 3) {
    boxes[k] = shifted(boxes[k], {0.01 * (random() % 1000), 0.01 * (random() % 1000)});
    tree.refit(boxes, k);
  }
  const std::vector<char> marked(boxes.size(), 1);
  EXPECT_EQ(found(tree, marked), expected(boxes, marked));
  for (const Box& box : boxes) {
    std::vector<int> met, truth;
    tree.query(box, [&](int item) { met.push_back(item); });
    for (int k = 0; k < static_cast<int>(boxes.size()); ++k)
      if (boxes[k].meets(box)) truth.push_back(k);
    std::sort(met.begin(), met.end());
    EXPECT_EQ(met, truth);
  }
}

}  // namespace
}  // namespace smokebox
