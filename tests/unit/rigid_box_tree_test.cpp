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

using Groups = std::vector<std::uint64_t>;

/// Half of them in no group, the others in one or two of two; with `all`, each in the first one as well.
Groups randomGroups(std::size_t count, std::mt19937& random, bool all) {
  Groups groups;
  for (std::size_t k = 0; k < count; ++k)
    groups.push_back((random() % 2) * (random() % 4) * 2 + (all ? 1 : 0));
  return groups;
}

Pairs expected(const std::vector<Box>& boxes, const std::vector<char>& marked, const Groups& groups) {
  Pairs pairs;
  for (int a = 0; a < static_cast<int>(boxes.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(boxes.size()); ++b)
      if ((marked[a] || marked[b]) && (groups[a] & groups[b]) == 0 && boxes[a].meets(boxes[b]))
        pairs.push_back({a, b});
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
  // many, in groups or not.
  std::mt19937 random(3);
  for (const int count : {0, 1, 3, 40, 700}) {
    const std::vector<Box> boxes = randomBoxes(count, random);
    for (const Groups& groups : {Groups(boxes.size(), 0), randomGroups(boxes.size(), random, false)}) {
      BoxTree tree;
      tree.build(boxes, allOf(boxes), groups);
      std::vector<char> marked(boxes.size(), 1);
      EXPECT_EQ(found(tree, marked), expected(boxes, marked, groups)) << count;
      for (char& mark : marked) mark = random() % 5 == 0;
      EXPECT_EQ(found(tree, marked), expected(boxes, marked, groups)) << count << ", a fifth marked";
    }
  }
}

TEST(BoxTree, BoxesThatChangeAreFound) {
  // Truth: after boxes have moved far and were fitted one by one, walls too, queries and pairs are those of
  // the new boxes.
  std::mt19937 random(5);
  std::vector<Box> boxes = randomBoxes(300, random);
  BoxTree tree;
  const Groups groups = randomGroups(boxes.size(), random, false);
  tree.build(boxes, allOf(boxes), groups);
  for (int k = 0; k < static_cast<int>(boxes.size()); k += 3) {
    boxes[k] = shifted(boxes[k], {0.01 * (random() % 1000), 0.01 * (random() % 1000)});
    tree.refit(boxes, k);
  }
  const std::vector<char> marked(boxes.size(), 1);
  EXPECT_EQ(found(tree, marked), expected(boxes, marked, groups));
  for (std::size_t one = 0; one < boxes.size(); ++one) {
    std::vector<int> met, truth;
    tree.query(boxes[one], groups[one], [&](int item) { met.push_back(item); });
    for (int k = 0; k < static_cast<int>(boxes.size()); ++k)
      if ((groups[k] & groups[one]) == 0 && boxes[k].meets(boxes[one])) truth.push_back(k);
    std::sort(met.begin(), met.end());
    EXPECT_EQ(met, truth);
  }
}

TEST(BoxTree, ThoseOfOneGroupDoNotMeet) {
  // Truth: where all share a group there is no pair, however much they overlap.
  std::mt19937 random(7);
  const std::vector<Box> boxes = randomBoxes(300, random);
  const Groups groups = randomGroups(boxes.size(), random, true);
  BoxTree tree;
  tree.build(boxes, allOf(boxes), groups);
  EXPECT_EQ(found(tree, std::vector<char>(boxes.size(), 1)), Pairs{});
  for (const Box& box : boxes) tree.query(box, 1, [](int item) { ADD_FAILURE() << item; });
}

}  // namespace
}  // namespace smokebox
