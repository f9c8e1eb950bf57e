#include "rigid/spring_bands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace smokebox {
namespace {

/// A sheet of nx by ny nodes with holes, and a few springs from anywhere to anywhere.
std::vector<std::array<int, 2>> sheetOf(int nx, int ny) {
  std::vector<std::array<int, 2>> ends;
  const int ways[][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}, {2, 0}, {0, 2}};
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      for (const auto& [di, dj] : ways) {
        if (i + di < 0 || i + di >= nx || j + dj >= ny || (7 * i + 5 * j + di) % 11 == 0) continue;
        ends.push_back({i + j * nx, i + di + (j + dj) * nx});
      }
  const int last = nx * ny - 1;
  for (int k = 0; k < 5; ++k) ends.push_back({3 * k, last - 4 * k});
  ends.push_back(ends.front());  // twice between the same two
  return ends;
}

template <class Number>
double worstError(int nx, int ny, bool withMass, int threads = 1) {
  const std::vector<std::array<int, 2>> ends = sheetOf(nx, ny);
  const int nodes = nx * ny;
  SpringBands bands;
  bands.layOut(nodes, ends);
  EXPECT_FALSE(bands.bands().empty());
  EXPECT_GE(bands.looseEnds().size(), 6u);
  SpringMatrices m;
  m.assign(bands.slots());
  std::vector<char> taken(bands.slots(), 0);
  for (int k = 0; k < static_cast<int>(ends.size()); ++k) {
    const int slot = bands.slotOf(k);
    EXPECT_FALSE(taken[slot]);
    taken[slot] = 1;
    m.xx[slot] = static_cast<float>(1 + std::sin(k)), m.xy[slot] = static_cast<float>(std::cos(3 * k));
    m.yy[slot] = static_cast<float>(2 + std::sin(5 * k));
  }
  NodeField<Number> p, out;
  bands.makeField(p), bands.makeField(out);
  std::vector<Number> mass(bands.nodes(), 0);
  for (int k = 0; k < nodes; ++k) {
    p.x()[k] = static_cast<Number>(std::sin(2 * k)), p.y()[k] = static_cast<Number>(std::cos(7 * k));
    mass[k] = static_cast<Number>(1 + k % 3);
  }
  ThreadPool pool(threads);
  const double product = bands.multiply(m, withMass ? mass.data() : nullptr, p, out, pool);

  std::vector<double> x(nodes, 0), y(nodes, 0);
  for (int k = 0; k < nodes && withMass; ++k) x[k] = mass[k] * p.x()[k], y[k] = mass[k] * p.y()[k];
  for (int k = 0; k < static_cast<int>(ends.size()); ++k) {
    const auto [a, b] = ends[k];
    const int slot = bands.slotOf(k);
    const double dx = p.x()[b] - p.x()[a], dy = p.y()[b] - p.y()[a];
    const double pullX = m.xx[slot] * dx + m.xy[slot] * dy, pullY = m.xy[slot] * dx + m.yy[slot] * dy;
    x[a] -= pullX, y[a] -= pullY;
    x[b] += pullX, y[b] += pullY;
  }
  double worst = 0, sum = 0;
  for (int k = 0; k < nodes; ++k) {
    worst = std::max({worst, std::fabs(out.x()[k] - x[k]), std::fabs(out.y()[k] - y[k])});
    sum += p.x()[k] * x[k] + p.y()[k] * y[k];
  }
  for (int k = nodes; k < bands.nodes(); ++k) EXPECT_EQ(out.x()[k], 0);
  return std::max(worst, std::fabs(product / sum - 1));
}

TEST(SpringBands, MultiplyAsTheSumOverSpringsDoes) {
  // Truth: each spring pulls at both its ends, in a band with holes or loose, with any number of nodes and of
  // columns fewer than lanes; to the digits of the numbers.
  for (const int columns : {3, 7, 8, 21})
    for (const int rows : {9, 14})
      for (const bool withMass : {false, true}) {
        EXPECT_LT(worstError<double>(columns, rows, withMass), 1e-13) << columns << " x " << rows;
        EXPECT_LT(worstError<float>(columns, rows, withMass), 1e-4) << columns << " x " << rows;
      }
  EXPECT_LT(worstError<double>(101, 83, true, 3), 1e-12);  // in several parts
}

}  // namespace
}  // namespace smokebox
