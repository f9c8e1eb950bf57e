// A whole film of wake.yaml (1280x720, 30 frames/s, 512x288 cells, two steps a frame) from the developed
// flow: how many frames a second come out, and what it costs that simulation, drawing and encoding share the
// machine: wall time of the film over the larger of the simulation alone and the pictures alone. Stages that
// use all cores by themselves cannot come near 1: the least there is, is film_cpu_ms over the number of
// cores.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/film_pipeline.h"
#include "base/threads.h"
#include "world/ranges.h"
#include "world/world.h"

namespace smokebox {
namespace {

constexpr int kFrames = 60, kStepsBefore = 240;

/// Wall time, and processor time of all threads; milliseconds.
struct Cost {
  double wall = 0, processor = 0;
  Cost& operator+=(const Cost& other) {
    wall += other.wall;
    processor += other.processor;
    return *this;
  }
};

double now(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

Cost costOf(const auto& body) {
  const double wall = now(CLOCK_MONOTONIC), processor = now(CLOCK_PROCESS_CPUTIME_ID);
  body();
  return {now(CLOCK_MONOTONIC) - wall, now(CLOCK_PROCESS_CPUTIME_ID) - processor};
}

class Film {
 public:
  Film()
      : document_(SceneDocument::load(std::string(SMOKEBOX_SOURCE_DIR) + "/scenes/wake.yaml")),
        ranges_(findRanges(document_, hardwareThreads())),
        world_(document_, {.threads = hardwareThreads(), .figures = false}),
        recorded_(kFrames) {
    for (int k = 0; k < kStepsBefore; ++k) world_.step();
  }

  /// kFrames frames, which are kept.
  Cost simulationAlone() {
    return costOf([&] {
      for (Snapshot& snapshot : recorded_) advance(snapshot);
    });
  }
  /// Of the frames that were kept: pictures that stood still would be encoded for nothing.
  Cost picturesAlone() {
    return film([&](int frame, Snapshot& snapshot) { snapshot = recorded_[frame]; });
  }
  Cost together() {
    return film([&](int, Snapshot& snapshot) { advance(snapshot); });
  }

 private:
  void advance(Snapshot& snapshot) {
    for (int k = 0; k < world_.spec().time.stepsPerFrame; ++k) world_.step();
    world_.capture(snapshot);
  }
  Cost film(const auto& fill) {
    const std::filesystem::path file = std::filesystem::temp_directory_path() / "smokebox_film_bench.mp4";
    const OutputSpec& output = world_.spec().output;
    const Cost cost = costOf([&] {
      std::vector<FilmOutput> outputs;
      outputs.push_back(
          {openSink(file.string(), {output.width, output.height, output.fps, {}}), {0, kFrames - 1}});
      FilmPipeline pipeline(1, std::move(outputs),
                            paintOnePanel(output.width, output.height, defaultGlBackend()));
      for (int k = 0; k < kFrames; ++k) {
        std::unique_ptr<FilmFrame> frame = pipeline.next();
        frame->number = k;
        fill(k, frame->panels[0]);
        ranges_.put(frame->panels[0]);
        pipeline.submit(std::move(frame));
      }
      pipeline.finish();
    });
    std::filesystem::remove(file);
    return cost;
  }

  SceneDocument document_;
  FilmRanges ranges_;
  World world_;
  std::vector<Snapshot> recorded_;
};

void filmOfAWake(benchmark::State& state) {
  Film film;
  Cost simulation, pictures, together;
  for (auto _ : state) {  // in turn, so that a machine that slows down slows all alike
    simulation += film.simulationAlone();
    pictures += film.picturesAlone();
    together += film.together();
  }
  const double frames = static_cast<double>(kFrames) * static_cast<double>(state.iterations());
  state.counters["film_fps"] = 1e3 * frames / together.wall;
  state.counters["film_ms"] = together.wall / frames;
  state.counters["film_cpu_ms"] = together.processor / frames;
  state.counters["simulation_ms"] = simulation.wall / frames;
  state.counters["simulation_cpu_ms"] = simulation.processor / frames;
  state.counters["pictures_ms"] = pictures.wall / frames;
  state.counters["pictures_cpu_ms"] = pictures.processor / frames;
  state.counters["over_slowest"] = together.wall / std::max(simulation.wall, pictures.wall);
}
BENCHMARK(filmOfAWake)->Iterations(3)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace smokebox
