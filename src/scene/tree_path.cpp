#include "scene/tree_path.h"

#include <algorithm>
#include <charconv>
#include <iterator>

#include "scene/nearest.h"

namespace smokebox {

std::vector<std::string> pathSteps(const std::string& path) {
  std::vector<std::string> steps;
  std::size_t begin = 0;
  for (;;) {
    const std::size_t dot = path.find('.', begin);
    steps.push_back(path.substr(begin, dot == std::string::npos ? dot : dot - begin));
    if (dot == std::string::npos) return steps;
    begin = dot + 1;
  }
}

std::vector<const char*> defaultLayers(const YamlNode& root) {
  std::vector<const char*> layers{"smoke", "solids"};
  bool added = false;  // by an event
  if (const YamlEntry* events = root.entry("events"))
    for (const YamlPtr& event : events->value->items) added |= event->entry("add") != nullptr;
  for (const char* name : {"cloth", "bodies", "particles", "springs", "joints"})
    if (root.entry(name) || (added && (name == std::string("bodies") || name == std::string("particles"))))
      layers.push_back(name);
  layers.push_back("caption");
  return layers;
}

namespace {

/// Sections of a scene that are lists of things.
constexpr const char* kLists[] = {"solids", "probes", "bodies", "particles", "springs", "joints", "cloth"};

std::string itemName(const YamlNode& item) {
  const YamlEntry* name = item.entry("name");
  return name ? name->value->text : std::string();
}

/// Of an entry of `view.layers`; empty if it is none.
std::string layerName(const YamlNode& item) {
  if (item.kind == YamlNode::Kind::scalar) return item.text;
  return item.kind == YamlNode::Kind::map && item.entries.size() == 1 ? item.entries[0].key : std::string();
}

struct Walk {
  const YamlPtr& root;
  const std::vector<std::string>& steps;
  const std::string& path;
  const YamlPtr& value;
  const SourcePlace& place;
  YamlMark mark;  // of what is made on the way

  [[noreturn]] void fail(const std::string& message, const std::string& hint) const {
    throw SceneError({Problem{place, message, hint, false}});
  }

  std::string before(std::size_t depth) const {
    std::string text;
    for (std::size_t k = 0; k < depth; ++k) text += (k ? "." : "") + steps[k];
    return text;
  }

  /// Is the list that is reached after so many steps the one of layers?
  bool isLayers(std::size_t depth) const { return depth == 2 && steps[0] == "view" && steps[1] == "layers"; }

  std::size_t itemIndex(const YamlNode& list, std::size_t depth) const {
    const std::string& step = steps[depth];
    std::vector<std::string> names;
    for (std::size_t k = 0; k < list.items.size(); ++k) {
      const std::string name = isLayers(depth) ? layerName(*list.items[k]) : itemName(*list.items[k]);
      if (name.empty()) continue;
      if (name == step) return k;
      names.push_back(name);
    }
    std::size_t index = 0;
    const auto [end, fault] = std::from_chars(step.data(), step.data() + step.size(), index);
    if (fault == std::errc() && end == step.data() + step.size()) {
      if (index < list.items.size()) return index;
      fail("`" + path + "`: `" + before(depth) + "` has " + std::to_string(list.items.size()) + " items",
           "counted from 0");
    }
    fail("`" + path + "`: nothing in `" + before(depth) + "` is named `" + step + "`",
         names.empty() ? "a position counted from 0" : suggestion(step, names));
  }

  YamlNode newMap() const {
    YamlNode map;
    map.kind = YamlNode::Kind::map;
    map.mark = mark;
    return map;
  }

  YamlNode layersByDefault() const {
    YamlNode list;
    list.kind = YamlNode::Kind::list;
    list.mark = mark;
    for (const char* name : defaultLayers(*root)) {
      YamlNode item;
      item.kind = YamlNode::Kind::scalar;
      item.mark = mark;
      item.text = name;
      list.items.push_back(std::make_shared<const YamlNode>(std::move(item)));
    }
    recount(list);
    return list;
  }

  /// A layer, as a map of its name and its options, with the value put into the options.
  YamlPtr replacedLayer(const YamlPtr& layer, std::size_t depth) const {
    YamlNode copy = *layer;
    if (copy.kind == YamlNode::Kind::scalar) {
      copy = newMap();
      copy.mark = layer->mark;
      copy.entries.push_back({layer->text, layer->mark, nullptr});
    }
    copy.entries[0].value = replaced(copy.entries[0].value, depth);
    recount(copy);
    return std::make_shared<const YamlNode>(std::move(copy));
  }

  YamlPtr replaced(const YamlPtr& old, std::size_t depth) const {
    if (depth == steps.size()) return value;
    const std::string& step = steps[depth];
    YamlNode copy;
    if (isLayers(depth) && (!old || old->kind == YamlNode::Kind::null)) {
      copy = layersByDefault();
    } else if (!old || old->kind == YamlNode::Kind::null) {
      if ((depth == 1 && std::find(std::begin(kLists), std::end(kLists), steps[0]) != std::end(kLists)) ||
          std::all_of(step.begin(), step.end(), [](char c) { return c >= '0' && c <= '9'; }))
        fail("`" + path + "`: the scene has no list `" + before(depth) + "`", "give the whole list");
      copy = newMap();
    } else {
      copy = *old;
    }
    if (copy.kind == YamlNode::Kind::scalar)
      fail("`" + path + "`: `" + before(depth) + "` is a single value and has no `" + step + "`", "");
    if (copy.kind == YamlNode::Kind::list) {
      YamlPtr& first = copy.items[itemIndex(copy, depth)];
      if (isLayers(depth) && layerName(*first) == step) {
        for (YamlPtr& item : copy.items)
          if (layerName(*item) == step) item = replacedLayer(item, depth + 1);
      } else if (isLayers(depth) && depth + 1 < steps.size() && layerName(*first) == steps[depth + 1]) {
        first = replacedLayer(first, depth + 2);
      } else if (isLayers(depth) && depth + 1 < steps.size() && !layerName(*first).empty()) {
        fail("`" + path + "`: `" + before(depth + 1) + "` is `" + layerName(*first) + "`, not `" +
                 steps[depth + 1] + "`",
             "view.layers." + layerName(*first) + "." + steps.back());
      } else {
        first = replaced(first, depth + 1);
      }
    } else {
      const auto found = std::find_if(copy.entries.begin(), copy.entries.end(),
                                      [&](const YamlEntry& entry) { return entry.key == step; });
      if (found != copy.entries.end()) {
        found->value = replaced(found->value, depth + 1);
        found->mark = depth + 1 == steps.size() ? mark : found->mark;
      } else {
        copy.entries.push_back({step, mark, replaced(nullptr, depth + 1)});
      }
    }
    recount(copy);
    return std::make_shared<const YamlNode>(std::move(copy));
  }
};

}  // namespace

YamlPtr withValue(const YamlPtr& root, const std::string& path, const YamlPtr& value,
                  const SourcePlace& place) {
  const std::vector<std::string> steps = pathSteps(path);
  const YamlMark mark{std::make_shared<const std::string>(place.file), place.line, place.column};
  const Walk walk{root, steps, path, value, place, mark};
  constexpr std::size_t kMostSteps = 32;
  if (steps.size() > kMostSteps || std::find(steps.begin(), steps.end(), "") != steps.end())
    walk.fail("`" + path + "` is no path", "steps parted by single dots, such as fluid.vorticity");
  return walk.replaced(root, 0);
}

namespace {

/// Keys of what stands in a list that no event can set.
const std::vector<std::string>& fixedKeys(const std::string& list) {
  static const std::vector<std::string> kPlaced{"name",   "shape", "position", "angle",
                                                "report", "at",    "region",   "follow"};
  static const std::vector<std::string> kBodies{"name",   "shape", "position",   "angle", "radius",
                                                "ignore", "held",  "held_until", "repeat"};
  static const std::vector<std::string> kSprings{"name", "from", "to"};
  static const std::vector<std::string> kJoints{"name", "pin",  "weld",   "slide", "rope",  "at",
                                                "axis", "from", "limits", "to",    "length"};
  static const std::vector<std::string> kCloth{
      "name",           "corner",        "size",    "cells",  "mass",   "stiffness",
      "shear",          "bend",          "damping", "radius", "bounce", "friction",
      "linear_damping", "gravity_scale", "pinned",  "tear",   "ignore"};
  return list == "bodies" || list == "particles" ? kBodies
         : list == "springs"                     ? kSprings
         : list == "joints"                      ? kJoints
         : list == "cloth"                       ? kCloth
                                                 : kPlaced;
}

}  // namespace

std::string whyFixed(const std::string& path) {
  const std::vector<std::string> steps = pathSteps(path);
  const std::string& first = steps[0];
  for (const char* fixed : {"title", "domain", "time", "output", "method", "events"})
    if (first == fixed) return "`" + first + "` cannot change during a run";
  if (first == "temperature" && (steps.size() < 2 || steps[1] == "start"))
    return "`" + path + "` cannot change during a run";
  for (const char* list : kLists) {
    if (first != list) continue;
    if (steps.size() < 3) return "the list of `" + first + "` cannot change during a run";
    const auto& fixed = fixedKeys(first);
    if (std::find(fixed.begin(), fixed.end(), steps[2]) != fixed.end())
      return "`" + steps[2] + "` of " + first + " cannot change during a run";
  }
  return {};
}

}  // namespace smokebox
