#include "rigid/block_factor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace smokebox {
namespace {

/// A repeatable number in -1..1.
double scattered(int k) {
  std::uint64_t z = 0x9e3779b97f4a7c15u * static_cast<std::uint64_t>(k + 1);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

/// Largest residual of a system whose diagonal dominates, unsymmetric, with this pattern.
template <int N>
double residual(int count, const std::vector<std::array<int, 2>>& pairs) {
  BlockFactor<N> matrix;
  EXPECT_TRUE(matrix.layOut(count, pairs, 1000000));
  std::vector<std::vector<double>> dense(N * count, std::vector<double>(N * count, 0.0));
  int seed = 0;
  matrix.clear();
  for (int k = 0; k < count; ++k)
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j)
        matrix.diagonal(k)[i * N + j] = dense[N * k + i][N * k + j] = (i == j ? 40 : 0) + scattered(seed++);
  for (const auto& [p, q] : pairs) {
    const int slot = matrix.slot(p, q), row = matrix.comesAfter(p, q) ? p : q, column = p + q - row;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) {
        matrix.lower(slot)[i * N + j] = dense[N * row + i][N * column + j] = scattered(seed++);
        matrix.upper(slot)[i * N + j] = dense[N * column + j][N * row + i] = scattered(seed++);
      }
  }
  std::vector<std::array<double, N>> x(count);
  for (int k = 0; k < count; ++k)
    for (int i = 0; i < N; ++i) x[k][i] = scattered(seed++);
  const auto right = x;
  matrix.factor();
  matrix.solve(x);
  double worst = 0;
  for (int r = 0; r < N * count; ++r) {
    double sum = -right[r / N][r % N];
    for (int c = 0; c < N * count; ++c) sum += dense[r][c] * x[c / N][c % N];
    worst = std::max(worst, std::fabs(sum));
  }
  return worst;
}

TEST(BlockFactor, SolvesChainsRingsGridsAndStars) {
  // A x = b to rounding, whatever the pattern, with fill or without.
  std::vector<std::array<int, 2>> chain, ring, grid, star;
  for (int k = 0; k + 1 < 30; ++k) chain.push_back({k, k + 1});
  ring = chain;
  ring.push_back({29, 0});
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 6; ++i) {
      if (i < 5) grid.push_back({6 * j + i, 6 * j + i + 1});
      if (j < 4) grid.push_back({6 * j + i + 6, 6 * j + i});
    }
  for (int k = 1; k < 30; ++k) star.push_back({0, k});
  for (const auto& pairs : {chain, ring, grid, star}) {
    EXPECT_LT(residual<2>(30, pairs), 1e-14);
    EXPECT_LT(residual<3>(30, pairs), 1e-14);
  }
  EXPECT_LT(residual<3>(1, {}), 1e-14);
}

TEST(BlockFactor, LeavesOutWhatOtherRowsImply) {
  // Truth: of two equal rows and a sum of both the first gets the whole, the others nothing, and the rest of
  // the system does not notice.
  BlockFactor<2> matrix;
  ASSERT_TRUE(matrix.layOut(2, {{0, 1}}, 100));
  matrix.clear();
  // Rows u, v | u + v, w with u.u = v.v = w.w = 1, at right angles.
  matrix.diagonal(0) = {1, 0, 0, 1};
  matrix.diagonal(1) = {2, 0, 0, 1};
  const int slot = matrix.slot(0, 1);
  const bool later = matrix.comesAfter(1, 0);
  matrix.lower(slot) = matrix.upper(slot) =
      later ? BlockFactor<2>::Block{1, 1, 0, 0} : BlockFactor<2>::Block{1, 0, 1, 0};
  matrix.factor({{1e-10, 1e-10}, {2e-10, 1e-10}});
  std::vector<std::array<double, 2>> x{{3, 4}, {7, 5}};
  matrix.solve(x);
  EXPECT_NEAR(x[1][1], 5, 1e-12);
  EXPECT_NEAR(x[0][0] + x[1][0], 3, 1e-12);
  EXPECT_NEAR(x[0][1] + x[1][0], 4, 1e-12);
  EXPECT_LT(std::fabs(x[1][0]), 10);
}

TEST(BlockFactor, AChainCostsInProportionToItsLengthAndACrowdIsRefused) {
  // A chain and a star have no fill: one product for each pair is enough. What would take more is refused.
  std::vector<std::array<int, 2>> chain, star, crowd;
  for (int k = 0; k + 1 < 500; ++k) chain.push_back({k, k + 1});
  for (int k = 1; k < 500; ++k) star.push_back({0, k});
  for (int i = 0; i < 50; ++i)
    for (int j = 0; j < i; ++j) crowd.push_back({i, j});
  BlockFactor<3> matrix;
  EXPECT_TRUE(matrix.layOut(500, chain, 499));
  EXPECT_TRUE(matrix.layOut(500, star, 499));
  EXPECT_FALSE(matrix.layOut(50, crowd, 10000));
  EXPECT_TRUE(matrix.layOut(50, crowd, 30000));
  EXPECT_EQ(matrix.slot(3, 3), -1);
}

}  // namespace
}  // namespace smokebox
