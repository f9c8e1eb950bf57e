#include "scene/read_rigid_events.h"

#include <algorithm>
#include <cmath>

#include "scene/names.h"
#include "scene/nearest.h"
#include "scene/places.h"
#include "scene/read_bodies.h"

namespace smokebox {
namespace {

Movables readMovables(EventReader& event, const YamlNode& node, const std::string& key) {
  Movables all;
  readNames(event, node, key, [&](const YamlNode& item, const std::string& name) {
    const Movables found = findMovables(event.reader(), item, event.spec, name);
    all.bodies.insert(all.bodies.end(), found.bodies.begin(), found.bodies.end());
    all.cloths.insert(all.cloths.end(), found.cloths.begin(), found.cloths.end());
    all.nodes.insert(all.nodes.end(), found.nodes.begin(), found.nodes.end());
  });
  return all;
}

/// How often an event happens within the scene.
long timesOf(const YamlNode& event, const SceneSpec& spec) {
  std::vector<Problem> elsewhere;  // reported where the times are read for good
  Reader reader(elsewhere);
  MapReader map(reader, event, "");
  double every = 0, from = 0, until = spec.time.duration;
  if (!map.number("every", every, kPositive)) return 1;
  map.number("from", from, kNotNegative);
  map.number("until", until, kNotNegative);
  const double times = std::floor((std::min(until, spec.time.duration) - from) / every + 1e-6) + 1;
  return static_cast<long>(std::clamp(times, 1.0, 1e6));
}

}  // namespace

void readImpulse(EventReader& event, const YamlNode& node) {
  MapReader map(event.reader(), node, event.name("impulse"));
  ImpulseAction impulse;
  Vec2 at;
  std::string body;
  if (map.required("body") && map.text("body", body))
    impulse.on = findMovables(event.reader(), *map.find("body"), event.spec, body);
  if (map.required("value", "[x, y], N s")) map.vector("value", impulse.value);
  if (map.vector("at", at)) impulse.at = at;
  map.finish();
  event.add(std::move(impulse));
}

void readPull(EventReader& event, const YamlNode& node) {
  Reader& reader = event.reader();
  MapReader map(reader, node, event.name("pull"));
  PullAction pull;
  Vec2 at;
  std::string body;
  if (map.required("body") && map.text("body", body)) {
    const YamlNode& where = *map.find("body");
    if (const auto found = findHold(reader, where, event.spec, body, true)) {
      if (!canMove(*found)) reader.error(where.mark, "`" + body + "` does not move by itself");
      pull.from = *found;
    }
  }
  if (map.vector("at", at)) pull.from.at = at;
  if (const YamlNode* to = map.required("to", "[x, y], numbers or expressions in t"))
    if (const auto place = reader.expressions(*to, inside(map.name(), "to"), "t")) pull.to = *place;
  if (map.required("stiffness", "N/m")) map.number("stiffness", pull.stiffness, kNotNegative);
  map.number("damping", pull.damping, kNotNegative);
  map.number("length", pull.length, kNotNegative);
  map.number("for", pull.duration, kPositive);
  map.finish();
  event.add(std::move(pull));
}

void readHold(EventReader& event, const YamlNode& node) {
  event.add(HoldAction{readMovables(event, node, "hold"), true});
}
void readRelease(EventReader& event, const YamlNode& node) {
  event.add(HoldAction{readMovables(event, node, "release"), false});
}
void readRemove(EventReader& event, const YamlNode& node) {
  event.add(RemoveAction{readMovables(event, node, "remove")});
}

void readCut(EventReader& event, const YamlNode& node) {
  CutAction cut;
  const SceneSpec& spec = event.spec;
  readNames(event, node, "cut", [&](const YamlNode& item, const std::string& name) {
    std::vector<std::string> known;
    std::size_t found = 0;
    for (std::size_t k = 0; k < spec.springs.size(); ++k) {
      if (!spec.springs[k].name.empty()) known.push_back(spec.springs[k].name);
      if (spec.springs[k].name != name) continue;
      cut.springs.push_back(static_cast<int>(k));
      ++found;
    }
    for (std::size_t k = 0; k < spec.joints.size(); ++k) {
      if (!spec.joints[k].name.empty()) known.push_back(spec.joints[k].name);
      if (spec.joints[k].name != name) continue;
      cut.joints.push_back(static_cast<int>(k));
      ++found;
    }
    if (found == 0 || name.empty())
      event.reader().error(item.mark, "no spring and no joint is named `" + name + "`",
                           known.empty() ? "springs: [{name: s, ...}]" : suggestion(name, known));
  });
  event.add(std::move(cut));
}

void readAdd(EventReader& event, const YamlNode& node) {
  // What it adds has been read and checked before the first event was.
  MapReader map(event.reader(), node, event.name("add"));
  if (!map.isWrong() && (map.find("body") != nullptr) == (map.find("particle") != nullptr))
    event.reader().error(map.mark(), "`" + map.name() + "` must have either `body` or `particle`");
  map.find("body");
  map.find("particle");
  map.finish();
  const auto& bodies = event.spec.bodies;
  const auto is = [&](const BodySpec& body) { return body.later && body.item == event.item; };
  const auto first = std::find_if(bodies.begin(), bodies.end(), is);
  const auto all = std::count_if(first, bodies.end(), is);
  const long times = timesOf(*event.node, event.spec);
  if (all > 0) event.add(AddAction{static_cast<int>(first - bodies.begin()), static_cast<int>(all / times)});
}

void readAddedBodies(Reader& reader, const YamlNode& event, int item, SceneSpec& spec) {
  const YamlEntry* add = event.entry("add");
  if (!add) return;
  for (const bool particle : {false, true}) {
    const char* key = particle ? "particle" : "body";
    const YamlEntry* body = add->value->entry(key);
    if (!body) continue;
    readBody(reader, *body->value, "events." + std::to_string(item) + ".add." + key,
             {particle, item, true, timesOf(event, spec)}, spec);
    return;
  }
}

}  // namespace smokebox
