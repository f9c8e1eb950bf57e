#include "app/variants.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "base/errors.h"

namespace smokebox {

namespace {

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(' ') - first + 1));
}

std::vector<std::string> splitValues(std::string_view text) {
  std::vector<std::string> values;
  int depth = 0;
  char quote = 0;
  std::size_t begin = 0;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (quote) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{' || c == '(') {
      ++depth;
    } else if (c == ']' || c == '}' || c == ')') {
      --depth;
    } else if (c == ',' && depth <= 0) {
      values.push_back(trimmed(text.substr(begin, k - begin)));
      begin = k + 1;
    }
  }
  values.push_back(trimmed(text.substr(begin)));
  return values;
}

struct Axis {
  std::string key;
  std::vector<std::string> values;
};

Axis axisOf(const std::string& varied) {
  const std::size_t equals = varied.find('=');
  if (equals == std::string::npos || equals == 0)
    throw UsageError("--vary: must be KEY=VALUE,VALUE, not '" + varied + "'");
  Axis axis{trimmed(varied.substr(0, equals)), splitValues(std::string_view(varied).substr(equals + 1))};
  for (auto value = axis.values.begin(); value != axis.values.end(); ++value) {
    if (value->empty()) throw UsageError("--vary " + varied + ": a value is empty");
    if (std::find(axis.values.begin(), value, *value) != value)
      throw UsageError("--vary " + varied + ": the value " + *value + " is given twice");
  }
  return axis;
}

void refuseOutOfStep(const SceneSpec& first, const SceneSpec& other, const std::string& label) {
  const auto frames = [](const SceneSpec& spec) { return spec.time.steps / spec.time.stepsPerFrame; };
  if (first.output.width != other.output.width || first.output.height != other.output.height)
    throw UsageError("--vary: " + label + ": the panels of one film have one size; --size is the film's");
  if (first.output.fps != other.output.fps || frames(first) != frames(other))
    throw UsageError("--vary: " + label +
                     ": the runs go in step: output.fps and time.duration must be equal");
}

}  // namespace

std::vector<Variant> variantsOf(const std::vector<std::string>& varied) {
  std::vector<Variant> variants(1);
  std::vector<std::string> keys;
  for (const std::string& text : varied) {
    const Axis axis = axisOf(text);
    if (std::find(keys.begin(), keys.end(), axis.key) != keys.end())
      throw UsageError("--vary: " + axis.key + " is given twice; put all values into one");
    keys.push_back(axis.key);
    std::vector<Variant> next;
    for (const Variant& variant : variants)
      for (const std::string& value : axis.values) {
        Variant longer = variant;
        longer.settings.emplace_back(axis.key, value);
        longer.label += (longer.label.empty() ? "" : ", ") + axis.key + " = " + value;
        next.push_back(std::move(longer));
        if (next.size() > kMostVariants)
          throw UsageError("--vary: these are more than " + std::to_string(kMostVariants) +
                           " runs, the most that one picture has room for");
      }
    variants = std::move(next);
  }
  if (variants.size() < kFewestVariants)
    throw UsageError(
        "--vary: there is nothing to compare with; give two values or more: --vary "
        "fluid.vorticity=0.3,0");
  return variants;
}

std::vector<std::string> panelLabels(const std::vector<Variant>& variants,
                                     const std::function<bool(const std::vector<std::string>&)>& fit) {
  std::vector<std::string> whole, lastSteps, values;
  bool alike = false;
  for (const Variant& variant : variants) {
    std::string byLastStep, byValue;
    std::set<std::string> ends;
    for (const auto& [key, value] : variant.settings) {
      const std::string end = key.substr(key.rfind('.') + 1), comma = byValue.empty() ? "" : ", ";
      alike |= !ends.insert(end).second;
      byLastStep += comma + end + " = " + value;
      byValue += comma + value;
    }
    whole.push_back(variant.label);
    lastSteps.push_back(std::move(byLastStep));
    values.push_back(std::move(byValue));
  }
  if (fit(whole)) return whole;
  return !alike && fit(lastSteps) ? lastSteps : values;
}

std::vector<SceneDocument> variantScenes(const SceneDocument& scene, const std::vector<Variant>& variants) {
  std::vector<SceneDocument> scenes;
  SceneSpec first;
  for (const Variant& variant : variants) {
    SceneDocument varied = scene;
    for (const auto& [key, value] : variant.settings)
      varied.set(key, value, SourcePlace{"--vary " + key + "=" + value, 0, 0});
    const SceneSpec spec = varied.spec();
    if (scenes.empty()) first = spec;
    refuseOutOfStep(first, spec, variant.label);
    scenes.push_back(std::move(varied));
  }
  return scenes;
}

}  // namespace smokebox
