// events
#include <algorithm>

#include "scene/names.h"
#include "scene/nearest.h"
#include "scene/read_rigid_events.h"
#include "scene/read_shape.h"
#include "scene/sections.h"

namespace smokebox {
namespace {

void readTimes(EventReader& event) {
  MapReader& map = event.map;
  EventSpec& when = event.when;
  const bool once = map.has("at"), repeated = map.has("every");
  if (once && repeated)
    event.reader().error(map.keyMark("every"), "`at` and `every` at once",
                         "at: once; every, from, until: again and again");
  if (!once && !repeated && !map.isWrong())
    event.reader().error(map.mark(), "`" + map.name() + "` has no time", "at: 2, or every: 1");
  map.number("at", when.first, kNotNegative);
  if (repeated || !once) {
    const double least = 1e-3 / event.spec.output.fps;  // a bound on what one step can have to do
    if (map.number("every", when.every, kPositive) && when.every < least)
      event.reader().error(map.find("every")->mark,
                           "`" + event.name("every") + "` is shorter than a thousandth of a frame");
    map.number("from", when.first, kNotNegative);
    if (map.number("until", when.until, kNotNegative) && when.until < when.first)
      event.reader().error(map.find("until")->mark, "`" + map.name() + "` ends before it starts");
  } else {
    map.find("every");
    for (const char* key : {"from", "until"}) {
      map.find(key);
      if (map.has(key))
        event.reader().error(map.keyMark(key), "`" + std::string(key) + "` goes with `every`");
    }
  }
  if (when.first > event.spec.time.duration)
    event.reader().warning(map.keyMark(once ? "at" : "from"), "this event lies after the end of the scene");
}

void readSet(EventReader& event, const YamlNode& node) {
  if (node.kind != YamlNode::Kind::map || node.entries.empty()) {
    event.reader().error(
        node.mark, "`" + event.name("set") + "` must be a map of paths and values, got " + node.description(),
        "set: {fluid.vorticity: 0}");
    return;
  }
  for (const YamlEntry& entry : node.entries)
    event.add(SetAction{entry.key, yamlText(*entry.value), entry.mark.place()});
}

void needFluid(EventReader& event, const YamlNode& node, const char* what) {
  if (!event.spec.hasFluid)
    event.reader().error(node.mark, "a " + std::string(what) + " needs a fluid, and this scene has none",
                         "add `fluid: {}` or `smoke: {}`");
}

void readBurst(EventReader& event, const YamlNode& node) {
  MapReader map(event.reader(), node, event.name("burst"));
  BurstAction burst;
  map.number("smoke", burst.smoke, kNotNegative);
  map.color("color", burst.color);
  const auto shape = readPlacedShape(map);
  map.finish();
  needFluid(event, node, "burst");
  if (!shape) return;
  burst.shape = *shape;
  event.add(std::move(burst));
}

void readForce(EventReader& event, const YamlNode& node) {
  MapReader map(event.reader(), node, event.name("force"));
  ForceAction force;
  if (map.required("acceleration", "[x, y], m/s^2")) map.vector("acceleration", force.acceleration);
  map.number("for", force.duration, kNotNegative);
  const auto shape = readPlacedShape(map);
  map.finish();
  needFluid(event, node, "force");
  if (!shape) return;
  force.shape = *shape;
  event.add(std::move(force));
}

/// A solid, a body, a particle, a cloth or a layer of the view. Showing a layer is setting its `shown`, so
/// that the later event of any kind wins.
void readVisibility(EventReader& event, const YamlNode& node, const std::string& key, bool visible) {
  Reader& reader = event.reader();
  const std::vector<std::string>& layers = event.spec.view.layerNames;
  readNames(event, node, key, [&](const YamlNode& item, const std::string& name) {
    std::vector<std::string> known = namesOfThings(event.spec, true);
    const auto& solids = event.spec.solids;
    const bool isSolid =
        std::any_of(solids.begin(), solids.end(), [&](const SolidSpec& solid) { return solid.name == name; });
    const bool isThing = isSolid || isMovable(event.spec, name);
    const bool isLayer = std::find(layers.begin(), layers.end(), name) != layers.end();
    const std::string kind = isSolid ? "solid" : "body";
    if (isThing && isLayer)
      reader.warning(item.mark, "`" + name + "` is a " + kind + " and a layer: the " + kind + " is meant",
                     "rename the " + kind + ", or set: {view.layers." + name + ".shown: ...}");
    if (isThing) {
      event.add(VisibilityAction{name, visible});
    } else if (isLayer) {
      event.add(SetAction{"view.layers." + name + ".shown", visible ? "true" : "false", item.mark.place()});
    } else if (isLayerName(name)) {
      reader.error(item.mark, "the view has no layer `" + name + "`",
                   "list it in view.layers: {" + name + ": {shown: false}}");
    } else if (!event.spec.names.isPartOfWrong(name)) {
      for (const std::string& layer : layers)
        if (std::find(known.begin(), known.end(), layer) == known.end()) known.push_back(layer);
      reader.error(item.mark, "no solid, body or layer is named `" + name + "`", suggestion(name, known));
    }
  });
}

void readShow(EventReader& event, const YamlNode& node) { readVisibility(event, node, "show", true); }
void readHide(EventReader& event, const YamlNode& node) { readVisibility(event, node, "hide", false); }
void readStop(EventReader& event, const YamlNode& node) {
  readNames(event, node, "stop", [&](const YamlNode& item, const std::string& solid) {
    if (checkSolidName(event.reader(), item, event.spec, solid)) event.add(StopAction{solid});
  });
}

void readCaption(EventReader& event, const YamlNode& node) {
  CaptionAction caption;
  if (node.kind == YamlNode::Kind::map) {
    MapReader map(event.reader(), node, event.name("caption"));
    if (map.required("text")) map.text("text", caption.text);
    map.number("for", caption.duration, kPositive);
    map.finish();
  } else if (const auto text = event.reader().text(node, event.name("caption"))) {
    caption.text = *text;
  }
  event.add(std::move(caption));
}

struct ActionKind {
  const char* key;
  void (*read)(EventReader& event, const YamlNode& node);
};
constexpr ActionKind kActions[] = {{"set", readSet},         {"burst", readBurst},     {"force", readForce},
                                   {"show", readShow},       {"hide", readHide},       {"stop", readStop},
                                   {"caption", readCaption}, {"impulse", readImpulse}, {"pull", readPull},
                                   {"hold", readHold},       {"release", readRelease}, {"add", readAdd},
                                   {"remove", readRemove},   {"cut", readCut}};

void readEvent(Reader& reader, const YamlNode& node, int item, SceneSpec& spec) {
  const std::string name = "events." + std::to_string(item);
  MapReader map(reader, node, name);
  EventReader event{map, spec, &node, item, {}};
  readTimes(event);
  int actions = 0;
  std::string all;
  for (const ActionKind& kind : kActions) {
    all += (all.empty() ? "" : ", ") + std::string(kind.key);
    const YamlNode* found = map.find(kind.key);
    if (!map.has(kind.key)) continue;
    if (++actions > 1)
      reader.error(map.keyMark(kind.key), "a second action in one event", "make it an event of its own");
    if (found)
      kind.read(event, *found);
    else
      reader.error(map.keyMark(kind.key), "`" + inside(name, kind.key) + "` has no value");
  }
  const std::size_t before = reader.errors();
  map.finish();
  if (actions == 0 && !map.isWrong() && reader.errors() == before)
    reader.error(map.mark(), "`" + name + "` does nothing", "one of " + all);
}

}  // namespace

void readEvents(MapReader& scene, SceneSpec& spec) {
  const YamlNode* node = scene.find("events");
  if (!node || !scene.reader().isList(*node, "events")) return;
  const int count = static_cast<int>(node->items.size());
  for (int k = 0; k < count; ++k) readAddedBodies(scene.reader(), *node->items[k], k, spec);
  for (int k = 0; k < count; ++k) readEvent(scene.reader(), *node->items[k], k, spec);
}

}  // namespace smokebox
