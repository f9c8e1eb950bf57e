// `smokebox simulate SCENE`: the run without pictures.
#include <cstdio>
#include <optional>

#include "app/commands.h"
#include "app/interrupt.h"
#include "app/notices.h"
#include "app/scene_file.h"
#include "app/stats_file.h"
#include "world/world.h"

namespace smokebox {

int runSimulate(const SimulateOptions& options) {
  catchInterrupts();
  const SceneDocument document = loadScene(options.scene, options.settings);
  refuseTooLarge({document.spec()});
  std::optional<StatsFile> stats;
  if (!options.stats.empty()) stats.emplace(options.stats);

  World world(document, {.threads = options.threads, .figures = stats.has_value()});
  const long steps = options.steps.value_or(world.spec().time.steps);
  for (long k = 0; k < steps; ++k) {
    throwIfInterrupted();
    world.step();
    printNotices(world.takeNotices());
    if (stats) stats->add(world.figures());
  }
  const SummaryFigures summary = world.summary();
  if (stats) stats->finish(world.spec().name, summary, std::nullopt);
  std::printf("%s: %ld steps, %g s, %ld cells, %d threads, %.2f ms a step\n", world.spec().name.c_str(),
              summary.steps, world.time(), summary.cells, summary.threads, summary.stepMsMedian);
  std::printf("divergence %.1e, smoke error %.1e, peak memory %.0f MB, state %s\n", summary.divergenceMax,
              summary.smokeError, peakMemoryMb(), summary.stateHash.c_str());
  return 0;
}

}  // namespace smokebox
