// Where a step of the yardstick scene (plume_scene.h) goes: a row for each stage and size, one thread, to a
// divergence of 1e-5. Of the last 60 of 160 steps, each row shows the one in which the stage's time for its
// work is the median. Wants an idle machine. The time is that of the stage in that step; the label says what
// bounds it. Counters:
//   share_of_step   of the whole step's time
//   ns_a_cell       of that stage
//   bytes_a_cell    that must move at least, see leastMoved()
//   copy_share      bytes that must move over those that a plain copy of 256 MB moves in that time, measured
//   in
//                   the same run. A copy reads and writes: 512 MB. More than 1: the fields stay in a cache
//   against_cache   time for each of those bytes against the better of 128 and 256 cells along a side, whose
//                   fields fit a cache
//   flops_a_cell    that the arithmetic of the stage takes, see leastMoved(); 0 where it is not counted
//   flop_share      of the multiplications and additions that the machine can do, measured in the same run
//   iterations      of conjugate gradients, with multigrid, in a step
//   solve_share     the time of these iterations, measured on the same grid and solid, over the stage's
// What bounds a stage: `iterations` if they take more than half of its time (the row `iteration` tells what
// bounds one of them); `memory` if it takes 1.5 times as long as with its fields in a cache, and moves them
// at a tenth of the speed of a copy or more; else `arithmetic`, and where flop_share is small too, the parts
// of it that are not plain sums: branches, minima and floors, lists of faces beside solids.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fluid/multigrid_kernels.h"
#include "fluid/pressure.h"
#include "plume_scene.h"
#include "world/world.h"

namespace smokebox {
namespace {

constexpr int kWarm = 100, kCounted = 60;
constexpr int kInCache[] = {128, 256};  // cells along a side

/// Of one stage in one step, or of one iteration: floats that must move and operations, both per cell.
struct Work {
  double floats = 0, flops = 0;
  Work& operator+=(const Work& other) {
    floats += other.floats;
    flops += other.flops;
    return *this;
  }
};
Work operator*(double times, const Work& work) { return {times * work.floats, times * work.flops}; }
Work operator+(Work a, const Work& b) { return a += b; }

/// What one step does.
struct Step {
  double iterations = 0, subSteps = 0, smokeShare = 0;  // of the cells that hold smoke
};

// Floats per cell: each field that a pass over the grid reads or writes counts once, whatever its stencil; a
// pass ends where something is needed from all of the grid (a largest value, a product, a projection). Coarse
// levels of the multigrid have a third of the finest's cells in all. What lines of a cache are fetched for,
// only to be overwritten, does not count, nor do lists of faces beside solids.
//
// cycle, on a level: right-hand side read, solution written, residual summed up into the coarse right-hand
// side (a quarter); both read again, the coarse correction read (a quarter), the solution written.
// Arithmetic: a sweep of one colour works out both, 5 operations; the first from nothing 1; the residual 6,
// its sums 0.75, the correction 1; three sweeps back 15.
constexpr Work kCycle{(1 + 1 + 0.25 + 2 + 0.25 + 1) * 4 / 3, (1 + 10 + 6 + 0.75 + 1 + 15) * 4 / 3};
// Conjugate gradients: two products with what the cycle leaves; correction, direction and residual in, the
// latter two out, and every other time the solution in and out.
const Work kIteration = kCycle + Work{5 + 0.5 * 2, (2 + 6 + 2) + (2 + 6 + 2 + 1 + 0.5 * 4)};
// The only one of a solve: the solution is a multiple of what the cycle leaves.
const Work kOnly = kCycle + Work{1, 2 + 6 + 2 + 1};
constexpr Work kMeasure{3, 5};   // the velocity in, its divergence out
constexpr Work kSubtract{7, 6};  // the increment in, velocity and pressure in and out
// Fluxes of 24 operations along two axes, differences 12, impulse 4, for two components. Velocity now and at
// the start (the same in the first stage), pressure and accelerations in, velocity out.
constexpr Work kFirstStage{7, 2 * (2 * 24 + 12 + 4)}, kLaterStage{9, 2 * (2 * 24 + 12 + 4)};

std::map<std::string, Work> leastMoved(const Step& step) {
  std::map<std::string, Work> stages;
  // Confinement: the velocity in, the vorticity out; the vorticity in, for its steepest slope; both in again,
  // with the open shares, accelerations out. Buoyancy may go along: where there is smoke, its value in.
  stages["forces"] = Work{2 + 1, 4} + Work{1, 10} + Work{1 + 2 + 2, 18 + 6} + step.smokeShare * Work{1, 3};
  // The Courant number: velocity, pressure, accelerations and open shares in.
  const double between = step.subSteps - 1;
  stages["advect"] = Work{7, 18} + step.subSteps * (kFirstStage + 2 * kLaterStage) +
                     step.subSteps * (kMeasure + kOnly + kSubtract) +
                     between * (kMeasure + kCycle + kSubtract);
  // The last increment taken off again, the divergence before and after, and the increment kept.
  stages["project"] = kSubtract + 2 * kMeasure + step.iterations * kIteration + kSubtract + Work{2, 1};
  // Two sweeps over the smoke: mass and value in and out, one component of the velocity and the open share
  // in.
  stages["smoke"] = step.smokeShare * Work{2 * (4 + 1 + 1), 0};
  return stages;
}

/// Iterations within the stage of a step, what is less than one counting as the share of one that it is.
double iterationsIn(const std::string& stage, const Step& step) {
  if (stage == "project") return step.iterations;
  if (stage != "advect") return 0;
  const double only = kOnly.flops / kIteration.flops, bare = kCycle.flops / kIteration.flops;
  return only * step.subSteps + bare * std::max(step.subSteps - 1, 0.0);
}

/// The machine, in a second: bytes moved by a copy, operations on floats that do not wait for each other.
struct Machine {
  double bytes = 0, flops = 0;
};

Machine measureMachine() {
  constexpr std::size_t kBytes = std::size_t{256} << 20;
  std::vector<char> from(kBytes, 1), to(kBytes, 2);
  double copy = 1e9, sums = 1e9;
  for (int k = 0; k < 5; ++k) {
    copy = std::min(copy, test::seconds([&] { std::memcpy(to.data(), from.data(), kBytes); }));
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
  constexpr int kRounds = 1 << 20;
  const Lanes factor = Lanes{} + 0.5f, more = Lanes{} + 1.0f;
  for (int k = 0; k < 5; ++k) {
    Lanes a = {}, b = more, c = factor, d = more + more;
    sums = std::min(sums, test::seconds([&] {
                      for (int r = 0; r < kRounds; ++r) {
                        a = a * factor + more, b = b * factor + more;
                        c = c * factor + more, d = d * factor + more;
                      }
                    }));
    benchmark::DoNotOptimize((a + b) + (c + d));
  }
  return {2.0 * kBytes / copy, 4.0 * 2 * kLanes * kRounds / sums};
}

/// Milliseconds of one iteration on the scene's grid and solid, the median: solves of 2 and of 8 in turn, for
/// what was just projected, with noise.
double msOfIteration(const World& world) {
  constexpr int kTurns = 11, kFew = 2, kMany = 8;
  const Boundary& boundary = world.boundary();
  const Grid& grid = boundary.grid;
  ThreadPool pool(1);
  PressureSolver solver(boundary, pool);
  Field u0 = world.fluid()->u(), v0 = world.fluid()->v();
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i)
      u0(i, j) += 1e-2f * static_cast<float>((i * 7919 + j * 104729) % 1000) / 1000;
  std::array<double, kTurns> ms{};
  for (double& one : ms) {
    const auto timeOf = [&](int iterations) {
      Field u = u0, v = v0;
      return 1e3 * test::seconds([&] { solver.projectRoughly(boundary, u, v, iterations); });
    };
    const double few = timeOf(kFew);
    one = (timeOf(kMany) - few) / (kMany - kFew);
  }
  std::nth_element(ms.begin(), ms.begin() + kTurns / 2, ms.end());
  return ms[kTurns / 2];
}

/// A stage in one step.
struct Sample {
  double ms = 0, stepMs = 0, iterations = 0;
  Work work;
  double effort() const { return work.floats > 0 ? ms / work.floats : ms; }
};

struct Run {
  Machine machine;
  std::map<std::string, Sample> stages;
  double iterationMs = 0;
};

Run runOf(int n) {
  Run run;
  run.machine = measureMachine();
  World world(SceneDocument::parse(test::plume(n, n * 60 / 256), "plume.yaml"), {});
  for (int k = 0; k < kWarm; ++k) world.step();
  std::map<std::string, std::vector<Sample>> samples;
  for (int k = 0; k < kCounted; ++k) {
    world.step();
    Step step;
    step.iterations = world.figures().iterations;
    step.subSteps = world.fluid()->carried().subSteps;
    const Field& value = world.smoke()->smoke().value(0);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) step.smokeShare += value(i, j) > 0 ? 1.0 / n / n : 0.0;
    const std::map<std::string, Work> work = leastMoved(step);
    for (const auto& [name, ms] : world.figures().stageMs)
      samples[name].push_back({ms, world.figures().totalMs, iterationsIn(name, step),
                               work.contains(name) ? work.at(name) : Work{}});
  }
  for (auto& [name, list] : samples) {
    std::nth_element(list.begin(), list.begin() + kCounted / 2, list.end(),
                     [](const Sample& a, const Sample& b) { return a.effort() < b.effort(); });
    run.stages[name] = list[kCounted / 2];
  }
  run.iterationMs = msOfIteration(world);
  run.stages["iteration"] = {run.iterationMs, run.stages["project"].stepMs, 0, kIteration};
  return run;
}

/// The runs by size, each made when it is first asked for.
class Runs {
 public:
  const Run& of(int n) {
    if (!runs_.contains(n)) runs_.emplace(n, runOf(n));
    return runs_.at(n);
  }

 private:
  std::map<int, Run> runs_;
};

void report(benchmark::State& state, Runs& runs, const std::string& stage, int n) {
  const Run& run = runs.of(n);
  const Sample& sample = run.stages.at(stage);
  const double cells = static_cast<double>(n) * n, seconds = 1e-3 * sample.ms;
  for (auto _ : state) state.SetIterationTime(seconds);
  double cached = 1e9;
  for (const int small : kInCache)
    cached = std::min(cached, runs.of(small).stages.at(stage).effort() / (small * small));
  const bool works = sample.work.floats > 0;
  const double copyShare = 4 * sample.work.floats * cells / seconds / run.machine.bytes;
  const double againstCache = works ? sample.effort() / cells / cached : 0;
  const double solveShare = sample.iterations * run.iterationMs / sample.ms;
  // Every row has every counter: a table in CSV needs that.
  state.counters["share_of_step"] = sample.ms / sample.stepMs;
  state.counters["ns_a_cell"] = 1e9 * seconds / cells;
  state.counters["bytes_a_cell"] = 4 * sample.work.floats;
  state.counters["copy_share"] = copyShare;
  state.counters["against_cache"] = againstCache;
  state.counters["flops_a_cell"] = sample.work.flops;
  state.counters["flop_share"] = sample.work.flops * cells / seconds / run.machine.flops;
  state.counters["iterations"] = sample.iterations;
  state.counters["solve_share"] = solveShare;
  state.SetLabel(!works                                  ? "nothing to do"
                 : solveShare > 0.5                      ? "iterations"
                 : copyShare > 0.1 && againstCache > 1.5 ? "memory"
                                                         : "arithmetic");
}

bool registerRows() {
  const auto runs = std::make_shared<Runs>();
  for (const int n : {256, 512, 1024})
    for (const char* stage : {"events", "scripts", "cover", "forces", "advect", "diffuse", "project", "smoke",
                              "heat", "ledger", "iteration"})
      benchmark::RegisterBenchmark(
          ("stages/" + std::to_string(n) + "/" + stage).c_str(),
          [runs, stage, n](benchmark::State& state) { report(state, *runs, stage, n); })
          ->Iterations(1)
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
  return true;
}
const bool kRegistered = registerRows();

}  // namespace
}  // namespace smokebox
