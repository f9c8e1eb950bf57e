// `smokebox render SCENE`: the film.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "app/commands.h"
#include "app/film_frames.h"
#include "app/film_outputs.h"
#include "app/film_pipeline.h"
#include "app/interrupt.h"
#include "app/notices.h"
#include "app/progress.h"
#include "app/scene_file.h"
#include "app/stats_file.h"
#include "base/errors.h"
#include "render/gl_backend.h"
#include "world/ranges.h"
#include "world/world.h"

namespace smokebox {

namespace {

/// The outputs asked for, or renders/<scene>.mp4 with its folder made. What may not be replaced is refused.
std::vector<std::string> outputNames(const RenderOptions& options, const SceneSpec& spec) {
  if (options.outputs.empty()) return {inRenders(spec.name + ".mp4")};
  if (!options.replace)
    for (const std::string& output : options.outputs) refuseExisting(output);
  return options.outputs;
}

std::vector<FilmOutput> openOutputs(const std::vector<std::string>& names, const FrameRequest& request,
                                    const FilmFormat& format) {
  std::vector<FilmOutput> outputs;
  bool still = false;
  for (const std::string& name : names) {
    const bool isStill = outputKind(name) == OutputKind::pngStill;
    const FrameRange frames = isStill ? stillFrame(request) : filmFrames(request);
    outputs.push_back({openSink(name, format), frames});
    still |= isStill;
  }
  if (request.at && !still)
    throw UsageError("--at: is the time of a still, and there is none; name one: -o still.png");
  return outputs;
}

}  // namespace

int runRender(const RenderOptions& options) {
  catchInterrupts();
  preferDrawingAlone();
  const GlBackend backend = glBackendNamed(options.gl);
  for (const std::string& output : options.outputs) outputKind(output);  // throws if the ending is unknown
  const SceneDocument document = loadScene(options.scene, options.settings);
  const SceneSpec spec = document.spec();
  refuseTooLarge({spec});

  const long count = std::max(1L, spec.time.steps / spec.time.stepsPerFrame);
  const FrameRequest request{count, spec.output.fps, options.frames, options.at};
  const FilmFormat format{spec.output.width,
                          spec.output.height,
                          spec.output.fps,
                          {{"title", spec.title.empty() ? spec.name : spec.title},
                           {"scene", spec.name},
                           {"scene_hash", document.hash()},
                           {"program", "smokebox " + programVersion()}}};
  const std::vector<std::string> names = outputNames(options, spec);
  refuseOddSize(names, spec.output.width, spec.output.height);
  std::vector<FilmOutput> outputs = openOutputs(names, request, format);
  std::optional<StatsFile> stats;
  if (!options.stats.empty()) stats.emplace(options.stats);

  std::vector<FrameRange> wanted;
  for (const FilmOutput& output : outputs) wanted.push_back(output.frames);
  long last = 0, drawn = 0;
  for (const FrameRange& frames : wanted) last = std::max(last, frames.last);

  Progress progress(last + 1, options.quiet);
  SummaryFigures summary;
  {
    FilmPipeline pipeline(1, std::move(outputs), paintOnePanel(format.width, format.height, backend));
    const FilmRanges ranges = findRanges(document, options.threads, [&](long done, long of) {
      throwIfInterrupted();
      progress.showPreparing(done, of);
    });
    World world(document, {.threads = options.threads, .figures = stats.has_value()});
    auto step = [&] {
      throwIfInterrupted();
      world.step();
      if (const auto notices = world.takeNotices(); !notices.empty()) {
        progress.clear();
        printNotices(notices);
      }
      if (stats) stats->add(world.figures());
    };
    for (long frame = 0; frame <= last; ++frame) {
      for (int k = 0; frame > 0 && k < spec.time.stepsPerFrame; ++k) step();
      throwIfInterrupted();
      if (std::any_of(wanted.begin(), wanted.end(),
                      [&](const FrameRange& frames) { return frames.has(frame); })) {
        std::unique_ptr<FilmFrame> next = pipeline.next();
        next->number = frame;
        world.capture(next->panels[0]);
        ranges.put(next->panels[0]);
        pipeline.submit(std::move(next));
        ++drawn;
      }
      progress.show(frame + 1);
    }
    // The figures of a whole film go to the end of its duration, which comes after its last frame.
    if (stats && last + 1 == count)
      while (world.stepCount() < spec.time.steps) step();
    pipeline.finish();
    summary = world.summary();
  }
  const double seconds = progress.seconds();
  if (stats) stats->finish(spec.name, summary, drawn / seconds);
  progress.clear();
  if (!options.quiet) tellDone(names, drawn, seconds);
  return 0;
}

}  // namespace smokebox
