// Smoke carried by velocities that are known exactly: shape, order of convergence, bounds and conservation.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "base/maths.h"
#include "fluid/smoke.h"

namespace smokebox {
namespace {

Boundary emptyBox(int nx, int ny, double h, WallKind kind = WallKind::slip) {
  Boundary b;
  b.grid = {nx, ny, h};
  for (SideFlow& s : b.sides) s.kind = kind;
  b.openX = Field(nx, ny, 1);
  b.openY = Field(nx, ny, 1);
  b.volume = Field(nx, ny, 1);
  b.wallU = Field(nx, ny, 0);
  b.wallV = Field(nx, ny, 0);
  if (kind == WallKind::slip) {
    for (int j = 0; j < ny; ++j) b.openX(0, j) = b.openX(nx, j) = 0;
    for (int i = 0; i < nx; ++i) b.openY(i, 0) = b.openY(i, ny) = 0;
  }
  b.version = 1;
  return b;
}

// Velocities on the faces from a stream function: free of divergence to rounding.
template <class Stream>
void setFlow(const Grid& g, Stream psi, Field& u, Field& v) {
  for (int j = 0; j <= g.ny; ++j)
    for (int i = 0; i <= g.nx; ++i) {
      const double x = i * g.h, y = j * g.h;
      if (j < g.ny) u(i, j) = static_cast<float>((psi(x, y + g.h) - psi(x, y)) / g.h);
      if (i < g.nx) v(i, j) = static_cast<float>(-(psi(x + g.h, y) - psi(x, y)) / g.h);
    }
}

Field cellMeans(const Grid& g, const std::function<double(double, double)>& f) {
  Field mean(g.nx, g.ny);
  constexpr int kSamples = 8;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      double sum = 0;
      for (int q = 0; q < kSamples; ++q)
        for (int p = 0; p < kSamples; ++p)
          sum += f((i + (p + 0.5) / kSamples) * g.h, (j + (q + 0.5) / kSamples) * g.h);
      mean(i, j) = static_cast<float>(sum / (kSamples * kSamples));
    }
  return mean;
}

struct Difference {
  double relative, mean, most;
};

Difference difference(const Field& a, const Field& truth) {
  double sum = 0, all = 0, most = 0;
  for (int j = 0; j < a.ny(); ++j)
    for (int i = 0; i < a.nx(); ++i) {
      const double d = std::fabs(a(i, j) - truth(i, j));
      sum += d;
      all += truth(i, j);
      most = std::max(most, d);
    }
  return {sum / all, sum / (double(a.nx()) * a.ny()), most};
}

double slottedDisk(double x, double y) {
  return std::hypot(x - 0.5, y - 0.75) < 0.15 && !(std::fabs(x - 0.5) < 0.025 && y < 0.85) ? 1 : 0;
}

TEST(SmokeTransport, SlottedDiskKeepsItsShapeOverOneTurn) {
  // A rigid rotation by one full turn changes nothing (Zalesak 1979).
  const int n = 200;
  Boundary b = emptyBox(n, n, 1.0 / n);
  ThreadPool pool(1);
  Smoke smoke(b, pool, 1);
  Field u(n, n), v(n, n);
  setFlow(
      b.grid, [](double x, double y) { return -kPi * ((x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5)); }, u,
      v);
  for (int j = 0; j < n; ++j) u(0, j) = u(n, j) = 0;  // the closed walls
  const Field truth = cellMeans(b.grid, slottedDisk);
  smoke.add(b, 0, truth, 1);
  const int steps = static_cast<int>(std::ceil(kPi / (0.5 / n)));
  for (int k = 0; k < steps; ++k) smoke.transport(b, u, v, 1.0 / steps);
  const Difference d = difference(smoke.value(0), truth);
  const Smoke::Totals t = smoke.totals();
  std::printf("slotted disk 200x200, CFL 0.5: E1 %.4f, values %.3g to 1 + %.3g, mass error %.3g\n",
              d.relative, t.min, t.max - 1, (t.mass - t.emitted) / t.emitted);
  EXPECT_LE(d.relative, 0.1);
  EXPECT_GE(t.min, 0);
  EXPECT_LE(t.max, 1 + 1e-6);
  EXPECT_EQ(t.mass, t.emitted);
}

double reversedVortex(int n, double period, double cfl) {
  Boundary b = emptyBox(n, n, 1.0 / n);
  ThreadPool pool(1);
  Smoke smoke(b, pool, 1);
  const Field truth = cellMeans(b.grid, [](double x, double y) {
    const double a = x - 0.3, c = y - 0.263662;
    return std::exp(-100 * (a * a + c * c));
  });
  smoke.add(b, 0, truth, 1);
  Field u(n, n), v(n, n);
  const int steps = static_cast<int>(std::ceil(period * 1.5 * n / cfl));
  const double dt = period / steps;
  for (int k = 0; k < steps; ++k) {
    const double s = -1.5 * std::sin(2 * kPi * (k + 0.5) * dt / period) / kPi;
    setFlow(
        b.grid, [s](double x, double y) { return s * std::sin(kPi * x) * std::sin(kPi * y); }, u, v);
    smoke.transport(b, u, v, dt);
  }
  return difference(smoke.value(0), truth).mean;
}

TEST(SmokeTransport, ReversedVortexComesBack) {
  // The flow is undone in the second half: the smoke returns to where it was.
  const double error = reversedVortex(128, 5, 0.5);
  std::printf("reversed vortex at 128: mean error %.3g\n", error);
  EXPECT_LE(error, 2e-4);
}

TEST(SmokeTransport, ConvergesOnASmoothProfile) {
  // A smooth blob in a mildly shearing flow and back: the error falls with the third power of the cell (less
  // where it is small already: the sweeps along x and y are put together to second order).
  double first = 0, last = 0;
  for (int n : {48, 96, 192}) {
    last = reversedVortex(n, 1, 0.5);
    if (first == 0) first = last;
    std::printf("smooth blob at %3d: mean error %.3g\n", n, last);
  }
  EXPECT_LE(last, 1e-6);
  EXPECT_GE(0.5 * std::log2(first / last), 2.8);
}

TEST(SmokeTransport, FullBoxStaysFull) {
  // A box full of smoke at 1 stays at 1 in any flow free of divergence.
  const int n = 64;
  Boundary b = emptyBox(n, n, 1.0 / n);
  ThreadPool pool(1);
  Smoke smoke(b, pool, 1);
  Field u(n, n), v(n, n), all(n, n, 1);
  smoke.add(b, 0, all, 1);
  setFlow(
      b.grid, [](double x, double y) { return std::sin(kPi * x) * std::sin(kPi * y) * std::sin(3 * x + y); },
      u, v);
  for (int k = 0; k < 1000; ++k) smoke.transport(b, u, v, 0.25 / n);
  const Smoke::Totals t = smoke.totals();
  std::printf("full box, 1000 steps: 1 - %.3g to 1 + %.3g\n", 1 - t.min, t.max - 1);
  EXPECT_GE(t.min, 1 - 1e-3);
  EXPECT_LE(t.max, 1 + 1e-6);
  EXPECT_EQ(t.mass, t.emitted);
}

TEST(SmokeTransport, PeriodicShiftComesBack) {
  // Uniform flow through periodic sides by one whole width brings everything back.
  const int n = 96;
  Boundary b = emptyBox(n, n, 1.0 / n, WallKind::periodic);
  ThreadPool pool(1);
  Smoke smoke(b, pool, 1);
  Field u(n, n, 1), v(n, n, 0.5f);
  const Field truth = cellMeans(b.grid, [](double x, double y) {
    return 0.5 + 0.25 * std::sin(2 * kPi * x) + 0.25 * std::sin(2 * kPi * (x + 2 * y));
  });
  smoke.add(b, 0, truth, 1);
  const int steps = 2 * n * 5 / 4;
  for (int k = 0; k < steps; ++k) smoke.transport(b, u, v, 2.0 / steps);
  const Difference d = difference(smoke.value(0), truth);
  const Smoke::Totals t = smoke.totals();
  std::printf("periodic shift: mean error %.3g, largest (a clipped crest) %.3g\n", d.mean, d.most);
  EXPECT_LE(d.mean, 1e-4);
  EXPECT_LE(d.most, 5e-3);
  EXPECT_EQ(t.mass, t.emitted);
}

TEST(SmokeTransport, LedgerOfOpenSidesCloses) {
  // What was emitted is there or has left, to the last bit; the clean air of the inflow brings nothing.
  const int nx = 80, ny = 48;
  Boundary b = emptyBox(nx, ny, 1.0 / ny, WallKind::open);
  ThreadPool pool(1);
  Smoke smoke(b, pool, 2);
  Field u(nx, ny), v(nx, ny), spot(nx, ny);
  for (int j = 10; j < 30; ++j)
    for (int i = 5; i < 20; ++i) spot(i, j) = 0.7f;
  setFlow(
      b.grid, [](double x, double y) { return y - 0.3 * x + 0.05 * std::sin(9 * x) * std::cos(7 * y); }, u,
      v);
  for (int k = 0; k < 1000; ++k) {
    if (k < 300) smoke.add(b, 0, spot, 0.013);
    if (k == 50) smoke.add(b, 1, spot, 3.7);
    smoke.transport(b, u, v, 0.6 / ny);
    const Smoke::Totals t = smoke.totals();
    ASSERT_NEAR(t.mass + t.left, t.emitted, 1e-12 * t.emitted + 1e-300);
    ASSERT_GE(t.min, 0);
  }
  const Smoke::Totals t = smoke.totals();
  std::printf("open sides: error %.3g, left %.6f of %.6f\n", (t.mass + t.left - t.emitted) / t.emitted,
              t.left, t.emitted);
  EXPECT_GT(t.left, 0.999 * t.emitted);
}

TEST(SmokeTransport, ManySmallAmountsAddUp) {
  // A source that adds 0.7 / 60 for 600 steps makes 7, and no more: rounding to whole quanta, each of them up
  // to 5e-5 of such an amount, does not add up.
  const int n = 16;
  Boundary b = emptyBox(n, n, 1.0 / n);
  ThreadPool pool(1);
  Smoke smoke(b, pool, 1);
  const Field all(n, n, 1);
  for (int k = 0; k < 600; ++k) smoke.add(b, 0, all, 0.7 / 60);
  const Smoke::Totals t = smoke.totals();
  std::printf("600 amounts: 7 (1 + %.3g), mass %.3g\n", t.max / 7 - 1, t.mass / 7 - 1);
  EXPECT_LE(t.max, 7);
  EXPECT_NEAR(t.max, 7, 7e-6);
  EXPECT_NEAR(t.mass, 7, 7e-6);
}

TEST(SmokeTransport, LargeCourantNumbersAreStable) {
  // At a Courant number of 5 the step is cut into parts: bounds and mass hold, and the disk keeps its place.
  const int n = 128;
  Boundary b = emptyBox(n, n, 1.0 / n);
  ThreadPool pool(1);
  Smoke smoke(b, pool, 1);
  Field u(n, n), v(n, n);
  setFlow(
      b.grid, [](double x, double y) { return std::sin(kPi * x) * std::sin(kPi * y); }, u, v);
  smoke.add(b, 0, cellMeans(b.grid, slottedDisk), 1);
  for (int k = 0; k < 100; ++k) smoke.transport(b, u, v, 5.0 / (kPi * n));
  const Smoke::Totals t = smoke.totals();
  EXPECT_GE(t.min, 0);
  EXPECT_LE(t.max, 1 + 1e-6);
  EXPECT_EQ(t.mass, t.emitted);
}

}  // namespace
}  // namespace smokebox
