// view: layers, captions, background, camera
#include <algorithm>

#include "scene/names.h"
#include "scene/nearest.h"
#include "scene/sections.h"
#include "scene/tree_path.h"

namespace smokebox {
namespace {

// What may stand beside each layer's name; `shown` may stand beside any.
enum Option : unsigned {
  opacity = 1,
  range = 2,
  bar = 4,
  spacing = 8,
  scale = 16,
  color = 32,
  mark = 64,
  length = 128,
  fade = 256,
  side = 512
};

struct LayerEntry {
  const char* key;
  LayerKind kind;
  unsigned options;
};
constexpr LayerEntry kLayers[] = {
    {"smoke", LayerKind::smoke, opacity},
    {"solids", LayerKind::solids, opacity | color},
    {"pressure", LayerKind::pressure, opacity | range | bar},
    {"vorticity", LayerKind::vorticity, opacity | range | bar},
    {"speed", LayerKind::speed, opacity | range | bar},
    {"temperature", LayerKind::temperature, opacity | range | bar},
    {"velocity", LayerKind::velocity, opacity | spacing | scale | color},
    {"caption", LayerKind::caption, opacity | color | side},
    {"time", LayerKind::time, opacity | color},
    {"probes", LayerKind::probes, opacity | color},
    {"bodies", LayerKind::bodies, opacity | color | mark},
    {"particles", LayerKind::particles, opacity | color},
    {"springs", LayerKind::springs, opacity | color | range},
    {"joints", LayerKind::joints, opacity | color},
    {"cloth", LayerKind::cloth, opacity | color},
    {"trails", LayerKind::trails, opacity | color | length},
    {"collisions", LayerKind::collisions, opacity | color | fade},
};

const LayerEntry* layerNamed(Reader& reader, const YamlMark& mark, const std::string& key) {
  std::vector<std::string> known;
  for (const LayerEntry& entry : kLayers) {
    if (key == entry.key) return &entry;
    known.emplace_back(entry.key);
  }
  reader.error(mark, "unknown layer `" + key + "`", suggestion(key, known));
  return nullptr;
}

void readOptions(Reader& reader, const YamlNode& node, const std::string& name, unsigned allowed,
                 LayerSpec& layer) {
  MapReader map(reader, node, name);
  map.boolean("shown", layer.shown);
  if (allowed & Option::opacity) map.number("opacity", layer.opacity, kShare);
  if (allowed & Option::range) {
    if (const YamlNode* found = map.find("range"); found && reader.isList(*found, inside(name, "range"), 2)) {
      const auto low = reader.number(*found->items[0], inside(name, "range.0"));
      const auto high = reader.number(*found->items[1], inside(name, "range.1"));
      if (low && high && !(*low < *high))
        reader.error(found->mark,
                     "`" + inside(name, "range") + "` must be [low, high], the first below the second");
      else if (low && high)
        layer.range = {*low, *high};
    }
  }
  if (allowed & Option::bar) map.boolean("bar", layer.bar);
  if (allowed & Option::spacing) map.number("spacing", layer.spacing, kPositive);
  if (allowed & Option::scale) map.number("scale", layer.scale, kPositive);
  if (allowed & Option::color) map.color("color", layer.color);
  if (allowed & Option::mark) map.boolean("mark", layer.mark);
  if (allowed & Option::length) map.number("length", layer.length, kPositive);
  if (allowed & Option::fade) map.number("fade", layer.fade, kPositive);
  std::string side;
  if ((allowed & Option::side) && map.text("side", side)) {
    layer.atTop = side == "top";
    if (side != "top" && side != "bottom")
      reader.error(map.find("side")->mark, "`" + inside(name, "side") + "` must be top or bottom");
  }
  map.finish();
}

void readLayer(Reader& reader, const YamlNode& node, const std::string& name, ViewSpec& view) {
  const YamlNode* options = nullptr;
  const LayerEntry* entry = nullptr;
  if (node.kind == YamlNode::Kind::scalar) {
    entry = layerNamed(reader, node.mark, node.text);
  } else if (node.kind == YamlNode::Kind::map && node.entries.size() == 1) {
    entry = layerNamed(reader, node.entries[0].mark, node.entries[0].key);
    options = node.entries[0].value.get();
  } else {
    reader.error(
        node.mark,
        "`" + name + "` must be a layer's name, or a map of one name and its options, got " +
            (node.kind == YamlNode::Kind::map ? "a map of " + std::to_string(node.entries.size()) + " keys"
                                              : node.description()),
        "{pressure: {opacity: 0.6}}");
  }
  if (!entry) return;
  view.layerNames.emplace_back(entry->key);
  LayerSpec layer;
  if (options) readOptions(reader, *options, inside(name, entry->key), entry->options, layer);
  layer.kind = entry->kind;
  view.layers.push_back(layer);
}

void readCaptions(Reader& reader, const YamlNode& node, ViewSpec& view) {
  if (!reader.isList(node, "view.captions")) return;
  for (std::size_t k = 0; k < node.items.size(); ++k) {
    const std::string name = "view.captions." + std::to_string(k);
    MapReader map(reader, *node.items[k], name);
    CaptionSpec caption;
    if (map.required("text")) map.text("text", caption.text);
    map.number("from", caption.from, kNotNegative);
    if (map.number("until", caption.until, kNotNegative) && caption.until <= caption.from)
      reader.error(map.find("until")->mark, "`" + name + "` ends before it starts");
    map.finish();
    view.captions.push_back(std::move(caption));
  }
}

void readCamera(Reader& reader, const YamlNode& node, const SceneSpec& spec, CameraSpec& camera) {
  MapReader map(reader, node, "view.camera");
  Vec2 center;
  double height = 0;
  if (map.vector("center", center)) camera.center = center;
  if (map.number("height", height, kPositive)) camera.height = height;
  if (map.text("follow", camera.follow)) checkFollowed(reader, *map.find("follow"), spec, camera.follow);
  map.finish();
}

}  // namespace

const char* layerName(LayerKind kind) {
  for (const LayerEntry& entry : kLayers)
    if (entry.kind == kind) return entry.key;
  checkInvariant(false, "every kind of layer has a name");
  return "";
}

bool isLayerName(const std::string& name) {
  return std::any_of(std::begin(kLayers), std::end(kLayers),
                     [&](const LayerEntry& entry) { return name == entry.key; });
}

void readView(MapReader& scene, SceneSpec& spec) {
  Reader& reader = scene.reader();
  ViewSpec& view = spec.view;
  auto takeDefaults = [&] {
    for (const char* name : defaultLayers(scene.node())) {
      LayerSpec layer;
      layer.kind = layerNamed(reader, scene.mark(), name)->kind;
      view.layers.push_back(layer);
      view.layerNames.emplace_back(name);
    }
  };
  const YamlNode* node = scene.find("view");
  if (!node) return takeDefaults();
  MapReader map(reader, *node, "view");
  if (const YamlNode* layers = map.find("layers")) {
    if (reader.isList(*layers, "view.layers"))
      for (std::size_t k = 0; k < layers->items.size(); ++k)
        readLayer(reader, *layers->items[k], "view.layers." + std::to_string(k), view);
  } else {
    takeDefaults();
  }
  if (const YamlNode* captions = map.find("captions")) readCaptions(reader, *captions, view);
  const YamlNode* background = map.find("background");
  if (background && background->kind == YamlNode::Kind::scalar && background->text == "dark") {
    view.background = ViewSpec().background;
  } else if (background && background->kind == YamlNode::Kind::scalar && background->text == "light") {
    view.background = {0.965f, 0.965f, 0.953f};
  } else {
    map.color("background", view.background);
  }
  if (const YamlNode* camera = map.find("camera")) readCamera(reader, *camera, spec, view.camera);
  map.finish();
}

}  // namespace smokebox
