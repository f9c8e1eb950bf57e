// temperature
#include <cmath>

#include "scene/sections.h"

namespace smokebox {

namespace {

constexpr std::array<const char*, 4> kSides{"left", "right", "bottom", "top"};

void readTemperatureOfWalls(Reader& reader, const YamlNode& node, SceneSpec& spec) {
  MapReader map(reader, node, "temperature.walls");
  for (int side = 0; side < 4; ++side) {
    const YamlNode* wall = map.find(kSides[side]);
    if (!wall) continue;
    const std::string name = inside("temperature.walls", kSides[side]);
    if (auto read = reader.expression(*wall, name, "xyt")) spec.temperature.walls[side] = std::move(*read);
    if (spec.domain.walls[side].kind == WallKind::periodic)
      reader.error(wall->mark, "`" + name + "`: a periodic side has no temperature of its own",
                   "leave it out, or make the side a wall");
  }
  map.finish();
}

}  // namespace

void readTemperature(MapReader& scene, SceneSpec& spec) {
  const YamlNode* node = scene.find("temperature");
  TemperatureSpec& temperature = spec.temperature;
  temperature.named = scene.has("temperature");
  spec.hasFluid |= temperature.named;
  if (!node) return;
  Reader& reader = scene.reader();
  MapReader map(reader, *node, "temperature");
  map.number("diffusivity", temperature.diffusivity, kNotNegative);
  map.number("expansion", temperature.expansion);
  if (const YamlNode* start = map.find("start"))
    if (auto read = reader.expression(*start, "temperature.start", "xy"))
      temperature.start = std::move(*read);
  double reference = 0;
  if (map.number("reference", reference)) temperature.reference = reference;
  if (const YamlNode* walls = map.find("walls")) readTemperatureOfWalls(reader, *walls, spec);
  map.finish();
}

void checkTemperature(MapReader& scene, const SceneSpec& spec, bool warnings) {
  const TemperatureSpec& temperature = spec.temperature;
  const YamlNode* node = scene.find("temperature");
  if (!node || node->kind != YamlNode::Kind::map) return;
  Reader& reader = scene.reader();
  MapReader map(reader, *node, "temperature");
  const Grid& grid = spec.domain.grid;
  constexpr int kSamples = 9;
  for (int k = 0; k < kSamples * kSamples; ++k) {
    const Vec2 at{(k % kSamples + 0.5) / kSamples * grid.width(),
                  (k / kSamples + 0.5) / kSamples * grid.height()};
    if (std::isfinite(temperature.start(at.x, at.y, 0))) continue;
    reader.error(map.find("start")->mark, "`temperature.start` is not a finite number at x = " +
                                              std::to_string(at.x) + ", y = " + std::to_string(at.y));
    break;
  }
  for (int side = 0; side < 4; ++side) {
    const auto& wall = temperature.walls[side];
    if (!wall) continue;
    const YamlMark& mark = map.find("walls")->entry(kSides[side])->value->mark;
    const std::string name = "`temperature.walls." + std::string(kSides[side]) + "`";
    for (int k = 0; k < kSamples * kSamples; ++k) {
      const double along = (k % kSamples + 0.5) / kSamples, t = k / kSamples * spec.time.duration / 7.37;
      const Vec2 at = side < 2 ? Vec2{side == 0 ? 0 : grid.width(), along * grid.height()}
                               : Vec2{along * grid.width(), side == 2 ? 0 : grid.height()};
      if (std::isfinite((*wall)(at.x, at.y, t))) continue;
      reader.error(mark, name + " is not a finite number at x = " + std::to_string(at.x) +
                             ", y = " + std::to_string(at.y) + ", t = " + std::to_string(t));
      break;
    }
    const WallKind kind = spec.domain.walls[side].kind;
    if (warnings && temperature.diffusivity == 0 && (kind == WallKind::slip || kind == WallKind::noSlip))
      reader.warning(mark, name + " warms nothing: without a diffusivity no heat leaves a wall",
                     "temperature.diffusivity: 1e-3");
  }
  if (warnings && temperature.expansion != 0 && length(spec.gravity) == 0)
    reader.warning(node->mark, "without gravity nothing rises, however warm it is", "gravity: [0, -9.81]");
}

}  // namespace smokebox
