// gravity, fluid, smoke
#include "scene/read_shape.h"
#include "scene/sections.h"

namespace smokebox {

void readFluid(MapReader& scene, SceneSpec& spec) {
  scene.vector("gravity", spec.gravity);
  const YamlNode* node = scene.find("fluid");
  spec.hasFluid |= scene.has("fluid");
  for (const WallSpec& wall : spec.domain.walls) spec.hasFluid |= wall.kind == WallKind::inflow;
  if (!node) return;
  MapReader map(scene.reader(), *node, "fluid");
  map.number("density", spec.fluid.density, kPositive);
  map.number("viscosity", spec.fluid.viscosity, kNotNegative);
  map.number("vorticity", spec.fluid.vorticity, kNotNegative);
  if (const YamlNode* velocity = map.find("velocity"))
    if (auto read = scene.reader().expressions(*velocity, "fluid.velocity", "xy"))
      spec.fluid.velocity = *read;
  map.finish();
}

namespace {

std::optional<SourceSpec> readSource(Reader& reader, const YamlNode& node, const std::string& name) {
  MapReader map(reader, node, name);
  SourceSpec source;
  std::optional<PlacedShape> shape;
  if (const YamlNode* found = map.required("shape", "such as {circle: {center: [1, 1], radius: 0.1}}"))
    shape = readPlacedShape(reader, *found, inside(name, "shape"));
  map.number("rate", source.rate, kNotNegative);
  Vec2 velocity;
  if (map.vector("velocity", velocity)) source.velocity = velocity;
  map.color("color", source.color);
  map.number("from", source.from, kNotNegative);
  if (map.number("until", source.until, kNotNegative) && source.until <= source.from)
    reader.error(map.find("until")->mark, "`" + name + "` ends before it starts");
  map.finish();
  if (!shape) return {};
  source.shape = std::move(*shape);
  return source;
}

}  // namespace

void readSmoke(MapReader& scene, SceneSpec& spec) {
  const YamlNode* node = scene.find("smoke");
  spec.hasFluid |= scene.has("smoke");
  if (!node) return;
  MapReader map(scene.reader(), *node, "smoke");
  map.number("buoyancy", spec.smoke.buoyancy);
  if (const YamlNode* sources = map.find("sources"))
    if (scene.reader().isList(*sources, "smoke.sources"))
      for (std::size_t k = 0; k < sources->items.size(); ++k)
        if (auto source =
                readSource(scene.reader(), *sources->items[k], "smoke.sources." + std::to_string(k)))
          spec.smoke.sources.push_back(std::move(*source));
  map.finish();
}

std::vector<Color> SceneSpec::smokeColors() const {
  std::vector<Color> colors;
  auto add = [&](const Color& color) {
    for (const Color& known : colors)
      if (known == color) return;
    colors.push_back(color);
  };
  for (const SourceSpec& source : smoke.sources) add(source.color);
  for (const EventSpec& event : events)
    if (const auto* burst = std::get_if<BurstAction>(&event.action)) add(burst->color);
  for (const Color& color : laterSmokeColors) add(color);
  return colors;
}

}  // namespace smokebox
