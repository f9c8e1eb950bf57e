// What the stages of the velocity cost, in time a cell (the counter per_cell).
#include <benchmark/benchmark.h>

#include <cmath>

#include "base/maths.h"
#include "fluid/advection_kernel.h"
#include "fluid/extend.h"
#include "fluid/viscosity.h"
#include "fluid/vorticity.h"
#include "support/velocity_run.h"

namespace smokebox {
namespace {

using test::VelocityRun;

void perCell(benchmark::State& state, int n) {
  state.counters["per_cell"] =
      benchmark::Counter(static_cast<double>(n) * n,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void setSwirl(VelocityRun& run) {
  run.set([](Vec2 p) { return std::sin(kPi * p.x) * std::cos(kPi * p.y); },
          [](Vec2 p) { return -std::cos(kPi * p.x) * std::sin(kPi * p.y); });
  run.advection.extend(run.boundary, run.u, run.v);
}

Boundary withSolids(int n) {
  Boundary b = test::makeBox(n, n, 1.0 / n, test::kSlipBox);
  test::addSolid(
      b,
      [](Vec2 p) {
        const Vec2 q{p.x * 3 - std::floor(p.x * 3) - 0.5, p.y * 3 - std::floor(p.y * 3) - 0.5};
        return (length(q) - 0.25) / 3;
      },
      [](Vec2) { return Vec2{}; }, 1);
  return b;
}

/// Argument 1: cells along a side; 2: sides and solids: 0 slip box, 1 no-slip box, 2 slip box with nine
/// disks.
Boundary boundaryOf(const benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  if (state.range(1) == 2) return withSolids(n);
  const WallKind kind = state.range(1) == 0 ? WallKind::slip : WallKind::noSlip;
  return test::makeBox(n, n, 1.0 / n, {kind, kind, kind, kind});
}

/// One rate of both components: the kernel of a stage alone.
void velocityRate(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  VelocityRun run(test::makeBox(n, n, 1.0 / n, test::kSlipBox));
  setSwirl(run);
  Field outU(n, n), outV(n, n);
  AdvectionStage stage;
  stage.u = stage.baseU = &run.u, stage.v = stage.baseV = &run.v;
  stage.outU = &outU, stage.outV = &outV, stage.phi = &run.phi;
  stage.rateScale = 0.1f, stage.phiScale = 1;
  for (auto _ : state)
    for (int j = 0; j < n; j += 32) {
      advanceRowsOfU(stage, j, std::min(j + 32, n));
      advanceRowsOfV(stage, j, std::min(j + 32, n));
    }
  perCell(state, n);
}
BENCHMARK(velocityRate)->Arg(512)->Arg(1024)->Unit(benchmark::kMillisecond);

/// The whole of advance() but for the rough projection. Argument 3: steps of this Courant number, in tenths.
void velocityAdvance(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  VelocityRun run(boundaryOf(state));
  setSwirl(run);
  const Field u = run.u, v = run.v;
  const double dt = 0.1 * static_cast<double>(state.range(2)) / n;
  for (auto _ : state) {
    run.advection.advance(run.boundary, run.u, run.v, run.phi, nullptr, nullptr, dt,
                          [](Field&, Field&, int, double) {});
    state.PauseTiming();
    run.u = u, run.v = v;
    state.ResumeTiming();
  }
  perCell(state, n);
}
BENCHMARK(velocityAdvance)
    ->ArgsProduct({{512, 1024}, {0, 1, 2}, {8}})
    ->Args({512, 0, 100})
    ->Args({512, 2, 100})
    ->Unit(benchmark::kMillisecond);

void velocityRebuild(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  VelocityRun run(boundaryOf(state));
  for (auto _ : state) run.advection.rebuild(run.boundary);
  perCell(state, n);
}
BENCHMARK(velocityRebuild)->Args({512, 0})->Args({512, 2})->Unit(benchmark::kMillisecond);

void velocityExtension(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  VelocityRun run(boundaryOf(state));
  setSwirl(run);
  for (auto _ : state) run.advection.extend(run.boundary, run.u, run.v);
  perCell(state, n);
}
BENCHMARK(velocityExtension)->Args({512, 0})->Args({512, 2})->Unit(benchmark::kMillisecond);

/// Argument 3: nu dt / h^2, in tenths.
void velocityDiffuse(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  VelocityRun run(boundaryOf(state));
  setSwirl(run);
  Viscosity viscosity(run.boundary, run.pool);
  const Field u = run.u, v = run.v;
  Viscosity::Result result;
  for (auto _ : state) {
    result =
        viscosity.diffuse(run.boundary, run.u, run.v, 0.1 * static_cast<double>(state.range(2)) / n / n, 1);
    state.PauseTiming();
    run.u = u, run.v = v;
    state.ResumeTiming();
  }
  state.counters["iterations_of_cg"] = result.iterations;
  perCell(state, n);
}
BENCHMARK(velocityDiffuse)
    ->Args({512, 2, 1})
    ->Args({512, 2, 10})
    ->Args({512, 2, 1000})
    ->Unit(benchmark::kMillisecond);

void velocityConfinement(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  VelocityRun run(boundaryOf(state));
  setSwirl(run);
  Confinement confinement(run.boundary, run.pool);
  Field au(n, n), av(n, n);
  for (auto _ : state) confinement.addForce(run.boundary, run.u, run.v, 0.3, 1.0 / 256, au, av);
  perCell(state, n);
}
BENCHMARK(velocityConfinement)->Args({512, 2})->Args({1024, 2})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace smokebox
