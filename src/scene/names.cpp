#include "scene/names.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "scene/nearest.h"

namespace smokebox {
namespace {

constexpr const char* kWorld = "world";

/// The node of this cloth that `sheet.3.14` names; -1: none.
int nodeOf(const ClothSpec& cloth, const std::string& name) {
  const std::string start = cloth.name + ".";
  if (!name.starts_with(start)) return -1;
  const char* last = name.data() + name.size();
  int column = -1, row = -1;
  const auto [dot, fault] = std::from_chars(name.data() + start.size(), last, column);
  if (fault != std::errc() || dot == last || *dot != '.') return -1;
  const auto [end, rowFault] = std::from_chars(dot + 1, last, row);
  if (rowFault != std::errc() || end != last) return -1;
  if (column < 0 || row < 0 || column >= cloth.columns() || row >= cloth.rows()) return -1;
  return column + row * cloth.columns();
}

/// The particle of a cloth of that name.
std::optional<Movables::Node> clothNode(const SceneSpec& spec, const std::string& name) {
  for (std::size_t k = 0; k < spec.cloths.size(); ++k)
    if (const int node = nodeOf(spec.cloths[k], name); node >= 0)
      return Movables::Node{static_cast<int>(k), node};
  return {};
}

/// The last word of "no body, particle or cloth is named ...": what it may have meant.
std::string meant(const SceneSpec& spec, const std::string& name, bool solidsToo) {
  const std::size_t dot = name.find('.');
  if (dot != std::string::npos)
    for (const ClothSpec& cloth : spec.cloths)
      if (cloth.name == name.substr(0, dot))
        return cloth.name + ".0.0 to " + cloth.name + "." + std::to_string(cloth.cells[0]) + "." +
               std::to_string(cloth.cells[1]);
  return suggestion(name, namesOfThings(spec, solidsToo));
}

/// The body of that name, not of that of its copies; -1: none.
int bodyNamed(const SceneSpec& spec, const std::string& name) {
  const Named* named = spec.names.find(name);
  return named && named->of == Named::Of::body && spec.bodies[named->first].name == name ? named->first : -1;
}

}  // namespace

void addNamed(SceneSpec& spec, SolidSpec solid) {
  spec.names.add(solid.name, Named::Of::solid, static_cast<int>(spec.solids.size()));
  spec.solids.push_back(std::move(solid));
}

void addNamed(SceneSpec& spec, BodySpec body) {
  const int number = static_cast<int>(spec.bodies.size());
  spec.names.add(body.family, Named::Of::body, number);
  if (body.name != body.family) spec.names.add(body.name, Named::Of::body, number);
  spec.bodies.push_back(std::move(body));
}

void addNamed(SceneSpec& spec, ClothSpec cloth) {
  spec.names.add(cloth.name, Named::Of::cloth, static_cast<int>(spec.cloths.size()));
  spec.cloths.push_back(std::move(cloth));
}

std::vector<std::string> namesOfThings(const SceneSpec& spec, bool solidsToo) {
  std::vector<std::string> names;
  for (const BodySpec& body : spec.bodies)
    if (names.empty() || names.back() != body.family) names.push_back(body.family);
  for (const ClothSpec& cloth : spec.cloths) names.push_back(cloth.name);
  if (solidsToo)
    for (const SolidSpec& solid : spec.solids) names.push_back(solid.name);
  return names;
}

void checkName(Reader& reader, const YamlNode& node, const std::string& name) {
  if (name.empty()) reader.error(node.mark, "an empty name");
  if (name.find('.') != std::string::npos)
    reader.error(node.mark, "a name must not contain a dot, got `" + name + "`",
                 "dots part the steps of a path");
}

void checkNewName(Reader& reader, const YamlNode& node, const SceneSpec& spec, const std::string& name) {
  checkName(reader, node, name);
  if (name == kWorld) reader.error(node.mark, "the name `world` stands for the world");
  if (spec.names.find(name) && name.find('.') == std::string::npos)
    reader.error(node.mark, "a second thing named `" + name + "`",
                 "solids, bodies, particles and cloths share their names");
}

std::optional<HoldSpec> findHold(Reader& reader, const YamlNode& node, const SceneSpec& spec,
                                 const std::string& name, bool laterToo) {
  if (name == kWorld) return HoldSpec{};
  if (const int body = bodyNamed(spec, name); body >= 0) {
    if (spec.bodies[body].later && !laterToo) {
      reader.error(node.mark, "`" + name + "` is not there at the start: an event adds it");
      return {};
    }
    return HoldSpec{HoldSpec::Of::body, body, -1, {}};
  }
  if (spec.names.isPartOfWrong(name)) return {};
  const Named* named = spec.names.find(name);
  if (named && named->of == Named::Of::solid) return HoldSpec{HoldSpec::Of::solid, named->first, -1, {}};
  if (const auto found = clothNode(spec, name))
    return HoldSpec{HoldSpec::Of::cloth, found->cloth, found->node, {}};
  if (named && named->of == Named::Of::cloth)
    reader.error(node.mark, "`" + name + "` is a cloth; name one of its particles by column and row",
                 meant(spec, name + ".", true));
  else if (named && named->of == Named::Of::body)
    reader.error(node.mark,
                 "`" + name + "` stands for " + std::to_string(named->count) + " copies; name one of them",
                 name + ".0 to " + name + "." + std::to_string(named->count - 1));
  else
    reader.error(node.mark, "no body, particle or solid is named `" + name + "`", meant(spec, name, true));
  return {};
}

Movables findMovables(Reader& reader, const YamlNode& node, const SceneSpec& spec, const std::string& name) {
  Movables found;
  const Named* named = spec.names.find(name);
  if (named && named->of != Named::Of::solid)
    for (int k = 0; k < named->count; ++k)
      (named->of == Named::Of::body ? found.bodies : found.cloths).push_back(named->first + k);
  else if (const auto particle = clothNode(spec, name))
    found.nodes.push_back(*particle);
  else if (!spec.names.isPartOfWrong(name))
    reader.error(node.mark, "no body, particle or cloth is named `" + name + "`", meant(spec, name, false));
  return found;
}

void checkFollowed(Reader& reader, const YamlNode& node, const SceneSpec& spec, const std::string& name) {
  if (spec.names.isPartOfWrong(name)) return;
  std::vector<std::string> known;
  for (const SolidSpec& solid : spec.solids) known.push_back(solid.name);
  for (const BodySpec& body : spec.bodies) known.push_back(body.name);
  if (std::find(known.begin(), known.end(), name) == known.end())
    reader.error(node.mark, "no solid or body is named `" + name + "`", suggestion(name, known));
}

bool isMovable(const SceneSpec& spec, const std::string& name) {
  const Named* named = spec.names.find(name);
  return named && named->of != Named::Of::solid;
}

}  // namespace smokebox
