#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fluid/multigrid.h"
#include "fluid/regions.h"
#include "unit/pressure_cases.h"

namespace smokebox {
namespace {

using namespace pressure_cases;

/// Noise that adds up to 0 over each sealed region, row by row.
std::vector<float> balancedNoise(const Boundary& boundary, const Multigrid& multigrid, std::uint64_t seed) {
  Regions regions;
  regions.rebuild(boundary, multigrid.finest());
  Random random(seed);
  const int nx = boundary.grid.nx;
  std::vector<float> f(static_cast<std::size_t>(boundary.grid.cells()), 0);
  std::vector<double> sums(regions.regions().size(), 0);
  for (const Regions::Run& run : regions.runs())
    for (int i = run.begin; i < run.end; ++i)
      sums[run.region] += f[run.j * nx + i] = static_cast<float>(random() - 0.5);
  for (const Regions::Run& run : regions.runs()) {
    const Regions::Region& region = regions.regions()[run.region];
    for (int i = run.begin; i < run.end && region.sealed; ++i)
      f[run.j * nx + i] -= static_cast<float>(sums[run.region] / static_cast<double>(region.cells));
  }
  return f;
}

std::vector<float> cycleOf(Multigrid& multigrid, const std::vector<float>& f) {
  multigrid::Level& level = multigrid.finest();
  for (int j = 0; j < level.ny; ++j) std::copy_n(f.data() + j * level.nx, level.nx, level.row(level.b, j));
  multigrid.cycle();
  std::vector<float> x;
  for (int j = 0; j < level.ny; ++j) {
    const float* row = level.row(level.x, j);
    x.insert(x.end(), row, row + level.nx);
  }
  return x;
}

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += static_cast<double>(a[k]) * b[k];
  return sum;
}

TEST(Multigrid, IsSymmetricAndPositive) {
  // f . M g = g . M f and f . M f > 0, as conjugate gradients need it: for any size, sides and solids.
  struct Case {
    int nx, ny, solids;
    WallKind x, y;
  };
  using enum WallKind;
  for (const Case& c :
       {Case{128, 128, 0, slip, slip}, Case{128, 96, 40, slip, slip}, Case{131, 77, 120, slip, slip},
        Case{64, 64, 30, periodic, periodic}, Case{90, 61, 10, open, slip}}) {
    Boundary b = emptyBox(c.nx, c.ny);
    b.sides[0].kind = b.sides[1].kind = c.x;
    b.sides[2].kind = b.sides[3].kind = c.y;
    putSolids(b, randomSolids(c.solids, b.grid.width(), b.grid.height(), b.grid.h));
    closeSides(b);
    ThreadPool pool(1);
    Multigrid multigrid(b, pool);
    const std::vector<float> f = balancedNoise(b, multigrid, 1), g = balancedNoise(b, multigrid, 2);
    const std::vector<float> mf = cycleOf(multigrid, f), mg = cycleOf(multigrid, g);
    const double scale = std::sqrt(dot(f, mf) * dot(g, mg));
    EXPECT_GT(dot(f, mf), 0);
    EXPECT_NEAR(dot(f, mg) / scale, dot(g, mf) / scale, 1e-6)
        << c.nx << "x" << c.ny << " solids " << c.solids;
  }
}

TEST(Multigrid, MeasuresWhatConjugateGradientsNeed) {
  // The products that a cycle returns are x b and the sum over all faces of  open (difference of x)^2.
  for (const int threads : {1, 2}) {
    Boundary b = emptyBox(256, 192);
    b.sides[3].kind = WallKind::open;
    putSolids(b, randomSolids(20, b.grid.width(), b.grid.height(), b.grid.h));
    closeSides(b);
    ThreadPool pool(threads);
    Multigrid multigrid(b, pool);
    multigrid::Level& level = multigrid.finest();
    const std::vector<float> f = balancedNoise(b, multigrid, 1);
    for (int j = 0; j < level.ny; ++j) std::copy_n(f.data() + j * level.nx, level.nx, level.row(level.b, j));
    const Multigrid::Products found = multigrid.cycle();
    double slope = 0, bent = 0;
    for (int j = 0; j <= level.ny; ++j)
      for (int i = 0; i <= level.nx; ++i) {
        const auto x = [&](int p, int q) { return static_cast<double>(level.x[level.at(p, q)]); };
        if (i < level.nx && j < level.ny) slope += x(i, j) * level.b[level.at(i, j)];
        if (j < level.ny) bent += b.openX(i, j) * std::pow(x(i, j) - x(i - 1, j), 2);
        if (i < level.nx) bent += b.openY(i, j) * std::pow(x(i, j) - x(i, j - 1), 2);
      }
    EXPECT_NEAR(found.withResidual / slope, 1, 1e-6);
    EXPECT_NEAR(found.curvature / bent, 1, 1e-4);
  }
}

TEST(Multigrid, KeepsSidesOfAThinWallApart) {
  // A wall of no thickness across the whole box makes two regions: what is on one side never shows on the
  // other.
  Boundary b = emptyBox(67, 45);
  for (int j = 0; j < 45; ++j) b.openX(33, j) = 0;
  closeSides(b);
  ThreadPool pool(1);
  Multigrid multigrid(b, pool);
  std::vector<float> f(67 * 45, 0);
  f[10 * 67 + 20] = 1;
  f[30 * 67 + 30] = -1;
  const std::vector<float> x = cycleOf(multigrid, f);
  double left = 0, right = 0;
  for (int j = 0; j < 45; ++j)
    for (int i = 0; i < 67; ++i) (i < 33 ? left : right) += std::fabs(x[j * 67 + i]);
  EXPECT_GT(left, 1);
  EXPECT_EQ(right, 0);
}

TEST(Regions, AreFoundWhateverTheirShape) {
  // Regions are joined through open faces only, across periodic seams too, and are sealed if none has an open
  // side.
  Boundary b = emptyBox(40, 30);
  for (int j = 0; j < 30; ++j) b.openX(10, j) = b.openX(25, j) = 0;
  for (int i = 25; i < 40; ++i) b.openY(i, 12) = 0;
  b.openX(30, 20) = b.openX(31, 20) = b.openY(30, 20) = b.openY(30, 21) = 0;  // a cell by itself: no region
  b.sides[1].kind = WallKind::open;
  closeSides(b);
  for (int j = 0; j < 12; ++j) b.openX(40, j) = 0;
  ThreadPool pool(1);
  Multigrid multigrid(b, pool);
  Regions regions;
  regions.rebuild(b, multigrid.finest());
  ASSERT_EQ(regions.regions().size(), 4u);
  EXPECT_TRUE(regions.regions()[0].sealed);
  EXPECT_EQ(regions.regions()[0].cells, 300);
  EXPECT_EQ(regions.regions()[1].cells, 450);
  EXPECT_TRUE(regions.regions()[2].sealed);
  EXPECT_EQ(regions.regions()[2].cells, 15 * 12);
  EXPECT_FALSE(regions.regions()[3].sealed);
  EXPECT_EQ(regions.regions()[3].cells, 15 * 18 - 1);

  b.sides[0].kind = b.sides[1].kind = WallKind::periodic;
  for (int j = 0; j < 30; ++j) b.openX(0, j) = b.openX(40, j) = 1;
  Multigrid wrapped(b, pool);
  regions.rebuild(b, wrapped.finest());
  EXPECT_EQ(regions.regions().size(), 2u);  // the three that meet at the seam are one
}

}  // namespace
}  // namespace smokebox
