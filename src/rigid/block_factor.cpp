#include "rigid/block_factor.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

namespace {

template <int N>
using BlockOf = std::array<double, N * N>;

/// By elimination without pivots; without the rows and columns whose pivots are not beyond `least`.
template <int N>
BlockOf<N> inverseOf(BlockOf<N> a, const std::array<double, N>& least) {
  for (int k = 0; k < N; ++k) {
    if (!(std::fabs(a[k * N + k]) > least[k])) {
      for (int j = 0; j < N; ++j) a[k * N + j] = a[j * N + k] = 0;
      continue;
    }
    const double pivot = 1 / a[k * N + k];
    a[k * N + k] = 1;
    for (int j = 0; j < N; ++j) a[k * N + j] *= pivot;
    for (int i = 0; i < N; ++i) {
      if (i == k) continue;
      const double share = a[i * N + k];
      a[i * N + k] = 0;
      for (int j = 0; j < N; ++j) a[i * N + j] -= share * a[k * N + j];
    }
  }
  return a;
}

template <int N>
BlockOf<N> product(const BlockOf<N>& a, const BlockOf<N>& b) {
  BlockOf<N> c;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) {
      double sum = 0;
      for (int k = 0; k < N; ++k) sum += a[i * N + k] * b[k * N + j];
      c[i * N + j] = sum;
    }
  return c;
}

/// c -= a b^T
template <int N>
void subtractProduct(BlockOf<N>& c, const BlockOf<N>& a, const BlockOf<N>& b) {
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) {
      double sum = 0;
      for (int k = 0; k < N; ++k) sum += a[i * N + k] * b[j * N + k];
      c[i * N + j] -= sum;
    }
}

}  // namespace

template <int N>
bool BlockFactor<N>::layOut(int count, const std::vector<std::array<int, 2>>& pairs, long mostProducts) {
  std::vector<std::vector<int>> neighbours(count);
  for (const auto& [i, j] : pairs) {
    neighbours[i].push_back(j);
    neighbours[j].push_back(i);
  }
  for (auto& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  order_.clear();
  position_.assign(count, -1);
  columnStart_.assign(1, 0);
  rowAt_.clear();
  target_.clear();
  std::vector<int> joined;
  long products = 0;
  for (int k = 0; k < count; ++k) {
    int next = -1;
    for (int i = 0; i < count; ++i)
      if (position_[i] < 0 && (next < 0 || neighbours[i].size() < neighbours[next].size())) next = i;
    position_[next] = k;
    order_.push_back(next);
    // What it touches becomes joined to one another.
    const std::vector<int>& row = neighbours[next];
    products += static_cast<long>(row.size() * (row.size() + 1) / 2);
    if (products > mostProducts) return false;
    for (const int i : row) {
      joined.clear();
      std::set_union(neighbours[i].begin(), neighbours[i].end(), row.begin(), row.end(),
                     std::back_inserter(joined));
      std::erase_if(joined, [&](int j) { return j == i || j == next; });
      neighbours[i] = joined;
      rowAt_.push_back(i);
    }
    columnStart_.push_back(static_cast<int>(rowAt_.size()));
  }
  for (int& row : rowAt_) row = position_[row];
  for (int k = 0; k < count; ++k)
    std::sort(rowAt_.begin() + columnStart_[k], rowAt_.begin() + columnStart_[k + 1]);
  target_.reserve(products);
  for (int k = 0; k < count; ++k)
    for (int s = columnStart_[k]; s < columnStart_[k + 1]; ++s)
      for (int t = columnStart_[k]; t <= s; ++t)
        target_.push_back(s == t ? -1 - rowAt_[s] : slot(order_[rowAt_[s]], order_[rowAt_[t]]));
  diagonal_.assign(count, Block{});
  inverse_.assign(count, Block{});
  lower_.assign(rowAt_.size(), Block{});
  upper_.assign(rowAt_.size(), Block{});
  return true;
}

template <int N>
int BlockFactor<N>::slot(int i, int j) const {
  const int row = std::max(position_[i], position_[j]), column = std::min(position_[i], position_[j]);
  const auto begin = rowAt_.begin() + columnStart_[column], end = rowAt_.begin() + columnStart_[column + 1];
  const auto found = std::lower_bound(begin, end, row);
  return found != end && *found == row ? static_cast<int>(found - rowAt_.begin()) : -1;
}

template <int N>
void BlockFactor<N>::clear() {
  std::fill(diagonal_.begin(), diagonal_.end(), Block{});
  std::fill(lower_.begin(), lower_.end(), Block{});
  std::fill(upper_.begin(), upper_.end(), Block{});
}

template <int N>
void BlockFactor<N>::factor(const std::vector<Row>& least) {
  const int* target = target_.data();
  for (int k = 0; k < count(); ++k) {
    inverse_[k] = inverseOf<N>(diagonal_[k], least.empty() ? Row{} : least[order_[k]]);
    const int begin = columnStart_[k], end = columnStart_[k + 1];
    // Row s becomes L; of two rows, (s, t) lies below the diagonal and (t, s) above, stored transposed.
    for (int s = begin; s < end; ++s) lower_[s] = product<N>(lower_[s], inverse_[k]);
    for (int s = begin; s < end; ++s)
      for (int t = begin; t <= s; ++t, ++target) {
        if (*target < 0) {
          subtractProduct<N>(diagonal_[-1 - *target], lower_[s], upper_[t]);
        } else {
          subtractProduct<N>(lower_[*target], lower_[s], upper_[t]);
          subtractProduct<N>(upper_[*target], upper_[s], lower_[t]);
        }
      }
  }
}

template <int N>
void BlockFactor<N>::solve(std::vector<Row>& x) const {
  for (int k = 0; k < count(); ++k) {
    const Row& from = x[order_[k]];
    for (int s = columnStart_[k]; s < columnStart_[k + 1]; ++s) {
      Row& to = x[order_[rowAt_[s]]];
      for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j) to[i] -= lower_[s][i * N + j] * from[j];
    }
  }
  for (int k = count() - 1; k >= 0; --k) {
    Row rest = x[order_[k]], result{};
    for (int s = columnStart_[k]; s < columnStart_[k + 1]; ++s) {
      const Row& from = x[order_[rowAt_[s]]];
      for (int i = 0; i < N; ++i)
        for (int j = 0; j < N; ++j) rest[j] -= upper_[s][i * N + j] * from[i];
    }
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) result[i] += inverse_[k][i * N + j] * rest[j];
    x[order_[k]] = result;
  }
}

template <int N>
std::size_t BlockFactor<N>::bytes() const {
  return (order_.size() + position_.size() + columnStart_.size() + rowAt_.size() + target_.size()) *
             sizeof(int) +
         (diagonal_.size() + inverse_.size() + lower_.size() + upper_.size()) * sizeof(Block);
}

template class BlockFactor<2>;
template class BlockFactor<3>;

}  // namespace smokebox
