// solids, with their scripts of motion, and the probes that may follow them
#include <algorithm>

#include "base/maths.h"
#include "scene/names.h"
#include "scene/nearest.h"
#include "scene/read_shape.h"
#include "scene/sections.h"

namespace smokebox {
namespace {

MotionScript readKeyframes(MapReader& map, const YamlNode& node, const Pose& rest, double duration) {
  Reader& reader = map.reader();
  const std::string name = inside(map.name(), "keyframes");
  MotionScript::Keyframes keyframes;
  map.boolean("smooth", keyframes.smooth);
  map.boolean("repeat", keyframes.repeat);
  if (!reader.isList(node, name)) return {};
  if (node.items.empty()) {
    reader.error(node.mark, "`" + name + "` has no keyframes");
    return {};
  }
  Pose pose = rest;
  bool unused = false;
  for (std::size_t k = 0; k < node.items.size(); ++k) {
    MapReader frame(reader, *node.items[k], inside(name, std::to_string(k)));
    Keyframe key;
    double angle = 0;
    const bool timed = frame.required("at", "the time of the keyframe, s") && frame.number("at", key.at);
    frame.vector("position", pose.position);
    if (frame.number("angle", angle)) pose.angleRad = radians(angle);
    frame.finish();
    key.pose = pose;
    if (!timed) continue;
    if (!keyframes.frames.empty() && key.at <= keyframes.frames.back().at)
      reader.error(frame.find("at")->mark, "keyframes must come in the order of their times");
    // The first key after the end is still moved towards; those behind it are never reached.
    if (!keyframes.frames.empty() && keyframes.frames.back().at >= duration && !unused) {
      reader.warning(frame.mark(), "this keyframe lies after the end of the scene and is never reached");
      unused = true;
    }
    keyframes.frames.push_back(key);
  }
  if (keyframes.repeat && keyframes.frames.size() < 2)
    reader.error(map.find("repeat")->mark, "a motion that repeats needs at least two keyframes");
  return MotionScript(std::move(keyframes));
}

MotionScript readFormula(Reader& reader, const YamlNode& node, const std::string& name) {
  MapReader map(reader, node, name);
  MotionScript::Formula formula;
  auto part = [&](const char* key, std::optional<Expression>& into) {
    if (const YamlNode* found = map.find(key)) into = reader.expression(*found, inside(name, key), "t");
  };
  part("x", formula.x);
  part("y", formula.y);
  part("angle", formula.angleDegrees);
  map.finish();
  return MotionScript(std::move(formula));
}

MotionScript readMotion(Reader& reader, const YamlNode& node, const std::string& name, const Pose& rest,
                        double duration) {
  MapReader map(reader, node, name);
  const YamlNode* keyframes = map.find("keyframes");
  const YamlNode* formula = map.find("expression");
  const bool steady = map.has("velocity") || map.has("spin");
  MotionScript motion;
  if ((keyframes != nullptr) + (formula != nullptr) + steady > 1)
    reader.error(map.mark(), "`" + name + "` must be one of: velocity and spin, keyframes, expression");
  MotionScript::Steady uniform;
  double spin = 0;
  map.vector("velocity", uniform.velocity);
  if (map.number("spin", spin)) uniform.spinRad = radians(spin);
  const bool moves = uniform.velocity != Vec2{} || uniform.spinRad != 0;
  if (keyframes) {
    motion = readKeyframes(map, *keyframes, rest, duration);
  } else {
    for (const char* key : {"smooth", "repeat"}) {
      map.find(key);
      if (map.has(key)) reader.error(map.keyMark(key), "`" + std::string(key) + "` goes with keyframes");
    }
    if (formula) {
      motion = readFormula(reader, *formula, inside(name, "expression"));
    } else if (moves) {
      motion = MotionScript(uniform);
    }
  }
  map.finish();
  return motion;
}

SolidSpec readSolid(Reader& reader, const YamlNode& node, const std::string& name, const SceneSpec& spec) {
  MapReader map(reader, node, name);
  SolidSpec solid;
  if (map.text("name", solid.name)) {
    const YamlNode& where = *map.find("name");
    checkName(reader, where, solid.name);
    if (spec.names.find(solid.name)) reader.error(where.mark, "a second solid named `" + solid.name + "`");
  } else {
    solid.name = "solid " + std::to_string(spec.solids.size() + 1);
  }

  Pose rest;
  double angle = 0;
  const bool placed = map.has("position") || map.has("angle");
  map.vector("position", rest.position);
  if (map.number("angle", angle)) rest.angleRad = radians(angle);
  if (const YamlNode* shape = map.required("shape", "such as {circle: {radius: 0.1}}")) {
    if (auto read = readPlacedShape(reader, *shape, inside(name, "shape"))) {
      // A place inside of the shape is that of the solid, unless the solid has its own: then it is an offset.
      if (!placed) {
        rest = read->pose;
        solid.shape = {std::move(read->shape), rest};
      } else if (read->pose == Pose{}) {
        solid.shape = {std::move(read->shape), rest};
      } else {
        solid.shape = {UnionShape{{std::move(*read)}}, rest};
      }
    }
  }
  if (const YamlNode* motion = map.find("motion"))
    solid.motion = readMotion(reader, *motion, inside(name, "motion"), rest, spec.time.duration);

  solid.drag = spec.fluid.viscosity > 0 ? 1 : 0;
  map.number("drag", solid.drag, kShare);
  map.number("bounce", solid.bounce, kShare);
  map.number("friction", solid.friction, kNotNegative);
  map.color("color", solid.color);
  map.boolean("report", solid.report);
  map.finish();
  return solid;
}

ProbeSpec readProbe(Reader& reader, const YamlNode& node, const std::string& name, const SceneSpec& spec) {
  MapReader map(reader, node, name);
  ProbeSpec probe;
  if (map.text("name", probe.name)) {
    const YamlNode& where = *map.find("name");
    checkName(reader, where, probe.name);
    for (const ProbeSpec& other : spec.probes)
      if (other.name == probe.name) reader.error(where.mark, "a second probe named `" + probe.name + "`");
  } else {
    probe.name = "probe " + std::to_string(spec.probes.size() + 1);
  }
  Vec2 at;
  if (map.vector("at", at)) probe.at = at;
  if (const YamlNode* region = map.find("region"))
    probe.region = readPlacedShape(reader, *region, inside(name, "region"));
  if (!map.isWrong() && map.has("at") == map.has("region"))
    reader.error(map.mark(), "`" + name + "` must have either `at` or `region`");
  if (map.text("follow", probe.follow)) checkFollowed(reader, *map.find("follow"), spec, probe.follow);
  map.finish();
  return probe;
}

}  // namespace

bool checkSolidName(Reader& reader, const YamlNode& node, const SceneSpec& spec, const std::string& name) {
  std::vector<std::string> known;
  for (const SolidSpec& solid : spec.solids) {
    if (solid.name == name) return true;
    known.push_back(solid.name);
  }
  reader.error(node.mark, "no solid is named `" + name + "`", suggestion(name, known));
  return false;
}

void readSolids(MapReader& scene, SceneSpec& spec) {
  const YamlNode* node = scene.find("solids");
  if (!node || !scene.reader().isList(*node, "solids")) return;
  for (std::size_t k = 0; k < node->items.size(); ++k)
    addNamed(spec, readSolid(scene.reader(), *node->items[k], "solids." + std::to_string(k), spec));
}

void readProbes(MapReader& scene, SceneSpec& spec) {
  const YamlNode* node = scene.find("probes");
  if (!node || !scene.reader().isList(*node, "probes")) return;
  for (std::size_t k = 0; k < node->items.size(); ++k)
    spec.probes.push_back(readProbe(scene.reader(), *node->items[k], "probes." + std::to_string(k), spec));
}

}  // namespace smokebox
