// A whole step against Stam's (see stam_step.h) at the same size, in turn: a plume of smoke of one colour
// past a disk, with vorticity confinement, to a divergence of 1e-5. Argument: cells along a side. The last
// 100 of 200 steps count. Counters: times_faster, and milliseconds of each stage.
#include <benchmark/benchmark.h>

#include <map>
#include <string>

#include "plume_scene.h"
#include "stam_step.h"
#include "world/world.h"

namespace smokebox {
namespace {

using test::plume;
using test::seconds;

constexpr int kWarm = 100, kCounted = 100, kTurn = 10;

void stepAgainstStam(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0)), threads = static_cast<int>(state.range(1));
  World world(SceneDocument::parse(plume(n, static_cast<int>(state.range(2))), "plume.yaml"),
              {.threads = threads});
  test::StamStep stam(n);
  for (int k = 0; k < kWarm; ++k) world.step();
  double ours = 0, theirs = 0, worst = 0, iterations = 0;
  std::map<std::string, double> stages;
  for (auto _ : state) {
    for (int turn = 0; turn < kCounted / kTurn; ++turn) {
      ours += seconds([&] {
                for (int k = 0; k < kTurn; ++k) {
                  world.step();
                  worst = std::max(worst, world.figures().divergence);
                  iterations += world.figures().iterations;
                  for (const auto& [name, ms] : world.figures().stageMs) stages[name] += ms / kCounted;
                }
              }) /
              kCounted;
      theirs += seconds([&] { stam.step(1.0f / 60, 1e-5f, 1e-5f); }) / (kCounted / kTurn);
    }
  }
  benchmark::DoNotOptimize(stam.density(n / 2, n / 2));
  state.counters["ours_ms"] = 1e3 * ours;
  state.counters["stam_ms"] = 1e3 * theirs;
  state.counters["times_faster"] = theirs / ours;
  state.counters["divergence"] = worst;
  state.counters["iterations"] = iterations / kCounted;
  state.counters["ns_a_cell"] = 1e9 * ours / (static_cast<double>(n) * n);
  for (const auto& [name, ms] : stages) state.counters["ms_" + name] = ms;
}
BENCHMARK(stepAgainstStam)
    ->ArgNames({"cells", "threads", "steps_a_second"})
    ->Args({256, 1, 60})
    ->Args({512, 1, 120})
    ->Args({512, 1, 60})
    ->Args({1024, 1, 240})
    ->Args({1024, 1, 60})
    ->Args({1024, 2, 240})
    ->Args({2048, 1, 480})
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace smokebox
