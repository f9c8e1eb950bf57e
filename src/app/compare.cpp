// `smokebox compare SCENE --vary KEY=V1,V2`: several runs of one scene, in step, as panels of one film.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/commands.h"
#include "app/film_frames.h"
#include "app/film_outputs.h"
#include "app/film_pipeline.h"
#include "app/film_runs.h"
#include "app/interrupt.h"
#include "app/progress.h"
#include "app/scene_file.h"
#include "app/variants.h"
#include "base/errors.h"
#include "image/colormap.h"
#include "image/sheet.h"
#include "render/renderer.h"

namespace smokebox {

namespace {

/// What is to be written, and the frames that each takes.
struct Outputs {
  std::vector<std::pair<std::string, FrameRange>> films, stills;
  bool stillsNamed = true;  // after an -o; else they are in renders/, and renewed

  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto* kind : {&films, &stills})
      for (const auto& [name, frames] : *kind) all.push_back(name);
    return all;
  }
};

/// "fig" at 1.5 s: "fig-1.5.png".
std::string stillName(const std::string& stem, double time) {
  char text[40];
  std::snprintf(text, sizeof text, "-%.6g.png", time);
  return stem + text;
}

/// A .png among the outputs stands for all stills, else they go beside the first film that is a file.
Outputs outputsOf(const CompareOptions& options, const SceneSpec& spec) {
  FrameRequest request{std::max(1L, spec.time.steps / spec.time.stepsPerFrame),
                       spec.output.fps,
                       options.frames,
                       {},
                       "--stills"};
  const FrameRange film = filmFrames(request), end = stillFrame(request);
  std::vector<FrameRange> stillFrames;
  for (const double time : options.stills) {
    request.at = time;
    stillFrames.push_back(stillFrame(request));
  }

  Outputs outputs;
  std::vector<std::string> stems;
  std::string beside;
  for (const std::string& name : options.outputs) {
    const OutputKind kind = outputKind(name);
    const std::string stem = std::filesystem::path(name).replace_extension().string();
    if (kind == OutputKind::pngStill && stillFrames.empty()) {
      outputs.stills.emplace_back(name, end);
    } else if (kind == OutputKind::pngStill) {
      stems.push_back(stem);
    } else {
      outputs.films.emplace_back(name, film);
      if (beside.empty() && (kind == OutputKind::mp4 || kind == OutputKind::mkv)) beside = stem;
    }
  }
  const std::string compared = spec.name + "-compare";
  if (options.outputs.empty()) outputs.films.emplace_back(inRenders(compared + ".mp4"), film);
  if (stems.empty() && !stillFrames.empty()) {
    outputs.stillsNamed = !beside.empty();
    stems.push_back(outputs.stillsNamed ? beside : inRenders(compared));
  }
  for (const std::string& stem : stems)
    for (std::size_t k = 0; k < stillFrames.size(); ++k)
      outputs.stills.emplace_back(stillName(stem, options.stills[k]), stillFrames[k]);
  return outputs;
}

/// Files that were not named with -o are renewed.
void refuseReplacing(const CompareOptions& options, const Outputs& outputs) {
  if (options.replace || options.outputs.empty()) return;
  for (const auto& [name, frames] : outputs.films) refuseExisting(name);
  for (const auto& [name, frames] : outputs.stills)
    if (outputs.stillsNamed) refuseExisting(name);
}

std::vector<FilmOutput> opened(const Outputs& outputs, const FilmFormat& format) {
  std::vector<FilmOutput> all;
  for (const auto* kind : {&outputs.films, &outputs.stills})
    for (const auto& [name, frames] : *kind) all.push_back({openSink(name, format), frames});
  return all;
}

/// How far the others are from the first picture, in the channel and the picture where it is the most: dark
/// where they agree. Half of the colours go to the first quarter of the way.
Image differenceMap(const std::vector<Image>& pictures, std::size_t count) {
  static const auto colors = [] {
    std::array<std::array<std::uint8_t, 4>, 256> table{};
    const ColorMap& map = colorMap(ColorMapKind::speed, true);
    for (int k = 0; k < 256; ++k) {
      const Color c = map.at(std::sqrt(k / 255.0));
      const auto byte = [](float x) { return static_cast<std::uint8_t>(std::lround(255 * x)); };
      table[k] = {byte(c.r), byte(c.g), byte(c.b), 255};
    }
    return table;
  }();
  const Image& first = pictures[0];
  Image map(first.width, first.height);
  for (std::size_t at = 0; at < map.rgba.size(); at += 4) {
    int most = 0;
    for (std::size_t k = 1; k < count; ++k)
      for (std::size_t c = at; c < at + 3; ++c)
        most = std::max(most, std::abs(int{pictures[k].rgba[c]} - int{first.rgba[c]}));
    std::copy_n(colors[most].data(), 4, &map.rgba[at]);
  }
  return map;
}

/// Draws the runs' panels one after the other with one renderer, for all have one size.
std::function<PaintFrame()> paintSheet(const SheetLayout& layout, const std::vector<std::string>& labels,
                                       const Color& ground, bool difference, GlBackend backend) {
  struct Sheet {
    Renderer renderer;
    SheetPainter painter;
    std::vector<Image> panels;
  };
  return [=]() -> PaintFrame {
    const auto sheet = std::shared_ptr<Sheet>(new Sheet{{layout.panelWidth, layout.panelHeight, backend},
                                                        {layout, labels, ground},
                                                        std::vector<Image>(labels.size())});
    return [sheet, difference](const FilmFrame& frame, Image& image) {
      const std::size_t runs = frame.panels.size();
      for (std::size_t k = 0; k < runs; ++k) sheet->renderer.draw(frame.panels[k], sheet->panels[k]);
      if (difference) sheet->panels[runs] = differenceMap(sheet->panels, runs);
      sheet->painter.paint(sheet->panels, image);
    };
  };
}

std::vector<std::string> labelsOf(const std::vector<Variant>& variants, bool difference,
                                  const SheetLayout& layout) {
  const auto fit = [&](const std::vector<std::string>& labels) { return labelsFit(layout, labels); };
  std::vector<std::string> labels = panelLabels(variants, fit);
  const std::string longer = "largest difference from the first";
  if (difference) labels.push_back(variants.size() > 2 && fit({longer}) ? longer : "difference");
  return labels;
}

FilmFormat formatOf(const CompareOptions& options, const SceneDocument& document, const SceneSpec& spec,
                    const SheetLayout& layout) {
  std::string varied;
  for (const std::string& text : options.varied) varied += (varied.empty() ? "" : " ") + text;
  return {layout.width,
          layout.height,
          spec.output.fps,
          {{"title", spec.title.empty() ? spec.name : spec.title},
           {"scene", spec.name},
           {"scene_hash", document.hash()},
           {"compared", varied},
           {"program", "smokebox " + programVersion()}}};
}

}  // namespace

int runCompare(const CompareOptions& options) {
  catchInterrupts();
  preferDrawingAlone();
  const GlBackend backend = glBackendNamed(options.gl);
  for (const std::string& output : options.outputs) outputKind(output);  // throws if the ending is unknown
  const std::vector<Variant> variants = variantsOf(options.varied);
  const SceneDocument document = loadScene(options.scene, options.settings);
  const std::vector<SceneDocument> scenes = variantScenes(document, variants);
  std::vector<SceneSpec> specs;
  for (const SceneDocument& scene : scenes) specs.push_back(scene.spec());
  refuseTooLarge(specs);

  const SceneSpec& spec = specs.front();
  const int panels = static_cast<int>(variants.size()) + options.difference;
  const SheetLayout layout = layOut(panels, spec.output.width, spec.output.height);
  const Outputs outputs = outputsOf(options, spec);
  refuseReplacing(options, outputs);
  std::vector<FilmOutput> films = opened(outputs, formatOf(options, document, spec, layout));
  std::vector<FrameRange> wanted;
  for (const FilmOutput& film : films) wanted.push_back(film.frames);
  long last = 0, drawn = 0;
  for (const FrameRange& frames : wanted) last = std::max(last, frames.last);

  Progress progress(last + 1, options.quiet);
  {
    const int runs = static_cast<int>(scenes.size());
    const int threadsEach = std::max(1, options.threads / runs);
    const FilmRanges ranges =
        commonRanges(scenes, threadsEach, [&](long done, long of) { progress.showPreparing(done, of); });
    std::vector<std::string> names;
    for (const Variant& variant : variants) names.push_back(variant.label);
    FilmPipeline pipeline(runs, std::move(films),
                          paintSheet(layout, labelsOf(variants, options.difference, layout),
                                     spec.view.background, options.difference, backend));
    FilmRuns simulations(scenes, names, threadsEach, ranges, pipeline);
    for (long frame = 0; frame <= last; ++frame) {
      throwIfInterrupted();
      if (std::any_of(wanted.begin(), wanted.end(), [&](const FrameRange& f) { return f.has(frame); })) {
        std::unique_ptr<FilmFrame> next = pipeline.next();
        next->number = frame;
        simulations.advance(std::move(next));
        ++drawn;
        progress.show(frame + 1);
      }
    }
    simulations.finish();
    pipeline.finish();
  }
  progress.clear();
  if (!options.quiet) tellDone(outputs.names(), drawn, progress.seconds());
  return 0;
}

}  // namespace smokebox
