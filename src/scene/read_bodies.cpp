// bodies and particles, one by one and in blocks
#include "scene/read_bodies.h"

#include <algorithm>
#include <array>

#include "base/maths.h"
#include "base/random.h"
#include "scene/names.h"
#include "scene/places.h"
#include "scene/read_shape.h"
#include "scene/sections.h"

namespace smokebox {
namespace {

constexpr long kMostBodies = 200000;

/// `repeat`: a block of copies, each a little out of its place.
struct Block {
  std::array<long, 2> grid{1, 1};
  Vec2 spacing;
  double jitter = 0;   // share of the spacing, to either side
  double turnRad = 0;  // to either side
  int seed = 1;
  std::vector<PlacedShape> shapes;
  std::vector<Color> colors;
};

template <class Take>
void readList(MapReader& map, const char* key, Take take) {
  const YamlNode* node = map.find(key);
  if (!node || !map.reader().isList(*node, inside(map.name(), key))) return;
  if (node->items.empty())
    map.reader().error(node->mark, "`" + inside(map.name(), key) + "` is an empty list");
  for (std::size_t k = 0; k < node->items.size(); ++k)
    take(*node->items[k], inside(inside(map.name(), key), std::to_string(k)));
}

Block readBlock(Reader& reader, const YamlNode& node, const std::string& name, bool particle) {
  MapReader map(reader, node, name);
  Block block;
  if (const YamlNode* grid = map.required("grid", "columns and rows: [10, 4]"))
    if (reader.isList(*grid, inside(name, "grid"), 2)) {
      for (int k = 0; k < 2; ++k)
        if (const auto count =
                reader.whole(*grid->items[k], inside(name, "grid." + std::to_string(k)), 1, kMostBodies))
          block.grid[k] = *count;
      if (block.grid[0] * block.grid[1] > kMostBodies) {
        reader.error(grid->mark, "`" + inside(name, "grid") + "` makes more than " +
                                     std::to_string(kMostBodies) + " copies");
        block.grid = {1, 1};
      }
    }
  if (map.required("spacing", "metres between neighbours: [0.1, 0.1]")) map.vector("spacing", block.spacing);
  map.number("jitter", block.jitter, kShare);
  map.whole("seed", block.seed, 0, 1000000000);
  readList(map, "colors", [&](const YamlNode& item, const std::string& called) {
    if (const auto color = reader.color(item, called)) block.colors.push_back(*color);
  });
  if (!particle) {
    double turn = 0;
    if (map.number("turn", turn, kNotNegative)) block.turnRad = radians(turn);
    readList(map, "shapes", [&](const YamlNode& item, const std::string& called) {
      if (auto shape = readPlacedShape(reader, item, called)) block.shapes.push_back(std::move(*shape));
    });
  }
  map.finish();
  return block;
}

void readSurface(MapReader& map, BodySpec& body) {
  map.vector("velocity", body.velocity);
  map.number("bounce", body.bounce, kShare);
  map.number("friction", body.friction, kNotNegative);
  map.number("linear_damping", body.linearDamping, kNotNegative);
  map.number("gravity_scale", body.gravityScale);
  map.color("color", body.color);
  readGroups(map, body.ignore);
  bool held = false;
  if (map.boolean("held", held) && held) body.heldUntil = kForever;
  if (map.number("held_until", body.heldUntil, kNotNegative) && held)
    map.reader().error(map.find("held_until")->mark, "`held` and `held_until` at once",
                       "held: true holds it until an event releases it");
}

/// The copies of a body whose outline has its own (0, 0) at `own`; they take its place and angle, and a
/// little of their own.
void addCopies(const Block& block, const BodySpec& first, const std::vector<PlacedShape>& shapes, bool placed,
               const Pose& own, bool repeated, const BodyOrigin& origin, SceneSpec& spec) {
  struct Kind {
    std::shared_ptr<const Shape> shape;
    Pose within;  // of the shape, inside of the body
    Vec2 centre;  // of mass, in the shape's own coordinates
  };
  std::vector<Kind> kinds;
  for (const PlacedShape& shape : shapes) {
    // A place inside of the shape is that of the body, unless the body has its own: then it is an offset.
    const bool offset = placed && !(shape.pose == Pose{});
    const Shape made = offset ? Shape(UnionShape{{shape}}) : shape.shape;
    kinds.push_back({std::make_shared<const Shape>(made), offset ? Pose{} : shape.pose, centreOfMass(made)});
  }
  const long count = block.grid[0] * block.grid[1];
  for (long time = 0; time < origin.times; ++time)
    for (long k = 0; k < count; ++k) {
      const auto seed = static_cast<std::uint64_t>(block.seed);
      const auto index = static_cast<std::uint64_t>(time * count + k);  // no two times are alike
      auto chance = [&](std::uint64_t channel) { return randomShare(seed, channel, index); };
      auto either = [&](std::uint64_t channel) { return 2 * chance(channel) - 1; };
      auto choice = [&](std::uint64_t channel, std::size_t of) {
        return std::min(of - 1, static_cast<std::size_t>(chance(channel) * static_cast<double>(of)));
      };
      const Kind& kind = kinds[choice(0, kinds.size())];
      const Vec2 step{static_cast<double>(k % block.grid[0]) + block.jitter * either(1),
                      static_cast<double>(k / block.grid[0]) + block.jitter * either(2)};
      BodySpec body = first;
      body.shape = kind.shape;
      if (!block.colors.empty()) body.color = block.colors[choice(4, block.colors.size())];
      // The angle of the body is about its centre of mass; one inside of the shape about the shape's (0, 0).
      const double angle = own.angleRad + block.turnRad * either(3);
      const Pose start = placed ? Pose{own.position, 0} : kind.within;
      const Vec2 centre = transformed(kind.centre, start);
      body.pose.angleRad = start.angleRad + angle;
      body.pose.position = centre - transformed(kind.centre, Pose{{}, body.pose.angleRad});
      body.pose.position = body.pose.position + Vec2{step.x * block.spacing.x, step.y * block.spacing.y};
      if (repeated || origin.times > 1) body.name += "." + std::to_string(time * count + k);
      addNamed(spec, std::move(body));
    }
}

}  // namespace

void readGroups(MapReader& map, std::vector<std::string>& groups) {
  const YamlNode* node = map.find("ignore");
  if (!node) return;
  const std::string name = inside(map.name(), "ignore");
  auto one = [&](const YamlNode& item, const std::string& called) {
    const auto group = map.reader().text(item, called);
    if (group && std::find(groups.begin(), groups.end(), *group) == groups.end()) groups.push_back(*group);
  };
  if (node->kind != YamlNode::Kind::list) return one(*node, name);
  for (std::size_t k = 0; k < node->items.size(); ++k) one(*node->items[k], inside(name, std::to_string(k)));
}

int readBody(Reader& reader, const YamlNode& node, const std::string& name, const BodyOrigin& origin,
             SceneSpec& spec) {
  const std::size_t faults = reader.errors(), before = spec.bodies.size();
  MapReader map(reader, node, name);
  BodySpec body;
  body.particle = origin.particle;
  body.item = origin.item;
  body.later = origin.later;
  if (map.text("name", body.name)) {
    checkNewName(reader, *map.find("name"), spec, body.name);
  } else {
    long number = origin.item;
    do
      body.name =
          (origin.particle ? "particle " : "body ") + std::to_string(++number + (origin.later ? 1 : 0));
    while (spec.names.find(body.name));
  }
  body.family = body.name;

  const YamlNode* repeat = map.find("repeat");
  Block block;
  if (repeat) block = readBlock(reader, *repeat, inside(name, "repeat"), origin.particle);
  Pose own;
  bool placed = origin.particle || map.has("position") || map.has("angle");
  std::vector<PlacedShape> shapes = block.shapes;
  if (origin.particle) {
    double radius = 0.01, mass = 0.01;
    if (map.required("position", "[x, y], metres")) map.vector("position", own.position);
    map.number("radius", radius, kPositive);
    map.number("mass", mass, kPositive);
    body.mass = mass;
    shapes.push_back({CircleShape{radius}, {}});
  } else {
    double angle = 0, spin = 0, mass = 0;
    map.vector("position", own.position);
    if (map.number("angle", angle)) own.angleRad = radians(angle);
    const YamlNode* shape =
        block.shapes.empty() ? map.required("shape", "such as {circle: {radius: 0.1}}") : map.find("shape");
    if (shape && !block.shapes.empty())
      reader.error(shape->mark, "`shape` and `repeat.shapes` at once");
    else if (shape)
      if (auto read = readPlacedShape(reader, *shape, inside(name, "shape")))
        shapes.push_back(std::move(*read));
    if (map.number("spin", spin)) body.spinRad = radians(spin);
    map.number("density", body.density, kPositive);
    if (map.number("mass", mass, kPositive)) body.mass = mass;
    if (map.has("mass") && map.has("density"))
      reader.error(map.keyMark("mass"), "`mass` and `density` at once", "either gives the other");
    body.drag = spec.fluid.viscosity > 0 ? 1 : 0;
    map.number("drag", body.drag, kShare);
    map.number("angular_damping", body.angularDamping, kNotNegative);
  }
  readSurface(map, body);
  map.finish();
  if (reader.errors() > faults || shapes.empty()) {
    // Its name stays known, so that nothing else is reported because of it.
    body.shape = std::make_shared<const Shape>(CircleShape{1});
    body.pose = own;
    spec.names.add(body.name, Named::Of::body, static_cast<int>(before));
    spec.names.markWrong(body.name);
    spec.bodies.push_back(std::move(body));
    return 1;
  }
  const long copies = block.grid[0] * block.grid[1] * origin.times;
  if (copies + static_cast<long>(before) > kMostBodies) {
    reader.error(node.mark, "more than " + std::to_string(kMostBodies) + " bodies and particles");
    return 0;
  }
  addCopies(block, body, shapes, placed, own, repeat != nullptr, origin, spec);
  return static_cast<int>(spec.bodies.size() - before);
}

void readBodies(MapReader& scene, SceneSpec& spec) {
  for (const bool particle : {false, true}) {
    const char* key = particle ? "particles" : "bodies";
    const YamlNode* node = scene.find(key);
    if (!node || !scene.reader().isList(*node, key)) continue;
    for (std::size_t k = 0; k < node->items.size(); ++k)
      readBody(scene.reader(), *node->items[k], inside(key, std::to_string(k)),
               {particle, static_cast<int>(k), false, 1}, spec);
  }
}

}  // namespace smokebox
