// Cost of one step of smoke, one colour, both sweeps, in nanoseconds a cell: smoke everywhere, or in a tenth
// of the domain.
#include <benchmark/benchmark.h>

#include <cmath>

#include "fluid/smoke.h"

namespace smokebox {
namespace {

void transport(benchmark::State& state, double filled) {
  const int n = static_cast<int>(state.range(0));
  Boundary b;
  b.grid = {n, n, 1.0 / n};
  for (SideFlow& s : b.sides) s.kind = WallKind::periodic;
  b.openX = b.openY = b.volume = Field(n, n, 1);
  b.wallU = b.wallV = Field(n, n, 0);
  ThreadPool pool(static_cast<int>(state.range(1)));
  Smoke smoke(b, pool, 1);
  const Field u(n, n, 0.6f), v(n, n, -0.4f);
  Field share(n, n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n * filled; ++i) share(i, j) = static_cast<float>((i * 7 + j * 13) % 64) / 64;
  smoke.add(b, 0, share, 1);
  for (auto _ : state) smoke.transport(b, u, v, filled < 1 ? 1e-3 / n : 1.0 / n);
  state.counters["ns_per_cell"] =
      benchmark::Counter(static_cast<double>(n) * n * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// A jet of 8 cells a step through smoke in a fifth of the domain, to and fro.
void smokeInAFastJet(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  Boundary b;
  b.grid = {n, n, 1.0 / n};
  for (SideFlow& s : b.sides) s.kind = WallKind::open;
  b.openX = b.openY = b.volume = Field(n, n, 1);
  b.wallU = b.wallV = Field(n, n, 0);
  ThreadPool pool(1);
  Smoke smoke(b, pool, 1);
  Field u(n, n), v(n, n), back(n, n), share(n, n);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = (i + 0.5) / n - 0.5;
      v(i, j) = static_cast<float>(8 * std::exp(-50 * x * x));
      back(i, j) = -v(i, j);
    }
  for (int j = n / 10; j < n * 8 / 10; ++j)
    for (int i = n * 35 / 100; i < n * 65 / 100; ++i)
      share(i, j) = static_cast<float>((i * 7 + j * 13) % 64) / 64;
  smoke.add(b, 0, share, 1);
  bool forth = true;
  for (auto _ : state) {
    smoke.transport(b, u, forth ? v : back, 1.0 / n);
    forth = !forth;
  }
  state.counters["ns_per_cell"] =
      benchmark::Counter(static_cast<double>(n) * n * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void smokeEverywhere(benchmark::State& state) { transport(state, 1); }
void smokeInATenth(benchmark::State& state) { transport(state, 0.1); }

BENCHMARK(smokeEverywhere)->Args({512, 1})->Args({1024, 1})->Args({1024, 2})->Unit(benchmark::kMillisecond);
BENCHMARK(smokeInAFastJet)->Arg(512)->Arg(1024)->Unit(benchmark::kMillisecond);
BENCHMARK(smokeInATenth)->Args({512, 1})->Args({1024, 1})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace smokebox
