#include "world/needs.h"

#include <algorithm>
#include <cctype>

#include "scene/tree_path.h"

namespace smokebox {

namespace {

bool isPrefix(const std::string& prefix, const std::string& path) {
  return path == prefix || (path.size() > prefix.size() && path.compare(0, prefix.size(), prefix) == 0 &&
                            path[prefix.size()] == '.');
}

template <class Action>
bool anyEvent(const SceneSpec& spec) {
  return std::any_of(spec.events.begin(), spec.events.end(),
                     [](const EventSpec& event) { return std::holds_alternative<Action>(event.action); });
}

/// Does a setting at `path` change `option` of the layers that are named so? Paths lead there by the name or
/// by a position in the list.
bool reachesLayer(const std::string& path, const std::string& name, const std::string& option) {
  const std::vector<std::string> steps = pathSteps(path);
  if (steps[0] != "view") return false;
  if (steps.size() > 1 && steps[1] != "layers") return false;
  if (steps.size() < 3) return true;
  std::size_t next = 3;
  if (steps[2] != name) {  // is it a position?
    if (steps.size() == 3) return std::isdigit(static_cast<unsigned char>(steps[2][0]));
    if (steps[3] != name) return false;
    next = 4;
  }
  return next >= steps.size() || steps[next] == option;
}

bool eventSetsDragOfBodies(const SceneSpec& spec) {
  return std::any_of(spec.events.begin(), spec.events.end(), [](const EventSpec& event) {
    const auto* set = std::get_if<SetAction>(&event.action);
    return set && set->path.starts_with("bodies.") && set->path.ends_with(".drag");
  });
}

bool isOff(const std::string& value) { return value == "false" || value == "no" || value == "off"; }

}  // namespace

bool concerns(const std::string& path, const std::string& key) {
  return isPrefix(path, key) || isPrefix(key, path);
}

bool eventSets(const SceneSpec& spec, const std::string& path) {
  return std::any_of(spec.events.begin(), spec.events.end(), [&](const EventSpec& event) {
    const auto* set = std::get_if<SetAction>(&event.action);
    return set && concerns(set->path, path);
  });
}

bool eventSetsLayer(const SceneSpec& spec, LayerKind kind, const std::string& option) {
  return std::any_of(spec.events.begin(), spec.events.end(), [&](const EventSpec& event) {
    const auto* set = std::get_if<SetAction>(&event.action);
    return set && reachesLayer(set->path, layerName(kind), option) && !isOff(set->value);
  });
}

bool canShow(const SceneSpec& spec, LayerKind kind) {
  return eventSetsLayer(spec, kind, "shown") ||
         std::any_of(spec.view.layers.begin(), spec.view.layers.end(),
                     [&](const LayerSpec& layer) { return layer.kind == kind && layer.shown; });
}

Needs needsOf(const SceneSpec& spec) {
  Needs needs;
  needs.movingSolids = std::any_of(spec.solids.begin(), spec.solids.end(),
                                   [](const SolidSpec& solid) { return !solid.motion.isStill(); });
  needs.reports = std::any_of(spec.solids.begin(), spec.solids.end(),
                              [](const SolidSpec& solid) { return solid.report; });
  needs.rigid = !spec.bodies.empty() || !spec.cloths.empty();
  needs.fluid = spec.hasFluid;
  if (!needs.fluid) return needs;

  needs.smoke = !spec.smokeColors().empty();
  needs.buoyancy = needs.smoke && (spec.smoke.buoyancy != 0 || eventSets(spec, "smoke.buoyancy"));
  needs.heat = spec.temperature.named;
  needs.heatDiffuses =
      needs.heat && (spec.temperature.diffusivity > 0 || eventSets(spec, "temperature.diffusivity"));
  needs.heatRises = needs.heat &&
                    (spec.temperature.expansion != 0 || eventSets(spec, "temperature.expansion")) &&
                    (length(spec.gravity) > 0 || eventSets(spec, "gravity"));
  needs.sourcesDrive =
      needs.smoke && (eventSets(spec, "smoke.sources") ||
                      std::any_of(spec.smoke.sources.begin(), spec.smoke.sources.end(),
                                  [](const SourceSpec& source) { return source.velocity.has_value(); }));
  needs.parts.viscous = spec.fluid.viscosity > 0 || eventSets(spec, "fluid.viscosity");
  needs.parts.confined = spec.fluid.vorticity != 0 || eventSets(spec, "fluid.vorticity");
  needs.parts.forced = needs.parts.viscous || needs.parts.confined || needs.buoyancy || needs.heatRises ||
                       anyEvent<ForceAction>(spec);
  needs.parts.inviscidDrag = (spec.fluid.viscosity == 0 || eventSets(spec, "fluid.viscosity")) &&
                             (eventSets(spec, "solids") || eventSetsDragOfBodies(spec) ||
                              std::any_of(spec.solids.begin(), spec.solids.end(),
                                          [](const SolidSpec& solid) { return solid.drag > 0; }) ||
                              std::any_of(spec.bodies.begin(), spec.bodies.end(), [](const BodySpec& body) {
                                return !body.particle && body.drag > 0;
                              }));
  return needs;
}

}  // namespace smokebox
