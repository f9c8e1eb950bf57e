// What a projection, a multigrid cycle and a rebuild cost: by size and number of solids. items = cells (x
// iterations).
#include <benchmark/benchmark.h>

#include "../unit/pressure_cases.h"
#include "fluid/multigrid.h"
#include "fluid/pressure.h"

namespace smokebox {
namespace {

using namespace pressure_cases;

Boundary boundaryOf(const benchmark::State& state) {
  return boxWithSolids(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)),
                       static_cast<int>(state.range(2)));
}

void BM_PressureCycle(benchmark::State& state) {
  const Boundary b = boundaryOf(state);
  ThreadPool pool(1);
  Multigrid multigrid(b, pool);
  multigrid::Level& level = multigrid.finest();
  level.row(level.b, level.ny / 2)[level.nx / 2] = 1;
  for (auto _ : state) benchmark::DoNotOptimize(multigrid.cycle());
  state.SetItemsProcessed(state.iterations() * b.grid.cells());
}

void BM_PressureRebuild(benchmark::State& state) {
  const Boundary b = boundaryOf(state);
  ThreadPool pool(1);
  PressureSolver solver(b, pool);
  for (auto _ : state) solver.rebuild(b);
  state.SetItemsProcessed(state.iterations() * b.grid.cells());
}

/// range(3): threads; range(4): 1 for a small change of a divergence-free velocity, 0 for a cold start.
void BM_PressureProject(benchmark::State& state) {
  const Boundary b = boundaryOf(state);
  ThreadPool pool(static_cast<int>(state.range(3)));
  PressureSolver solver(b, pool);
  Field u, v, phi(b.grid.nx, b.grid.ny);
  stir(b, u, v);
  if (state.range(4)) {
    solver.project(b, u, v, phi, 1e-9, 1e-5, 60);
    Field du, dv;
    shake(b, du, dv, 3);
    for (int j = 0; j <= b.grid.ny; ++j)
      for (int i = 0; i <= b.grid.nx; ++i) {
        u(i, j) += 1e-3f * du(i, j);
        v(i, j) += 1e-3f * dv(i, j);
      }
  }
  const Field u0 = u, v0 = v;
  PressureSolver::Result result;
  for (auto _ : state) {
    state.PauseTiming();
    u = u0;
    v = v0;
    state.ResumeTiming();
    result = solver.project(b, u, v, phi, 1e-9, 1e-5, 60);
  }
  state.counters["iterations"] = result.iterations;
  state.counters["divergence"] = result.divergence;
}

BENCHMARK(BM_PressureCycle)
    ->ArgsProduct({{512}, {288}, {0, 10, 40}})
    ->Args({1024, 1024, 0})
    ->Args({1024, 1024, 40})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_PressureRebuild)
    ->ArgsProduct({{512}, {288}, {0, 10, 40}})
    ->Args({1024, 1024, 40})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_PressureProject)
    ->ArgsProduct({{512}, {288}, {0, 10, 40}, {1, 2}, {0, 1}})
    ->Args({2048, 2048, 40, 1, 0})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace smokebox
