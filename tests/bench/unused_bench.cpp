// What a scene pays for what it does not use: nothing, or under 1%; a row that is over is an error.
//   unusedFeature/NAME: a step of a fluid past a still disk, in a scene that names the feature but switches
//   it
//     off, and in one that does not know of it. cost: the time of the former over that of the latter, less 1.
//     Memory and state must be the same to the last byte.
//   unusedStages: a step of the same against its two stages alone, advection and pressure, on a copy of the
//     state and without a World: what the list of stages costs that has nothing to do.
//   idle: the share of a step that its own clock gives to all stages but these two.
// The two sides take turns, each first in every other turn. A step's time depends by several per cent on
// where its fields happen to lie in memory: both sides are built anew many times, and the best turn of each
// counts.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <optional>
#include <string>

#include "world/world.h"

namespace smokebox {
namespace {

constexpr int kCells = 128, kWarm = 10, kPairs = 40, kTurns = 6, kStepsATurn = 5;
constexpr double kMost = 0.01;

struct Features {
  std::string fluid, solid, other;
};

SceneDocument wind(const Features& off) {
  return SceneDocument::parse("domain: {size: [1, 1], resolution: " + std::to_string(kCells) +
                                  "}\nwalls: {left: {inflow: [1, 0]}, right: open}\ntime: {duration: 100, "
                                  "step: 1/128}\ngravity: [0, -9.81]\noutput: {fps: 1}\n"
                                  "fluid: {velocity: [\"1\", \"0.2*sin(pi*x)\"]" +
                                  off.fluid +
                                  "}\nsolids: [{name: disk, shape: {circle: {radius: 0.1}}, position: "
                                  "[0.4, 0.52]" +
                                  off.solid + "}]\n" + off.other,
                              "wind.yaml");
}

/// Of the processor, for this thread alone: others on the machine do not count.
double processorSeconds(const auto& work) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const double start = now();
  work();
  return now() - start;
}

/// The least times of both sides over all turns.
class Best {
 public:
  void take(const auto& one, const auto& other) {
    for (int turn = 0; turn < kTurns; ++turn) {
      if (turn % 2 == 0) one_ = std::min(one_, processorSeconds(one));
      other_ = std::min(other_, processorSeconds(other));
      if (turn % 2 == 1) one_ = std::min(one_, processorSeconds(one));
    }
  }
  double cost() const { return one_ / other_ - 1; }
  /// A busy machine may need longer until both sides have had a good turn; a real cost stays.
  bool wantsMore(int pairs) const { return pairs < kPairs || (pairs < 5 * kPairs && cost() > kMost); }
  void report(benchmark::State& state) const {
    state.counters["cost"] = cost();
    if (cost() > kMost) state.SkipWithError("what is not used costs more than 1% of the step");
  }

 private:
  double one_ = 1e9, other_ = 1e9;
};

/// Of all steps: what stages other than advection and pressure took.
class Idle {
 public:
  void take(const World& world) {
    for (const auto& [name, ms] : world.figures().stageMs)
      if (name != std::string("advect") && name != std::string("project")) idle_ += ms;
    total_ += world.figures().totalMs;
  }
  void report(benchmark::State& state) const {
    state.counters["idle"] = idle_ / total_;
    if (idle_ > kMost * total_)
      state.SkipWithError("stages with nothing to do take more than 1% of the step");
  }

 private:
  double idle_ = 0, total_ = 0;
};

auto stepsOf(World& world, Idle& idle) {
  return [&] {
    for (int k = 0; k < kStepsATurn; ++k) {
      world.step();
      idle.take(world);
    }
  };
}

void unusedFeature(benchmark::State& state, const Features& off) {
  Best best;
  Idle idle, others;
  for (auto _ : state)
    for (int pair = 0; best.wantsMore(pair); ++pair) {
      std::optional<World> plain, with;
      if (pair % 2 == 0) plain.emplace(wind({}), World::Options{});
      with.emplace(wind(off), World::Options{});
      if (pair % 2 == 1) plain.emplace(wind({}), World::Options{});
      for (int k = 0; k < kWarm; ++k) plain->step(), with->step();
      best.take(stepsOf(*with, idle), stepsOf(*plain, others));
      state.counters["bytes_more"] = static_cast<double>(with->bytes()) - static_cast<double>(plain->bytes());
      if (with->bytes() != plain->bytes()) return state.SkipWithError("what is not used has memory");
      if (with->stateHash() != plain->stateHash())
        return state.SkipWithError("what is not used changes the flow");
    }
  best.report(state);
  idle.report(state);
}

/// What a step of the wind is made of, and nothing else.
class BareFluid {
 public:
  BareFluid() : pool_(1) {}

  /// The state, grid and solid of `world`.
  void start(const World& world) {
    fluid_.emplace(world.boundary(), Fluid::Parts{}, pool_);
    fluid_->u() = world.fluid()->u();
    fluid_->v() = world.fluid()->v();
  }
  void step(const World& world) {
    const double dt = world.spec().time.step;
    const MethodSpec& method = world.spec().method;
    fluid_->advect(world.boundary(), dt);
    fluid_->project(world.boundary(), dt, method.tolerance, method.maxIterations);
  }
  const Fluid& fluid() const { return *fluid_; }

 private:
  ThreadPool pool_;
  std::optional<Fluid> fluid_;
};

void unusedStages(benchmark::State& state) {
  Best best;
  Idle idle;
  for (auto _ : state)
    for (int pair = 0; best.wantsMore(pair); ++pair) {
      const World first(wind({}), {});
      BareFluid bare;
      if (pair % 2 == 0) bare.start(first);
      World world(wind({}), {});
      if (pair % 2 == 1) bare.start(first);
      for (int k = 0; k < kWarm; ++k) world.step(), bare.step(first);
      best.take(stepsOf(world, idle), [&] {
        for (int k = 0; k < kStepsATurn; ++k) bare.step(first);
      });
      const Field &u = bare.fluid().u(), &same = world.fluid()->u();
      for (int j = 0; j < kCells; ++j)
        if (!std::equal(u.row(j), u.row(j) + kCells + 1, same.row(j)))
          return state.SkipWithError("the two did not do the same");
    }
  best.report(state);
  idle.report(state);
}

#define UNUSED_FEATURE(name, ...) \
  BENCHMARK_CAPTURE(unusedFeature, name, Features{__VA_ARGS__})->Iterations(1)->Unit(benchmark::kMillisecond)
UNUSED_FEATURE(viscosity, ", viscosity: 0", "", "");
UNUSED_FEATURE(vorticity, ", vorticity: 0", "", "");
UNUSED_FEATURE(drag, "", ", drag: 0", "");
UNUSED_FEATURE(motion, "", ", motion: {velocity: [0, 0], spin: 0}", "");
UNUSED_FEATURE(smoke, "", "", "smoke: {buoyancy: 0.6, sources: []}\n");
BENCHMARK(unusedStages)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace smokebox
