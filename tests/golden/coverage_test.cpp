// The golden pictures between them show everything that a scene can ask for. What can be asked for is taken
// from the types of the scene's specification: a new kind of layer, event, shape or wall fails here until a
// golden scene has it.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "golden/set/golden_table.h"

namespace smokebox::golden {
namespace {

using Names = std::set<std::string>;

/// What the compiler calls a value or a type: "smokebox::LayerKind::smoke"; a number for one that has no
/// name.
template <auto value>
std::string nameOfValue() {
  const std::string_view text = __PRETTY_FUNCTION__;
  const std::size_t begin = text.find("value = ") + 8;
  return std::string(text.substr(begin, text.find_first_of(";]", begin) - begin));
}
template <class Type>
std::string nameOfType() {
  const std::string_view text = __PRETTY_FUNCTION__;
  const std::size_t begin = text.find("Type = ") + 7;
  return std::string(text.substr(begin, text.find_first_of(";]", begin) - begin));
}

/// The names of an enumeration's values, by their number.
template <class Enum, std::size_t... k>
std::vector<std::string> enumNames(std::index_sequence<k...>) {
  std::vector<std::string> names;
  for (const std::string& name : {nameOfValue<static_cast<Enum>(k)>()...})
    if (name.find('(') == std::string::npos) names.push_back(name);
  return names;
}
template <class Enum>
std::vector<std::string> enumNames() {
  constexpr std::size_t kMost = 64;
  return enumNames<Enum>(std::make_index_sequence<kMost>());
}

/// The names of a variant's alternatives, by their index.
template <class Variant>
struct Alternatives;
template <class... Type>
struct Alternatives<std::variant<Type...>> {
  static std::vector<std::string> names() { return {nameOfType<Type>()...}; }
};

template <class Enum>
void see(Names& seen, Enum value) {
  seen.insert(enumNames<Enum>().at(static_cast<std::size_t>(value)));
}

Names missing(const std::vector<std::string>& wanted, const Names& seen) {
  Names names;
  for (const std::string& name : wanted)
    if (!seen.contains(name)) names.insert(name);
  return names;
}

void seeShape(Names& seen, const PlacedShape& placed) {
  seen.insert(Alternatives<Shape>::names().at(placed.shape.index()));
  if (const auto* whole = std::get_if<UnionShape>(&placed.shape))
    for (const PlacedShape& part : whole->parts) seeShape(seen, part);
}

template <class Look>
void eachRow(Look look) {
  for (const Row& row : rows()) look(row, row.document().spec());
}

TEST(GoldenCoverage, HasEveryKindOfLayer) {
  // Each kind is in a golden picture, and shows.
  const std::vector<std::string> kinds = enumNames<LayerKind>();
  ASSERT_EQ(kinds.front(), "smokebox::LayerKind::smoke");
  Names seen;
  eachRow([&](const Row&, const SceneSpec& spec) {
    for (const LayerSpec& layer : spec.view.layers)
      if (layer.shown && layer.opacity > 0) see(seen, layer.kind);
  });
  EXPECT_EQ(missing(kinds, seen), Names{});
}

TEST(GoldenCoverage, HasEveryKindOfEvent) {
  // Each kind has happened before a golden picture is taken.
  Names seen;
  bool shown = false, hidden = false, repeated = false;
  eachRow([&](const Row& row, const SceneSpec& spec) {
    for (const EventSpec& event : spec.events) {
      if (event.first >= row.times.back()) continue;
      seen.insert(Alternatives<decltype(event.action)>::names().at(event.action.index()));
      if (const auto* visibility = std::get_if<VisibilityAction>(&event.action))
        (visibility->visible ? shown : hidden) = true;
      repeated |= event.every > 0;
    }
  });
  EXPECT_EQ(missing(Alternatives<decltype(EventSpec::action)>::names(), seen), Names{});
  EXPECT_TRUE(shown && hidden && repeated);
}

TEST(GoldenCoverage, HasEveryShape) {
  // Each is a solid in a golden picture, or smoke.
  Names seen;
  eachRow([&](const Row&, const SceneSpec& spec) {
    for (const SolidSpec& solid : spec.solids) seeShape(seen, solid.shape);
    for (const SourceSpec& source : spec.smoke.sources) seeShape(seen, source.shape);
  });
  EXPECT_EQ(missing(Alternatives<Shape>::names(), seen), Names{});
}

TEST(GoldenCoverage, HasEveryKindOfWall) {
  // Each kind, and among those that stick one that moves, and among inflows one with a profile.
  Names seen;
  bool moving = false, profile = false;
  eachRow([&](const Row&, const SceneSpec& spec) {
    for (const WallSpec& wall : spec.domain.walls) {
      see(seen, wall.kind);
      moving |= wall.kind == WallKind::noSlip && wall.velocity[0](0, 0, 0) != 0;
      profile |= wall.kind == WallKind::inflow && wall.velocity[0](0, 0.1, 0) != wall.velocity[0](0, 0.5, 0);
    }
  });
  EXPECT_EQ(missing(enumNames<WallKind>(), seen), Names{});
  EXPECT_TRUE(moving && profile);
}

/// The paths of all keys in a scene, positions in lists left out: "solids.motion.spin".
void seeKeys(const YAML::Node& node, const std::string& path, Names& seen) {
  if (node.IsMap()) {
    for (const auto& entry : node) {
      const std::string inner = (path.empty() ? "" : path + ".") + entry.first.as<std::string>();
      seen.insert(inner + (entry.second.IsScalar() ? "=" + entry.second.as<std::string>() : ""));
      seen.insert(inner);
      seeKeys(entry.second, inner, seen);
    }
  } else if (node.IsSequence()) {
    for (const YAML::Node& item : node) seeKeys(item, path, seen);
  }
}

TEST(GoldenCoverage, HasEveryMotionCameraAndOption) {
  // What a scene can say of motion, of the camera, of the ground, of sources and of layers.
  Names seen;
  for (const Row& row : rows()) seeKeys(YAML::LoadFile(row.scenePath()), "", seen);
  const Names layerOptions = {"opacity", "range", "spacing", "scale", "color", "shown"};
  for (const std::string& option : layerOptions) {
    bool found = false;
    for (const std::string& key : seen)
      found |= key.starts_with("view.layers.") && key.ends_with("." + option);
    EXPECT_TRUE(found) << "no layer has " << option;
  }
  EXPECT_EQ(
      missing({"solids.motion.velocity", "solids.motion.spin", "solids.motion.keyframes",
               "solids.motion.smooth=true", "solids.motion.smooth=false", "solids.motion.repeat=true",
               "solids.motion.expression.x", "solids.motion.expression.y", "solids.motion.expression.angle",
               "view.camera.center", "view.camera.height", "view.camera.follow", "view.background=light",
               "smoke.sources.from", "smoke.sources.until", "smoke.sources.velocity", "solids.color"},
              seen),
      Names{});
}

TEST(GoldenCoverage, HasDarkLightAndColoredGround) {
  // And captions: one, several at once, and one that an event tells.
  std::set<std::vector<float>> grounds;
  std::size_t captions = 0;
  eachRow([&](const Row&, const SceneSpec& spec) {
    const Color& c = spec.view.background;
    grounds.insert({c.r, c.g, c.b});
    captions = std::max(captions, spec.view.captions.size());
  });
  EXPECT_GE(grounds.size(), 3u);
  EXPECT_GE(captions, 2u);
}

}  // namespace
}  // namespace smokebox::golden
