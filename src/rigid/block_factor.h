// Direct solution of a sparse system of small square blocks whose pattern is symmetric, and whose matrix is
// symmetric positive definite or near to one that is.
//
// L D U by blocks, eliminated in the order of least degree (ties: the lower number), so that a chain or a
// tree costs a time in proportion to its length. What memory the factors need, and which block each product
// lands in, is found once, when the pattern changes. Sums run in a fixed order, one by one: the result does
// not depend on the instruction set. No pivoting: the caller sees to it that the diagonal is positive. What
// an elimination leaves nothing of is a row that the others imply: it may be left out, so that its unknown is
// 0.
#pragma once
#include <array>
#include <vector>

namespace smokebox {

template <int N>
class BlockFactor {
 public:
  using Block = std::array<double, N * N>;  // row by row
  using Row = std::array<double, N>;

  /// The blocks off the diagonal that are not zero, as pairs of unlike numbers below `count`; a pair may come
  /// twice. False if a factorization took more than `mostProducts` products of blocks: then do not use it.
  bool layOut(int count, const std::vector<std::array<int, 2>>& pairs, long mostProducts);
  int count() const { return static_cast<int>(order_.size()); }
  /// Whether i is eliminated after j: then the lower block of the pair has i's rows and j's columns.
  bool comesAfter(int i, int j) const { return position_[i] > position_[j]; }
  /// Where the pair's blocks are; -1 if there are none.
  int slot(int i, int j) const;

  void clear();
  Block& diagonal(int i) { return diagonal_[position_[i]]; }
  Block& lower(int slot) { return lower_[slot]; }
  /// Transposed: with the same rows and columns as the lower block, and equal to it if the matrix is
  /// symmetric.
  Block& upper(int slot) { return upper_[slot]; }
  /// Of what is there now, which is used up by it. Rows of which an elimination leaves no more than `least`,
  /// by number, are left out; it may be empty.
  void factor(const std::vector<Row>& least = {});
  /// In place: x[i] from the right-hand side to the solution.
  void solve(std::vector<Row>& x) const;

  std::size_t bytes() const;

 private:
  std::vector<int> order_, position_;  // number by position, and back
  std::vector<int> columnStart_;       // by position: its first block below the diagonal; one more at the end
  std::vector<int> rowAt_;             // by block: the position of its row
  std::vector<int> target_;  // by pair of rows of a column, as in factor(): the slot, or -1 - position
  std::vector<Block> diagonal_, inverse_, lower_, upper_;
};

extern template class BlockFactor<2>;
extern template class BlockFactor<3>;

}  // namespace smokebox
