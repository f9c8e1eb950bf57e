#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "fluid/pressure.h"
#include "unit/pressure_cases.h"

namespace smokebox {
namespace {

using namespace pressure_cases;

struct Outcome {
  PressureSolver::Result result;
  Field u, v, phi;
};

Outcome projectOn(int threads, const Boundary& boundary, const Field& u, const Field& v,
                  double tolerance = 1e-5, int maxIterations = 60) {
  ThreadPool pool(threads);
  PressureSolver solver(boundary, pool);
  Outcome o{{}, u, v, Field(boundary.grid.nx, boundary.grid.ny)};
  o.result = solver.project(boundary, o.u, o.v, o.phi, 1e-9, tolerance, maxIterations);
  return o;
}

bool sameBits(const Field& a, const Field& b) {
  for (int j = 0; j < a.ny(); ++j)
    if (std::memcmp(a.row(j), b.row(j), a.nx() * sizeof(float)) != 0) return false;
  return true;
}

Boundary withSides(int nx, int ny, WallKind left, WallKind right, WallKind bottom, WallKind top, int solids) {
  Boundary b = emptyBox(nx, ny);
  b.sides[0].kind = left;
  b.sides[1].kind = right;
  b.sides[2].kind = bottom;
  b.sides[3].kind = top;
  putSolids(b, randomSolids(solids, b.grid.width(), b.grid.height(), b.grid.h, nx + ny));
  closeSides(b);
  return b;
}

TEST(PressureSolver, RemovesTheDivergenceOfNoiseAtAnySize) {
  // Whatever the size and however the solids lie, no cell is left with more than the tolerance.
  const int sizes[][2] = {{8, 8},    {9, 8},    {16, 16},   {17, 33}, {31, 8},
                          {100, 57}, {129, 64}, {250, 141}, {500, 9}};
  for (const auto& size : sizes)
    for (int solids : {0, 3, 25}) {
      const Boundary b = boxWithSolids(size[0], size[1], solids, size[0]);
      Field u, v;
      shake(b, u, v, 5);
      const Outcome o = projectOn(1, b, u, v);
      EXPECT_TRUE(o.result.converged) << size[0] << "x" << size[1] << " solids " << solids;
      if (o.result.compression * b.grid.h < 1e-8) {
        EXPECT_LE(worstDivergence(b, o.u, o.v), 1.02e-5) << size[0] << "x" << size[1] << " solids " << solids;
      }
    }
}

TEST(PressureSolver, HoldsForEveryKindOfSide) {
  // Open, periodic and closed sides in any mixture: the divergence goes below the tolerance, seams included.
  using enum WallKind;
  const int sizes[][2] = {{64, 48}, {33, 47}, {45, 70}, {14, 11}};
  const WallKind kinds[][4] = {{periodic, periodic, slip, noSlip},
                               {slip, slip, periodic, periodic},
                               {periodic, periodic, periodic, periodic},
                               {open, open, open, open},
                               {inflow, open, slip, slip},
                               {periodic, periodic, slip, open},
                               {open, slip, periodic, periodic},
                               {slip, slip, slip, open}};
  for (const auto& size : sizes)
    for (const auto& k : kinds)
      for (int solids : {0, 12}) {
        const Boundary b = withSides(size[0], size[1], k[0], k[1], k[2], k[3], solids);
        Field u, v;
        shake(b, u, v, 11);
        const Outcome o = projectOn(1, b, u, v, 1e-6);
        EXPECT_TRUE(o.result.converged)
            << size[0] << "x" << size[1] << " solids " << solids << " sides " << int(k[0]) << int(k[1])
            << int(k[2]) << int(k[3]) << " it " << o.result.iterations;
        EXPECT_LE(o.result.iterations, 30);
        if (o.result.compression * b.grid.h < 1e-8) {
          EXPECT_LE(worstDivergence(b, o.u, o.v), 1.1e-6);
        }
        EXPECT_TRUE(!b.periodicX() || o.u(0, 3) == o.u(b.grid.nx, 3));
        EXPECT_TRUE(!b.periodicY() || o.v(3, 0) == o.v(3, b.grid.ny));
      }
}

TEST(PressureSolver, TakesOffTheWholeOfAGradient) {
  // The gradient of a known potential is removed entirely, and phi is that potential up to a constant.
  const Boundary b = boxWithSolids(96, 80, 0);
  Field u(96, 80), v(96, 80), potential(96, 80);
  for (int j = 0; j < 80; ++j)
    for (int i = 0; i < 96; ++i)
      potential(i, j) = static_cast<float>(std::cos(0.1 * i) * std::sin(0.07 * j + 0.3));
  for (int j = 0; j < 80; ++j)
    for (int i = 0; i < 96; ++i) {
      if (i > 0) u(i, j) = potential(i, j) - potential(i - 1, j);
      if (j > 0) v(i, j) = potential(i, j) - potential(i, j - 1);
    }
  const Outcome o = projectOn(1, b, u, v, 1e-7);
  double worst = 0, mean = 0;
  for (int j = 0; j < 80; ++j)
    for (int i = 0; i < 96; ++i) {
      worst = std::max(
          {worst, std::fabs(static_cast<double>(o.u(i, j))), std::fabs(static_cast<double>(o.v(i, j)))});
      mean += potential(i, j) / (96.0 * 80.0);
    }
  EXPECT_LT(worst, 1e-5);
  for (int j = 0; j < 80; j += 7)
    for (int i = 0; i < 96; i += 5) EXPECT_NEAR(o.phi(i, j), potential(i, j) - mean, 1e-4);
}

TEST(PressureSolver, LeavesADivergenceFreeFieldAlone) {
  // What is within the tolerance already is not touched, and costs no iteration.
  const Boundary b = boxWithSolids(120, 64, 20);
  Field u, v;
  stir(b, u, v);
  Outcome o = projectOn(1, b, u, v, 1e-6);
  const Outcome again = projectOn(1, b, o.u, o.v, 1e-5);
  EXPECT_EQ(again.result.iterations, 0);
  EXPECT_TRUE(again.result.converged);
  EXPECT_TRUE(sameBits(o.u, again.u));
  EXPECT_TRUE(sameBits(o.v, again.v));
}

TEST(PressureSolver, SpreadsAPistonOverItsPocket) {
  // In a sealed pocket of w x l cells a face wall moving in at speed s changes the area at the rate s / l.
  Boundary b = emptyBox(48, 40, 2.0);
  const double h = b.grid.h;
  for (int j = 0; j < 40; ++j)
    for (int i = 0; i < 48; ++i) {
      const bool inside = i >= 10 && i < 30 && j >= 5 && j < 17;
      const bool outside = i < 9 || i > 30 || j < 4 || j > 17;
      if (!inside && !outside) b.volume(i, j) = 0;
      if (!inside && !outside) b.openX(i, j) = b.openX(i + 1, j) = b.openY(i, j) = b.openY(i, j + 1) = 0;
    }
  for (int j = 5; j < 17; ++j) b.wallU(10, j) = 0.3f;  // the pocket's left wall moves to the right
  closeSides(b);
  Field u, v;
  shake(b, u, v, 3);
  const Outcome o = projectOn(1, b, u, v, 1e-6);
  EXPECT_TRUE(o.result.converged);
  const double rate = 0.3f / (20 * h);
  EXPECT_NEAR(o.result.compression, rate, 1e-5 * rate);
  for (int j = 5; j < 17; j += 3)
    for (int i = 10; i < 30; i += 3) EXPECT_NEAR(netFlux(b, o.u, o.v, i, j), -rate * h, 2e-6);
  EXPECT_NEAR(netFlux(b, o.u, o.v, 2, 2), 0, 2e-6);  // the outside is another region
  EXPECT_FLOAT_EQ(o.u(10, 8), 0.3f);                 // the fluid follows the wall
  double mean = 0;
  for (int j = 5; j < 17; ++j)
    for (int i = 10; i < 30; ++i) mean += o.phi(i, j) / (20.0 * 12.0);
  EXPECT_NEAR(mean, 0, 1e-5);
}

TEST(PressureSolver, LetsAnInflowOutThroughAnOpenSide) {
  // What an inflow brings in leaves through the open side opposite, and nothing is compressed.
  Boundary b = withSides(60, 30, WallKind::inflow, WallKind::open, WallKind::slip, WallKind::slip, 0);
  for (int j = 0; j < 30; ++j) b.wallU(0, j) = 1.5f;
  const Outcome o = projectOn(1, b, Field(60, 30), Field(60, 30), 1e-6);
  EXPECT_TRUE(o.result.converged);
  EXPECT_EQ(o.result.compression, 0);
  for (int j = 0; j < 30; ++j)
    for (int i = 0; i <= 60; i += 6) EXPECT_NEAR(o.u(i, j), 1.5, 1e-4);
}

TEST(PressureSolver, StandsSmallShares) {
  // Faces that are open by only a thousandth, alone or all around a cell, do not keep it from converging.
  Boundary b = emptyBox(70, 50);
  Random random(9);
  for (int j = 0; j < 50; ++j)
    for (int i = 0; i < 70; ++i) {
      if (random() < 0.15) b.openX(i, j) = 1e-3f;
      if (random() < 0.15) b.openY(i, j) = 1e-3f;
      if (random() < 0.05) b.openX(i, j) = b.openY(i, j) = 0;
    }
  for (int k = 20; k < 24; ++k) b.openX(k, 20) = b.openX(k + 1, 20) = b.openY(k, 20) = b.openY(k, 21) = 1e-3f;
  closeSides(b);
  Field u, v;
  shake(b, u, v, 4);
  const Outcome o = projectOn(1, b, u, v);
  EXPECT_TRUE(o.result.converged);
  EXPECT_LE(o.result.iterations, 25);
  EXPECT_LE(worstDivergence(b, o.u, o.v), 1.02e-5);
}

TEST(PressureSolver, KeepsToItsIterationsBesideThinWalls) {
  // Forty solids of all sizes, thin walls and slivers among them, cost no more than nine iterations from a
  // cold start to a divergence of 1e-5, and ten to 1e-6, wherever they lie and at any resolution.
  for (int n : {128, 256, 512, 1024})
    for (int seed = 7; seed < (n > 512 ? 8 : 11); ++seed) {
      const Boundary b = boxWithSolids(n, n == 512 ? 288 : n, 40, seed);
      Field u, v;
      stir(b, u, v);
      const Outcome o = projectOn(1, b, u, v);
      EXPECT_TRUE(o.result.converged);
      EXPECT_LE(o.result.iterations, 10) << n << " seed " << seed;
      const Outcome tight = projectOn(1, b, u, v, 1e-6);
      EXPECT_TRUE(tight.result.converged);
      EXPECT_LE(tight.result.iterations, 12) << n << " seed " << seed;
    }
}

TEST(PressureSolverSlow, KeepsToItsIterationsOnALargeGrid) {
  // Nor at 2048 x 2048, where phi is so much larger than its differences that float32 rounds the residual off
  // by more than the tolerance: one or two more.
  for (int seed : {7, 8, 9}) {
    const Boundary b = boxWithSolids(2048, 2048, 40, seed);
    Field u, v;
    stir(b, u, v);
    const Outcome o = projectOn(1, b, u, v);
    EXPECT_TRUE(o.result.converged);
    EXPECT_LE(o.result.iterations, 11) << seed;
    EXPECT_LE(worstDivergence(b, o.u, o.v), 1.02e-5);
  }
}

TEST(PressureSolver, StandsManySealedRegions) {
  // Two hundred solids enclose dozens of regions of every size; rounding in one does not hold up the others.
  const Boundary b = boxWithSolids(512, 512, 200);
  Field u, v;
  stir(b, u, v);
  for (double tolerance : {1e-5, 1e-7}) {
    const Outcome o = projectOn(1, b, u, v, tolerance);
    EXPECT_TRUE(o.result.converged);
    EXPECT_LE(o.result.iterations, tolerance > 1e-6 ? 20 : 28) << tolerance;
  }
}

TEST(PressureSolver, NeedsFewIterationsFromAWarmStart) {
  // After a small change of the velocity a few iterations are enough.
  const Boundary b = boxWithSolids(256, 144, 40);
  Field u, v, du, dv;
  stir(b, u, v);
  Outcome o = projectOn(1, b, u, v);
  shake(b, du, dv, 8);
  for (int j = 0; j <= 144; ++j)
    for (int i = 0; i <= 256; ++i) {
      o.u(i, j) += 1e-3f * du(i, j);
      o.v(i, j) += 1e-3f * dv(i, j);
    }
  const Outcome warm = projectOn(1, b, o.u, o.v);
  EXPECT_TRUE(warm.result.converged);
  EXPECT_LE(warm.result.iterations, 5);
}

TEST(PressureSolver, GivesTheSameBitsOnAnyNumberOfThreads) {
  // The result is the same to the bit on one, two and three threads, with and without a seam.
  for (bool periodic : {false, true}) {
    const WallKind k = periodic ? WallKind::periodic : WallKind::slip;
    const Boundary b = withSides(301, 217, k, k, k, k, 30);
    Field u, v;
    shake(b, u, v, 21);
    const Outcome one = projectOn(1, b, u, v);
    for (int threads : {2, 3}) {
      const Outcome more = projectOn(threads, b, u, v);
      EXPECT_EQ(one.result.divergence, more.result.divergence);
      EXPECT_TRUE(sameBits(one.u, more.u));
      EXPECT_TRUE(sameBits(one.v, more.v));
      EXPECT_TRUE(sameBits(one.phi, more.phi));
    }
  }
}

TEST(PressureSolver, FollowsSolidsThatMove) {
  // A solver rebuilt for other solids gives to the bit what a new one gives.
  const Boundary first = boxWithSolids(150, 110, 30, 1), second = boxWithSolids(150, 110, 17, 2);
  ThreadPool pool(1);
  PressureSolver solver(first, pool);
  Outcome o{{}, {}, {}, Field(150, 110)};
  Field u, v;
  shake(first, u, v, 2);
  o.u = u;
  o.v = v;
  solver.project(first, o.u, o.v, o.phi, 1e-9, 1e-5, 60);
  solver.rebuild(second);
  o.u = u;
  o.v = v;
  o.phi.fill(0);
  solver.project(second, o.u, o.v, o.phi, 1e-9, 1e-5, 60);
  const Outcome fresh = projectOn(1, second, u, v);
  EXPECT_TRUE(sameBits(o.u, fresh.u));
  EXPECT_TRUE(sameBits(o.v, fresh.v));
  EXPECT_TRUE(sameBits(o.phi, fresh.phi));
}

TEST(PressureSolver, RoughProjectionTakesOffMostOfTheDivergence) {
  // Two cycles leave less than a tenth of the divergence, in the worst cell.
  const Boundary b = boxWithSolids(200, 120, 20);
  Field u, v;
  stir(b, u, v);
  ThreadPool pool(1);
  PressureSolver solver(b, pool);
  const double before = worstDivergence(b, u, v);
  solver.projectRoughly(b, u, v, 2);
  EXPECT_LT(worstDivergence(b, u, v), 0.1 * before);
}

TEST(PressureSolver, ReportsWhatIsNotANumber) {
  // A NaN in the velocity ends the solve at once, and is reported.
  const Boundary b = boxWithSolids(64, 64, 5);
  for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Field u, v;
    stir(b, u, v);
    u(33, 30) = bad;
    v(1, 1) = bad;
    const Outcome o = projectOn(1, b, u, v);
    EXPECT_FALSE(o.result.converged);
    EXPECT_TRUE(std::isnan(o.result.divergence));
  }
}

TEST(PressureSolver, KeepsToTheLargestNumberOfIterations) {
  // It stops after as many iterations as it may take, and says that it did not converge.
  const Boundary b = boxWithSolids(100, 100, 10);
  Field u, v;
  shake(b, u, v, 6);
  const Outcome o = projectOn(1, b, u, v, 1e-6, 3);
  EXPECT_EQ(o.result.iterations, 3);
  EXPECT_FALSE(o.result.converged);
  EXPECT_GT(o.result.divergence, 1e-6);
  EXPECT_LT(o.result.divergence, 0.5);
}

TEST(PressureSolver, EndsWhenAskedForMoreThanFloatsHold) {
  // A tolerance below the rounding of the velocity is not reached, but the solve ends.
  const Boundary b = boxWithSolids(128, 96, 10);
  Field u, v;
  stir(b, u, v);
  const Outcome o = projectOn(1, b, u, v, 1e-12, 1000);
  EXPECT_FALSE(o.result.converged);
  EXPECT_LT(o.result.iterations, 60);
  EXPECT_LT(o.result.divergence, 3e-7);
}

TEST(PressureSolver, IgnoresCellsWithoutAnOpenFace) {
  // Nothing happens where everything is closed, but that the faces take the walls' velocities.
  Boundary b = emptyBox(20, 20);
  b.openX.fill(0);
  b.openY.fill(0);
  b.volume.fill(0);
  b.wallU.fill(0.5f);
  Field u, v;
  shake(b, u, v, 1);
  const Outcome o = projectOn(1, b, u, v);
  EXPECT_TRUE(o.result.converged);
  EXPECT_EQ(o.result.iterations, 0);
  EXPECT_EQ(o.u(7, 7), 0.5f);
  EXPECT_EQ(o.v(7, 7), 0.0f);
}

}  // namespace
}  // namespace smokebox
