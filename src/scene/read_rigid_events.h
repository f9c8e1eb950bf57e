// Events that act on bodies, particles, springs and joints.
#pragma once
#include "scene/reader.h"
#include "scene/spec.h"

namespace smokebox {

/// When an event happens, and where its actions go: one action each.
struct EventReader {
  MapReader& map;
  SceneSpec& spec;
  const YamlNode* node = nullptr;
  int item = 0;  // position in `events`
  EventSpec when;

  Reader& reader() { return map.reader(); }
  std::string name(const std::string& key) const { return inside(map.name(), key); }
  template <class Action>
  void add(Action action) {
    EventSpec event = when;
    event.action = std::move(action);
    spec.events.push_back(std::move(event));
  }
};

/// One name or a list of them; each goes to `take`.
template <class Take>
void readNames(EventReader& event, const YamlNode& node, const std::string& key, Take take) {
  auto one = [&](const YamlNode& item, const std::string& called) {
    if (const auto name = event.reader().text(item, called)) take(item, *name);
  };
  if (node.kind != YamlNode::Kind::list) return one(node, event.name(key));
  for (std::size_t k = 0; k < node.items.size(); ++k)
    one(*node.items[k], inside(event.name(key), std::to_string(k)));
}

void readImpulse(EventReader& event, const YamlNode& node);
void readPull(EventReader& event, const YamlNode& node);
void readHold(EventReader& event, const YamlNode& node);
void readRelease(EventReader& event, const YamlNode& node);
void readRemove(EventReader& event, const YamlNode& node);
void readAdd(EventReader& event, const YamlNode& node);
void readCut(EventReader& event, const YamlNode& node);

/// The bodies that this event adds, appended to spec.bodies: before any event is read, for others may speak
/// of them.
void readAddedBodies(Reader& reader, const YamlNode& event, int item, SceneSpec& spec);

}  // namespace smokebox
