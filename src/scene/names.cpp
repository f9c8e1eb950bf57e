#include "scene/names.h"

#include <algorithm>
#include <charconv>

#include "scene/nearest.h"

namespace smokebox {
namespace {

constexpr const char* kWorld = "world";

/// The node that `sheet.3.14` names; -1: none.
int clothNode(const ClothSpec& cloth, const std::string& name) {
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

}  // namespace

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
  const std::vector<std::string> others = namesOfThings(spec, true);
  if (std::find(others.begin(), others.end(), name) != others.end())
    reader.error(node.mark, "a second thing named `" + name + "`",
                 "solids, bodies, particles and cloths share their names");
}

std::optional<HoldSpec> findHold(Reader& reader, const YamlNode& node, const SceneSpec& spec,
                                 const std::string& name, bool laterToo) {
  if (name == kWorld) return HoldSpec{};
  const auto& bodies = spec.bodies;
  auto is = [&](const BodySpec& body) { return body.name == name; };
  if (const auto body = std::find_if(bodies.begin(), bodies.end(), is); body != bodies.end()) {
    if (body->later && !laterToo) {
      reader.error(node.mark, "`" + name + "` is not there at the start: an event adds it");
      return {};
    }
    return HoldSpec{HoldSpec::Of::body, static_cast<int>(body - bodies.begin()), -1, {}};
  }
  for (std::size_t k = 0; k < spec.solids.size(); ++k)
    if (spec.solids[k].name == name) return HoldSpec{HoldSpec::Of::solid, static_cast<int>(k), -1, {}};
  for (std::size_t k = 0; k < spec.cloths.size(); ++k) {
    const int clothsNode = clothNode(spec.cloths[k], name);
    if (clothsNode >= 0) return HoldSpec{HoldSpec::Of::cloth, static_cast<int>(k), clothsNode, {}};
    if (spec.cloths[k].name != name) continue;
    reader.error(node.mark, "`" + name + "` is a cloth; name one of its particles by column and row",
                 meant(spec, name + ".", true));
    return {};
  }
  const auto copies =
      std::count_if(bodies.begin(), bodies.end(), [&](const BodySpec& body) { return body.family == name; });
  if (copies > 0)
    reader.error(node.mark,
                 "`" + name + "` stands for " + std::to_string(copies) + " copies; name one of them",
                 name + ".0 to " + name + "." + std::to_string(copies - 1));
  else
    reader.error(node.mark, "no body, particle or solid is named `" + name + "`", meant(spec, name, true));
  return {};
}

Movables findMovables(Reader& reader, const YamlNode& node, const SceneSpec& spec, const std::string& name) {
  Movables found;
  for (std::size_t k = 0; k < spec.bodies.size(); ++k)
    if (spec.bodies[k].family == name || spec.bodies[k].name == name)
      found.bodies.push_back(static_cast<int>(k));
  for (std::size_t k = 0; k < spec.cloths.size(); ++k)
    if (spec.cloths[k].name == name) found.cloths.push_back(static_cast<int>(k));
  if (found.bodies.empty() && found.cloths.empty())
    reader.error(node.mark, "no body, particle or cloth is named `" + name + "`", meant(spec, name, false));
  return found;
}

void checkFollowed(Reader& reader, const YamlNode& node, const SceneSpec& spec, const std::string& name) {
  std::vector<std::string> known;
  for (const SolidSpec& solid : spec.solids) known.push_back(solid.name);
  for (const BodySpec& body : spec.bodies) known.push_back(body.name);
  if (std::find(known.begin(), known.end(), name) == known.end())
    reader.error(node.mark, "no solid or body is named `" + name + "`", suggestion(name, known));
}

bool isMovable(const SceneSpec& spec, const std::string& name) {
  return std::any_of(spec.bodies.begin(), spec.bodies.end(),
                     [&](const BodySpec& b) { return b.family == name || b.name == name; }) ||
         std::any_of(spec.cloths.begin(), spec.cloths.end(),
                     [&](const ClothSpec& cloth) { return cloth.name == name; });
}

}  // namespace smokebox
