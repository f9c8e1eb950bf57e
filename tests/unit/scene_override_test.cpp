// Overrides laid over a scene, and the hash that tells them apart.
#include <gtest/gtest.h>

#include <algorithm>

#include "scene/document.h"

namespace smokebox {
namespace {

constexpr const char* kScene = R"yaml(domain: {size: [2, 1], resolution: 64}
walls: {left: {inflow: [1, 0]}, right: open}
smoke:
  sources:
    - {shape: {circle: {center: [0.3, 0.5], radius: 0.05}}, rate: 4}
    - {shape: {circle: {center: [0.3, 0.2], radius: 0.05}}, rate: 5}
solids:
  - {name: car, shape: {circle: {radius: 0.1}}, position: [1, 0.5]}
  - {name: fan, shape: {box: {size: [0.6, 0.05]}}, position: [1.5, 0.5]}
  - {shape: {circle: {radius: 0.1}}, position: [1, 0.5]}
)yaml";

const SourcePlace kPlace{"--set", 0, 0};

SceneDocument document() { return SceneDocument::parse(kScene, "s.yaml"); }

SceneSpec withOverride(const std::string& path, const std::string& value) {
  SceneDocument changed = document();
  changed.set(path, value, kPlace);
  return changed.spec();
}

std::string faultOf(const std::string& path, const std::string& value) {
  try {
    withOverride(path, value);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "no fault";
}

TEST(SceneOverride, ReachesKeysListsAndNames) {
  // Truth: the value that was set, and nothing else, is different.
  EXPECT_EQ(withOverride("smoke.sources.1.rate", "2").smoke.sources[1].rate, 2);
  EXPECT_EQ(withOverride("smoke.sources.1.rate", "2").smoke.sources[0].rate, 4);
  EXPECT_EQ(withOverride("solids.fan.drag", "1/4").solids[1].drag, 0.25);
  EXPECT_EQ(withOverride("solids.2.drag", "1").solids[2].drag, 1);
  EXPECT_EQ(withOverride("domain.resolution", "128").domain.grid.nx, 128);
  EXPECT_EQ(withOverride("domain.size.1", "0.5").domain.grid.ny, 16);
  EXPECT_EQ(withOverride("walls.left.inflow", "[2*pi, 0]").domain.walls[0].velocity[0](0, 0, 0),
            2 * 3.14159265358979323846);
  EXPECT_EQ(withOverride("walls.left", "open").domain.walls[0].kind, WallKind::open);
  EXPECT_EQ(withOverride("title", "\"a: b\"").title, "a: b");
}

TEST(SceneOverride, MakesWhatTheFileLeavesOut) {
  // Truth: any key that a scene may have can be set, in the file or not.
  EXPECT_EQ(withOverride("fluid.vorticity", "0.5").fluid.vorticity, 0.5);
  EXPECT_EQ(withOverride("view.camera.height", "1").view.camera.height, 1);
  EXPECT_EQ(withOverride("gravity", "[0, -1]").gravity.y, -1);
  EXPECT_EQ(withOverride("solids.fan.motion.spin", "90").solids[1].motion.isStill(), false);
}

LayerSpec layerOf(const SceneSpec& spec, LayerKind kind) {
  for (const LayerSpec& layer : spec.view.layers)
    if (layer.kind == kind) return layer;
  ADD_FAILURE() << "no layer " << layerName(kind);
  return {};
}

TEST(SceneOverride, LayersAreReachedByTheirNames) {
  // Truth: a bare name becomes a map of options; other options and other layers stay; every entry of the name
  // is reached; without a list the default layers are there.
  const char* list =
      "[time, bodies, {pressure: {opacity: 0.6, range: [-2, 2]}}, speed, {speed: {bar: false}}]";
  auto with = [&](const std::string& path, const std::string& value) {
    SceneDocument changed = document();
    changed.set("view.layers", list, kPlace);
    changed.set(path, value, kPlace);
    return changed.spec();
  };
  const LayerSpec pressure = layerOf(with("view.layers.pressure.range", "[-1, 1]"), LayerKind::pressure);
  EXPECT_EQ(pressure.range, (std::array<double, 2>{-1, 1}));
  EXPECT_EQ(pressure.opacity, 0.6);
  EXPECT_FALSE(layerOf(with("view.layers.time.shown", "false"), LayerKind::time).shown);
  EXPECT_TRUE(layerOf(with("view.layers.time.shown", "false"), LayerKind::pressure).shown);
  EXPECT_EQ(layerOf(with("view.layers.pressure", "{bar: false}"), LayerKind::pressure).opacity, 1);
  const SceneSpec both = with("view.layers.speed.opacity", "1/4");
  ASSERT_EQ(both.view.layers.size(), 5u);
  EXPECT_EQ(both.view.layers[3].opacity, 0.25);
  EXPECT_EQ(both.view.layers[4].opacity, 0.25);
  EXPECT_FALSE(both.view.layers[4].bar);
  const SceneSpec byPosition = with("view.layers.3.speed.opacity", "1/4");
  EXPECT_EQ(byPosition.view.layers[3].opacity, 0.25);
  EXPECT_EQ(byPosition.view.layers[4].opacity, 1);
  EXPECT_EQ(with("view.layers.2", "vorticity").view.layers[2].kind, LayerKind::vorticity);

  EXPECT_EQ(layerOf(withOverride("view.layers.smoke.opacity", "0.5"), LayerKind::smoke).opacity, 0.5);
  EXPECT_EQ(withOverride("view.layers.smoke.opacity", "0.5").view.layers.size(), 3u);
  EXPECT_NE(faultOf("view.layers.smke.opacity", "1").find("did you mean `smoke`?"), std::string::npos)
      << faultOf("view.layers.smke.opacity", "1");
  EXPECT_NE(faultOf("view.layers.pressure.opacity", "1").find("nothing in `view.layers` is named `pressure`"),
            std::string::npos);
  EXPECT_NE(faultOf("view.layers.smoke.range", "[0, 1]").find("--set: unknown key `range`"),
            std::string::npos);
  EXPECT_NE(faultOf("view.layers.0.opacity", "1").find("view.layers.smoke.opacity"), std::string::npos)
      << faultOf("view.layers.0.opacity", "1");
}

TEST(SceneOverride, LeavesOtherCopiesAlone) {
  // Truth: a document is a value.
  const SceneDocument first = document();
  SceneDocument second = first;
  second.set("fluid.vorticity", "1", kPlace);
  EXPECT_EQ(first.spec().fluid.vorticity, 0);
  EXPECT_EQ(second.spec().fluid.vorticity, 1);
}

TEST(SceneOverride, IsCheckedLikeTheFile) {
  // Truth: the faults of a file, at the override's place.
  EXPECT_NE(faultOf("fluid.vortcity", "1").find("--set: unknown key `vortcity` in `fluid` (did you mean"),
            std::string::npos)
      << faultOf("fluid.vortcity", "1");
  EXPECT_NE(faultOf("fluyd.vorticity", "1").find("--set: unknown key `fluyd` (did you mean `fluid`?)"),
            std::string::npos)
      << faultOf("fluyd.vorticity", "1");
  EXPECT_NE(faultOf("fluid.density", "-1").find("--set: `fluid.density` must be larger than 0"),
            std::string::npos);
  EXPECT_NE(
      faultOf("solids.fna.drag", "1").find("--set: `solids.fna.drag`: nothing in `solids` is named `fna`"),
      std::string::npos);
  EXPECT_NE(faultOf("solids.fna.drag", "1").find("did you mean `fan`?"), std::string::npos);
  EXPECT_NE(faultOf("smoke.sources.2.rate", "1").find("has 2 items"), std::string::npos);
  EXPECT_NE(faultOf("smoke.sources.0.rate.x", "1").find("single value"), std::string::npos);
  EXPECT_NE(faultOf("events.0.at", "1").find("no list `events`"), std::string::npos);
  EXPECT_NE(faultOf("fluid..density", "1").find("is no path"), std::string::npos);
  EXPECT_NE(faultOf("", "1").find("is no path"), std::string::npos);
  EXPECT_NE(faultOf("fluid.density", "[1").find("--set: not YAML"), std::string::npos)
      << faultOf("fluid.density", "[1");
  EXPECT_NE(faultOf("fluid", "{density: 1, density: 2}").find("twice"), std::string::npos);
}

TEST(SceneOverride, ChangesTheHash) {
  // Truth: equal text and overrides give equal hashes, and any difference another one.
  SceneDocument changed = document();
  EXPECT_EQ(changed.hash(), document().hash());
  EXPECT_EQ(changed.hash().size(), 16u);
  changed.set("fluid.vorticity", "1", kPlace);
  EXPECT_NE(changed.hash(), document().hash());
  SceneDocument other = document();
  other.set("fluid.vorticity", "2", kPlace);
  EXPECT_NE(changed.hash(), other.hash());
  EXPECT_NE(SceneDocument::parse(std::string(kScene) + "#", "s.yaml").hash(), document().hash());
}

TEST(SceneOverride, TextOfASetEventGivesTheSameValueBack) {
  // Truth: what an event sets is kept as one line of YAML that reads as the value did.
  const std::string text = std::string(kScene) +
                           "events:\n"
                           "  - at: 1\n"
                           "    set:\n"
                           "      walls.left.inflow: ['2*y', \"0\"]\n"
                           "      smoke.sources.0.color: \"#ff8000\"\n"
                           "      view.captions: [{text: \"a \\\"b\\\": c\\nd\", until: 2}]\n"
                           "      solids.car.drag: 1/2\n";
  SceneDocument changed = SceneDocument::parse(text, "s.yaml");
  const SceneSpec before = changed.spec();
  ASSERT_EQ(before.events.size(), 4u);
  for (const EventSpec& event : before.events) {
    const auto& set = std::get<SetAction>(event.action);
    EXPECT_EQ(set.value.find('\n'), std::string::npos);
    changed.set(set.path, set.value, set.place);
  }
  const SceneSpec after = changed.spec();
  EXPECT_EQ(after.domain.walls[0].velocity[0](0, 3, 0), 6);
  EXPECT_EQ(after.smoke.sources[0].color, (Color{1, 128 / 255.f, 0}));
  EXPECT_EQ(after.view.captions.at(0).text, "a \"b\": c\nd");
  EXPECT_EQ(after.solids[0].drag, 0.5);
  // The colour that comes later is known from the start.
  const std::vector<Color> colors = before.smokeColors();
  EXPECT_NE(std::find(colors.begin(), colors.end(), Color{1, 128 / 255.f, 0}), colors.end());
}

}  // namespace
}  // namespace smokebox
