#include "scene/read_shape.h"

#include <algorithm>

#include "base/maths.h"

namespace smokebox {
namespace {

struct Kind {
  const char* key;
  std::optional<PlacedShape> (*read)(Reader& reader, const YamlNode& node, const std::string& name);
};

std::optional<PlacedShape> readCircle(Reader& reader, const YamlNode& node, const std::string& name) {
  MapReader map(reader, node, name);
  CircleShape circle;
  Pose pose;
  const std::size_t before = reader.errors();
  map.vector("center", pose.position);
  if (map.required("radius")) map.number("radius", circle.radius, kPositive);
  map.finish();
  if (reader.errors() > before) return {};
  return PlacedShape{circle, pose};
}

std::optional<PlacedShape> readEllipse(Reader& reader, const YamlNode& node, const std::string& name) {
  MapReader map(reader, node, name);
  EllipseShape ellipse;
  Pose pose;
  const std::size_t before = reader.errors();
  map.vector("center", pose.position);
  if (map.required("radii")) map.vector("radii", ellipse.radii, kPositive);
  map.finish();
  if (reader.errors() > before) return {};
  return PlacedShape{ellipse, pose};
}

std::optional<PlacedShape> readBox(Reader& reader, const YamlNode& node, const std::string& name) {
  MapReader map(reader, node, name);
  BoxShape box;
  const std::size_t before = reader.errors();
  if (map.required("size")) map.vector("size", box.size, kPositive);
  map.finish();
  if (reader.errors() > before) return {};
  return PlacedShape{box, {}};
}

std::optional<PlacedShape> readCapsule(Reader& reader, const YamlNode& node, const std::string& name) {
  MapReader map(reader, node, name);
  CapsuleShape capsule;
  const std::size_t before = reader.errors();
  if (map.required("length", "between the centres of the caps"))
    map.number("length", capsule.length, kNotNegative);
  if (map.required("radius")) map.number("radius", capsule.radius, kPositive);
  map.finish();
  if (reader.errors() > before) return {};
  return PlacedShape{capsule, {}};
}

std::optional<PlacedShape> readRegular(Reader& reader, const YamlNode& node, const std::string& name) {
  MapReader map(reader, node, name);
  RegularShape regular;
  const std::size_t before = reader.errors();
  if (map.required("sides")) map.whole("sides", regular.sides, 3, 1000);
  if (map.required("radius", "from the centre to a corner")) map.number("radius", regular.radius, kPositive);
  map.finish();
  if (reader.errors() > before) return {};
  return PlacedShape{regular, {}};
}

std::optional<PlacedShape> readPolygon(Reader& reader, const YamlNode& node, const std::string& name) {
  if (!reader.isList(node, name)) return {};
  PolygonShape polygon;
  const std::size_t before = reader.errors();
  for (std::size_t k = 0; k < node.items.size(); ++k)
    if (const auto point = reader.vector(*node.items[k], inside(name, std::to_string(k))))
      polygon.points.push_back(*point);
  if (reader.errors() > before) return {};
  if (polygon.points.size() < 3) {
    reader.error(node.mark, "`" + name + "` has " + std::to_string(polygon.points.size()) + " points",
                 "a polygon needs at least 3");
    return {};
  }
  const std::string fault = polygonFault(polygon.points);
  if (!fault.empty()) {
    reader.error(node.mark, "`" + name + "`: " + fault);
    return {};
  }
  return PlacedShape{std::move(polygon), {}};
}

std::optional<PlacedShape> readUnion(Reader& reader, const YamlNode& node, const std::string& name) {
  if (!reader.isList(node, name)) return {};
  if (node.items.empty()) {
    reader.error(node.mark, "`" + name + "` has no shapes");
    return {};
  }
  UnionShape whole;
  const std::size_t before = reader.errors();
  for (std::size_t k = 0; k < node.items.size(); ++k)
    if (auto part = readPlacedShape(reader, *node.items[k], inside(name, std::to_string(k))))
      whole.parts.push_back(std::move(*part));
  if (reader.errors() > before) return {};
  return PlacedShape{std::move(whole), {}};
}

constexpr Kind kKinds[] = {{"circle", readCircle},   {"ellipse", readEllipse}, {"box", readBox},
                           {"capsule", readCapsule}, {"regular", readRegular}, {"polygon", readPolygon},
                           {"union", readUnion}};

}  // namespace

std::optional<PlacedShape> readPlacedShape(MapReader& map) {
  Reader& reader = map.reader();
  const std::size_t before = reader.errors();
  std::optional<PlacedShape> shape;
  std::string found, all;
  for (const Kind& kind : kKinds) {
    all += (all.empty() ? "" : ", ") + std::string(kind.key);
    map.find(kind.key);
    if (!map.has(kind.key)) continue;
    if (!found.empty()) {
      reader.error(map.keyMark(kind.key), "two shapes at once, `" + found + "` and `" + kind.key + "`",
                   "join them in a union: [{...}, {...}]");
      continue;
    }
    found = kind.key;
    const YamlNode* node = map.find(kind.key);
    if (!node)
      reader.error(map.keyMark(kind.key), "`" + inside(map.name(), kind.key) + "` has no value");
    else
      shape = kind.read(reader, *node, inside(map.name(), kind.key));
  }
  Pose own;
  double angle = 0;
  map.vector("position", own.position);
  if (map.number("angle", angle)) own.angleRad = radians(angle);
  if (found.empty() && map.isMap()) {
    // A key that is not known is reported by finish(), with the shape that it may mean.
    if (!map.hasMore()) reader.error(map.mark(), "`" + map.name() + "` names no shape", "one of " + all);
    return {};
  }
  if (!shape || reader.errors() > before) return {};
  shape->pose = combined(own, shape->pose);
  return shape;
}

std::optional<PlacedShape> readPlacedShape(Reader& reader, const YamlNode& node, const std::string& name) {
  if (node.kind == YamlNode::Kind::null) {
    reader.error(node.mark, "`" + name + "` names no shape");
    return {};
  }
  MapReader map(reader, node, name);
  auto shape = readPlacedShape(map);
  map.finish();
  return shape;
}

}  // namespace smokebox
