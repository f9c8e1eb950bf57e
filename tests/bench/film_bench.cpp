// A whole film of wake.yaml (1280x720, 30 frames/s, 512x288 cells, two steps a frame) from the developed
// flow: how many frames a second come out, and what it costs that simulation, drawing and encoding share the
// machine: wall time of the film over the larger of the simulation alone and the pictures alone.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>

#include "app/film_pipeline.h"
#include "base/threads.h"
#include "world/ranges.h"
#include "world/world.h"

namespace smokebox {
namespace {

constexpr int kFrames = 60, kStepsBefore = 240;

class Film {
 public:
  Film()
      : document_(SceneDocument::load(std::string(SMOKEBOX_SOURCE_DIR) + "/scenes/wake.yaml")),
        ranges_(findRanges(document_, hardwareThreads())),
        world_(document_, {.threads = hardwareThreads(), .figures = false}) {
    for (int k = 0; k < kStepsBefore; ++k) world_.step();
  }

  /// Seconds for kFrames frames.
  double simulationAlone() {
    Snapshot snapshot;
    return seconds([&] {
      for (int k = 0; k < kFrames; ++k) advance(snapshot);
    });
  }
  double picturesAlone() { return run(false); }
  double together() { return run(true); }

 private:
  static double seconds(const auto& body) {
    const auto start = std::chrono::steady_clock::now();
    body();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  void advance(Snapshot& snapshot) {
    for (int k = 0; k < world_.spec().time.stepsPerFrame; ++k) world_.step();
    world_.capture(snapshot);
  }
  double run(bool simulate) {
    const std::filesystem::path file = std::filesystem::temp_directory_path() / "smokebox_film_bench.mp4";
    const OutputSpec& output = world_.spec().output;
    const double time = seconds([&] {
      std::vector<FilmOutput> outputs;
      outputs.push_back(
          {openSink(file.string(), {output.width, output.height, output.fps, {}}), {0, kFrames - 1}});
      FilmPipeline pipeline(output.width, output.height, std::move(outputs));
      for (int k = 0; k < kFrames; ++k) {
        std::unique_ptr<Snapshot> snapshot = pipeline.next();
        if (simulate)
          advance(*snapshot);
        else
          world_.capture(*snapshot);
        snapshot->frame = k;
        ranges_.put(*snapshot);
        pipeline.submit(std::move(snapshot));
      }
      pipeline.finish();
    });
    std::filesystem::remove(file);
    return time;
  }

  SceneDocument document_;
  FilmRanges ranges_;
  World world_;
};

void filmOfAWake(benchmark::State& state) {
  Film film;
  double simulation = 0, pictures = 0, together = 0;
  for (auto _ : state) {  // in turn, so that a machine that slows down slows all alike
    simulation += film.simulationAlone();
    pictures += film.picturesAlone();
    together += film.together();
  }
  const double frames = static_cast<double>(kFrames) * static_cast<double>(state.iterations());
  state.counters["film_fps"] = frames / together;
  state.counters["simulation_ms"] = 1e3 * simulation / frames;
  state.counters["pictures_ms"] = 1e3 * pictures / frames;
  state.counters["film_ms"] = 1e3 * together / frames;
  state.counters["over_slowest"] = together / std::max(simulation, pictures);
}
BENCHMARK(filmOfAWake)->Iterations(3)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace smokebox
