// springs and joints
#include <algorithm>
#include <cmath>

#include "base/maths.h"
#include "scene/names.h"
#include "scene/places.h"
#include "scene/sections.h"

namespace smokebox {
namespace {

/// The name of a spring or joint: they share theirs, for an event can cut either.
void readLinkName(MapReader& map, const SceneSpec& spec, std::string& name) {
  if (!map.text("name", name)) return;
  const YamlNode& where = *map.find("name");
  checkName(map.reader(), where, name);
  const auto is = [&](const auto& link) { return link.name == name; };
  if (std::any_of(spec.springs.begin(), spec.springs.end(), is) ||
      std::any_of(spec.joints.begin(), spec.joints.end(), is))
    map.reader().error(where.mark, "a second spring or joint named `" + name + "`");
}

/// {body: ball, at: [0, 0.1]} or {point: [2, 2]}.
std::optional<HoldSpec> readEnd(MapReader& spring, const char* key, const SceneSpec& spec) {
  Reader& reader = spring.reader();
  const YamlNode* node = spring.required(key, "{body: ball, at: [0, 0]} or {point: [1, 2]}");
  if (!node) return {};
  MapReader map(reader, *node, inside(spring.name(), key));
  std::optional<HoldSpec> end;
  Vec2 place;
  std::string body;
  if (!map.isWrong() && map.has("body") == map.has("point"))
    reader.error(map.mark(), "`" + map.name() + "` must have either `body` or `point`");
  if (map.text("body", body)) end = findHold(reader, *map.find("body"), spec, body, false);
  if (map.vector("at", place) && end) end->at = place;
  if (map.vector("point", place)) {
    end = HoldSpec{};
    end->at = place;
    if (map.has("at")) reader.error(map.keyMark("at"), "`at` goes with `body`");
  }
  map.finish();
  if (end && end->of == HoldSpec::Of::world && !end->at) {
    reader.error(map.mark(), "`" + map.name() + "` has no place in the world", "{point: [1, 2]}");
    return {};
  }
  return end;
}

void readSpring(Reader& reader, const YamlNode& node, const std::string& name, SceneSpec& spec) {
  MapReader map(reader, node, name);
  const std::size_t faults = reader.errors();
  SpringSpec spring;
  readLinkName(map, spec, spring.name);
  const auto from = readEnd(map, "from", spec), to = readEnd(map, "to", spec);
  double length = 0;
  if (map.number("length", length, kPositive)) spring.length = length;
  if (map.required("stiffness", "N/m")) map.number("stiffness", spring.stiffness, kNotNegative);
  map.number("damping", spring.damping, kNotNegative);
  map.color("color", spring.color);
  map.finish();
  if (from) spring.from = *from;
  if (to) spring.to = *to;
  if (reader.errors() == faults) {
    if (!canMove(spring.from) && !canMove(spring.to))
      reader.error(map.mark(), "`" + name + "` joins nothing that moves by itself");
    else if (spring.from == spring.to)
      reader.error(map.mark(), "both ends of `" + name + "` are the same point");
    else if (!spring.length && placeAtStart(spec, spring.from) == placeAtStart(spec, spring.to))
      reader.error(map.mark(), "`" + name + "` has no length at the start",
                   "give its length at rest: length: 0.1");
  }
  spec.springs.push_back(std::move(spring));
}

struct JointKey {
  const char* key;
  JointSpec::Kind kind;
};
constexpr JointKey kJoints[] = {{"pin", JointSpec::Kind::pin},
                                {"weld", JointSpec::Kind::weld},
                                {"slide", JointSpec::Kind::slide},
                                {"rope", JointSpec::Kind::rope}};

void readBothEnds(Reader& reader, const YamlNode& node, const std::string& name, const SceneSpec& spec,
                  JointSpec& joint) {
  if (!reader.isList(node, name, 2)) return;
  for (int k = 0; k < 2; ++k) {
    const std::string called = inside(name, std::to_string(k));
    const auto text = reader.text(*node.items[k], called);
    if (!text) continue;
    if (const auto end = findHold(reader, *node.items[k], spec, *text, false))
      (k == 0 ? joint.a : joint.b) = *end;
  }
}

void readLimits(MapReader& map, JointSpec& joint) {
  const YamlNode* node = map.find("limits");
  if (!node) return;
  const std::string name = inside(map.name(), "limits");
  const double unit = joint.kind == JointSpec::Kind::pin ? radians(1) : 1;
  const auto limits = map.reader().vector(*node, name);
  if (!limits) return;
  if (limits->x > limits->y)
    map.reader().error(node->mark, "`" + name + "` must be [low, high], the first not above the second");
  else if (limits->x > 0 || limits->y < 0)
    map.reader().error(node->mark, "`" + name + "` must have the start, 0, between them");
  joint.limits = {unit * limits->x, unit * limits->y};
}

void readMotor(MapReader& map, JointSpec& joint) {
  const YamlNode* node = map.find("motor");
  if (!node) return;
  const bool pin = joint.kind == JointSpec::Kind::pin;
  const char* limit = pin ? "torque" : "force";
  MapReader motor(map.reader(), *node, inside(map.name(), "motor"));
  if (motor.required("speed", pin ? "degrees/s" : "m/s") && motor.number("speed", joint.motorSpeed) && pin)
    joint.motorSpeed = radians(joint.motorSpeed);
  if (motor.required(limit, pin ? "the most that it has, N m" : "the most that it has, N"))
    motor.number(limit, joint.motorLimit, kNotNegative);
  motor.finish();
}

void readRope(MapReader& map, const SceneSpec& spec, JointSpec& joint, bool endsRight) {
  Vec2 place;
  for (const bool first : {true, false}) {
    const char* key = first ? "from" : "to";
    const HoldSpec& end = first ? joint.a : joint.b;
    if (map.vector(key, place))
      (first ? joint.from : joint.to) = place;
    else if (endsRight && end.of == HoldSpec::Of::world && !map.has(key))
      map.reader().error(map.mark(), "`" + inside(map.name(), key) + "` is missing",
                         "where in the world the rope is fastened");
  }
  double length = 0;
  const bool given = map.number("length", length, kPositive);
  if (given) joint.length = length;
  if (!endsRight) return;
  const Vec2 from = joint.from ? *joint.from : placeAtStart(spec, joint.a),
             to = joint.to ? *joint.to : placeAtStart(spec, joint.b);
  const double start = smokebox::length(to - from);
  if (given && start > length * (1 + 1e-9))
    map.reader().warning(map.find("length")->mark, "this rope is too short for its ends at the start",
                         "they are " + std::to_string(start) + " m apart and will be drawn together");
  if (!given && start == 0)
    map.reader().error(map.mark(), "`" + map.name() + "` has no length at the start", "length: 0.5");
}

void readJoint(Reader& reader, const YamlNode& node, const std::string& name, SceneSpec& spec) {
  MapReader map(reader, node, name);
  const std::size_t faults = reader.errors();
  JointSpec joint;
  readLinkName(map, spec, joint.name);
  int kinds = 0;
  for (const JointKey& key : kJoints) {
    const YamlNode* ends = map.find(key.key);
    if (!map.has(key.key)) continue;
    if (++kinds > 1) {
      reader.error(map.keyMark(key.key), "two joints at once", "make it a joint of its own");
      continue;
    }
    joint.kind = key.kind;
    if (ends)
      readBothEnds(reader, *ends, inside(name, key.key), spec, joint);
    else
      reader.error(map.keyMark(key.key), "`" + inside(name, key.key) + "` has no value", "two names: [a, b]");
  }
  const bool endsRight = reader.errors() == faults && kinds == 1;
  using Kind = JointSpec::Kind;
  Vec2 place;
  if (joint.kind == Kind::rope) {
    readRope(map, spec, joint, endsRight);
  } else {
    const bool placed = joint.kind == Kind::pin && kinds == 1
                            ? map.required("at", "where it is at the start, in the world") != nullptr
                            : map.has("at");
    if (placed && map.vector("at", place)) joint.at = place;
  }
  if (joint.kind == Kind::slide && map.vector("axis", joint.axis)) {
    const double size = length(joint.axis);
    if (!(size > 0)) reader.error(map.find("axis")->mark, "`" + inside(name, "axis") + "` has no direction");
    joint.axis = size > 0 ? (1 / size) * joint.axis : Vec2{1, 0};
  }
  if (joint.kind == Kind::pin || joint.kind == Kind::slide) {
    readLimits(map, joint);
    readMotor(map, joint);
  }
  const std::size_t before = reader.errors();
  map.finish();
  if (kinds == 0 && !map.isWrong() && reader.errors() == before)
    reader.error(map.mark(), "`" + name + "` is no joint", "one of pin, weld, slide, rope");
  if (endsRight) {
    if (!canMove(joint.a) && !canMove(joint.b))
      reader.error(map.mark(), "`" + name + "` joins nothing that moves by itself");
    else if (joint.a == joint.b)
      reader.error(map.mark(), "`" + name + "` joins a body to itself");
  }
  spec.joints.push_back(std::move(joint));
}

}  // namespace

void readLinks(MapReader& scene, SceneSpec& spec) {
  Reader& reader = scene.reader();
  if (const YamlNode* node = scene.find("springs"); node && reader.isList(*node, "springs"))
    for (std::size_t k = 0; k < node->items.size(); ++k)
      readSpring(reader, *node->items[k], "springs." + std::to_string(k), spec);
  if (const YamlNode* node = scene.find("joints"); node && reader.isList(*node, "joints"))
    for (std::size_t k = 0; k < node->items.size(); ++k)
      readJoint(reader, *node->items[k], "joints." + std::to_string(k), spec);
}

}  // namespace smokebox
