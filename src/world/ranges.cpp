#include "world/ranges.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "world/world.h"

namespace smokebox {

namespace {

constexpr int kCoarseCells = 64;  // along the shorter side, at least

// The largest divisor of the grid that leaves at least kCoarseCells along the shorter side and keeps cells
// square.
int coarsening(const Grid& grid) {
  const int shorter = std::min(grid.nx, grid.ny);
  const int common = std::gcd(grid.nx, grid.ny);
  for (int factor = common; factor > 1; --factor)
    if (common % factor == 0 && shorter / factor >= kCoarseCells) return factor;
  return 1;
}

// The same film on a coarser grid, with steps as many times longer as still make whole frames.
SceneDocument coarsened(const SceneDocument& document, const SceneSpec& spec, long frames) {
  SceneDocument coarse = document;
  const int factor = coarsening(spec.domain.grid);
  int longer = std::min(factor, spec.time.stepsPerFrame);
  while (spec.time.stepsPerFrame % longer != 0) --longer;
  const std::string fps = std::to_string(spec.output.fps);
  const SourcePlace nowhere;
  coarse.set("domain.resolution", std::to_string(spec.domain.grid.nx / factor), nowhere);
  coarse.set("time.step", "1/(" + fps + "*" + std::to_string(spec.time.stepsPerFrame / longer) + ")",
             nowhere);
  coarse.set("time.duration", std::to_string(frames) + "/" + fps, nowhere);
  return coarse;
}

double quantile(std::vector<float>& values, double share) {
  if (values.empty()) return 0;
  const auto k = static_cast<std::size_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(k), values.end());
  return values[k];
}

// What one frame reaches: all but a thousandth of the open cells stay below it.
double reach(const Snapshot& snapshot, const Field& field, std::vector<float>& scratch) {
  scratch.clear();
  for (int j = 0; j < snapshot.grid.ny; ++j)
    for (int i = 0; i < snapshot.grid.nx; ++i)
      if (snapshot.open(i, j) > 0.5f) scratch.push_back(std::fabs(field(i, j)));
  return quantile(scratch, 0.999);
}

// What a share of the open cells is colder than.
double warmth(const Snapshot& snapshot, double share, std::vector<float>& scratch) {
  scratch.clear();
  for (int j = 0; j < snapshot.grid.ny; ++j)
    for (int i = 0; i < snapshot.grid.nx; ++i)
      if (snapshot.open(i, j) > 0.5f) scratch.push_back(snapshot.temperature(i, j));
  return quantile(scratch, share);
}

double speedReach(const Snapshot& snapshot, std::vector<float>& scratch) {
  scratch.clear();
  for (int j = 0; j < snapshot.grid.ny; ++j)
    for (int i = 0; i < snapshot.grid.nx; ++i)
      if (snapshot.open(i, j) > 0.5f) {
        const float x = snapshot.velocityX(i, j), y = snapshot.velocityY(i, j);
        scratch.push_back(std::sqrt(x * x + y * y));
      }
  return quantile(scratch, 0.999);
}

// What each frame reaches in which the field is shown.
struct Reaches {
  std::vector<float> pressure, vorticity, speed;
  std::vector<float> coldest, warmest;
};

void watchFilm(const SceneDocument& document, const SceneSpec& spec, int threads,
               const std::function<void(long, long)>& eachFrame, Reaches& reaches) {
  const long frames = std::max(1L, spec.time.steps / spec.time.stepsPerFrame);
  World world(coarsened(document, spec, frames), {.threads = threads});
  Snapshot snapshot;
  std::vector<float> scratch;
  for (long frame = 1; frame <= frames; ++frame) {
    for (int k = 0; k < world.spec().time.stepsPerFrame; ++k) world.step();
    world.capture(snapshot);
    if (snapshot.shows(LayerKind::pressure))
      reaches.pressure.push_back(static_cast<float>(reach(snapshot, snapshot.pressure, scratch)));
    if (snapshot.shows(LayerKind::vorticity))
      reaches.vorticity.push_back(static_cast<float>(reach(snapshot, snapshot.vorticity, scratch)));
    if (snapshot.shows(LayerKind::temperature) && !snapshot.temperature.empty()) {
      reaches.coldest.push_back(static_cast<float>(warmth(snapshot, 0.001, scratch)));
      reaches.warmest.push_back(static_cast<float>(warmth(snapshot, 0.999, scratch)));
    }
    if (snapshot.shows(LayerKind::speed) || snapshot.shows(LayerKind::velocity))
      reaches.speed.push_back(static_cast<float>(speedReach(snapshot, scratch)));
    if (eachFrame) eachFrame(frame, frames);
  }
}

// Takes the range that the scene gives to a layer; is another one wanted, because a layer that can be shown
// has none, or an event changes it?
bool wantsRange(const SceneSpec& spec, LayerKind kind, std::array<double, 2>& range) {
  bool wanted = eventSetsLayer(spec, kind, "range");
  for (const LayerSpec& layer : spec.view.layers) {
    if (layer.kind != kind) continue;
    if (layer.range)
      range = *layer.range;
    else
      wanted = true;
  }
  return wanted && canShow(spec, kind);
}

// The longest arrow stands for the fastest fluid of the film, unless its scale is given.
bool wantsArrowScale(const SceneSpec& spec) {
  return canShow(spec, LayerKind::velocity) &&
         (eventSetsLayer(spec, LayerKind::velocity, "scale") ||
          std::any_of(spec.view.layers.begin(), spec.view.layers.end(), [](const LayerSpec& layer) {
            return layer.kind == LayerKind::velocity && layer.scale == 0;
          }));
}

}  // namespace

double niceCeiling(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (step * power >= value * (1 - 1e-9)) return step * power;
  return 10 * power;
}

FilmRanges findRanges(const SceneDocument& document, int threads,
                      const std::function<void(long done, long frames)>& eachFrame) {
  const SceneSpec spec = document.spec();
  FilmRanges ranges;
  const bool pressure = wantsRange(spec, LayerKind::pressure, ranges.pressure);
  const bool vorticity = wantsRange(spec, LayerKind::vorticity, ranges.vorticity);
  const bool speed = wantsRange(spec, LayerKind::speed, ranges.speed) || wantsArrowScale(spec);
  const bool temperature =
      wantsRange(spec, LayerKind::temperature, ranges.temperature) && spec.temperature.named;
  if (!spec.hasFluid || !(pressure || vorticity || speed || temperature)) return ranges;

  Reaches reaches;
  try {
    watchFilm(document, spec, threads, eachFrame, reaches);
  } catch (const SimulationError&) {
    // The real run has smaller steps and cells, and may fare better: what was seen so far will do.
  }
  auto settle = [](std::vector<float>& reached, bool want, std::array<double, 2>& range, bool bothSigns) {
    const double top = want ? quantile(reached, 0.95) : 0;
    if (top > 0) range = {bothSigns ? -niceCeiling(top) : 0, niceCeiling(top)};
  };
  settle(reaches.pressure, pressure, ranges.pressure, true);
  settle(reaches.vorticity, vorticity, ranges.vorticity, true);
  settle(reaches.speed, speed, ranges.speed, false);
  if (temperature && !reaches.coldest.empty()) {
    const double low = quantile(reaches.coldest, 0.05), high = quantile(reaches.warmest, 0.95);
    // To tenths of about the span; a temperature that is the same everywhere is the middle of one degree.
    const double unit = high > low ? niceCeiling(high - low) / 10 : 1;
    ranges.temperature = {unit * std::floor(low / unit + 1e-6), unit * std::ceil(high / unit - 1e-6)};
    if (!(ranges.temperature[0] < ranges.temperature[1]))
      ranges.temperature = {low - 0.5 * unit, low + 0.5 * unit};
  }
  return ranges;
}

}  // namespace smokebox
