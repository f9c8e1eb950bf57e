#include "scene/tree_path.h"

#include <algorithm>
#include <charconv>

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

namespace {

struct Walk {
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

  std::size_t itemIndex(const YamlNode& list, std::size_t depth) const {
    const std::string& step = steps[depth];
    std::vector<std::string> names;
    for (std::size_t k = 0; k < list.items.size(); ++k) {
      const YamlEntry* name = list.items[k]->entry("name");
      if (!name) continue;
      if (name->value->text == step) return k;
      names.push_back(name->value->text);
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

  YamlPtr replaced(const YamlPtr& old, std::size_t depth) const {
    if (depth == steps.size()) return value;
    const std::string& step = steps[depth];
    YamlNode copy;
    if (!old || old->kind == YamlNode::Kind::null) {
      if (std::all_of(step.begin(), step.end(), [](char c) { return c >= '0' && c <= '9'; }))
        fail("`" + path + "`: the scene has no list `" + before(depth) + "`", "give the whole list");
      copy.kind = YamlNode::Kind::map;
      copy.mark = mark;
    } else {
      copy = *old;
    }
    if (copy.kind == YamlNode::Kind::scalar)
      fail("`" + path + "`: `" + before(depth) + "` is a single value and has no `" + step + "`", "");
    if (copy.kind == YamlNode::Kind::list) {
      YamlPtr& item = copy.items[itemIndex(copy, depth)];
      item = replaced(item, depth + 1);
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
  const Walk walk{steps, path, value, place, mark};
  constexpr std::size_t kMostSteps = 32;
  if (steps.size() > kMostSteps || std::find(steps.begin(), steps.end(), "") != steps.end())
    walk.fail("`" + path + "` is no path", "steps parted by single dots, such as fluid.vorticity");
  return walk.replaced(root, 0);
}

std::string whyFixed(const std::string& path) {
  const std::vector<std::string> steps = pathSteps(path);
  const std::string& first = steps[0];
  for (const char* fixed : {"title", "domain", "time", "output", "method", "events"})
    if (first == fixed) return "`" + first + "` cannot change during a run";
  if (first == "solids" || first == "probes") {
    if (steps.size() < 3) return "the list of `" + first + "` cannot change during a run";
    for (const char* fixed : {"name", "shape", "position", "angle", "report", "at", "region", "follow"})
      if (steps[2] == fixed) return "`" + steps[2] + "` of " + first + " cannot change during a run";
  }
  return {};
}

}  // namespace smokebox
