// The whole scene: the order of its sections, and the checks that concern several of them.
#include <algorithm>
#include <cmath>

#include "base/maths.h"
#include "scene/sections.h"
#include "scene/tree_path.h"

namespace smokebox {

SceneSpec readScene(const YamlPtr& root, const std::string& name, std::vector<Problem>& problems,
                    bool events) {
  Reader reader(problems);
  MapReader scene(reader, *root, "");
  SceneSpec spec;
  spec.name = name;
  scene.text("title", spec.title);
  readDomain(scene, spec);
  readWalls(scene, spec);
  readTimeAndOutput(scene, spec);
  readFluid(scene, spec);
  readSmoke(scene, spec);
  readTemperature(scene, spec);
  readSolids(scene, spec);
  readBodies(scene, spec);
  readCloths(scene, spec);
  readLinks(scene, spec);
  readProbes(scene, spec);
  readView(scene, spec);  // before the events, which show its layers
  if (events)
    readEvents(scene, spec);
  else
    scene.find("events");  // of a trial: they were read before, and nothing can set them
  readMethod(scene, spec);
  scene.finish();
  if (reader.errors() == 0) {
    checkInflow(scene, spec);
    checkFormulas(scene, spec);
    checkTemperature(scene, spec, events);
    if (events) checkPlacement(scene, spec);
    if (events) checkBodies(scene, spec);
  }
  if (events) checkSetActions(root, name, spec, reader);
  return spec;
}

void checkSetActions(const YamlPtr& root, const std::string& name, SceneSpec& spec, Reader& reader) {
  const bool any = std::any_of(spec.events.begin(), spec.events.end(), [](const EventSpec& event) {
    return std::holds_alternative<SetAction>(event.action);
  });
  if (!any) return;
  std::vector<Problem> without;
  const SceneSpec plain = readScene(root, name, without, false);
  for (const EventSpec& event : spec.events) {
    const auto* set = std::get_if<SetAction>(&event.action);
    if (!set) continue;
    const YamlMark mark{std::make_shared<const std::string>(set->place.file), set->place.line,
                        set->place.column};
    const std::string fixed = whyFixed(set->path);
    if (!fixed.empty()) {
      reader.error(mark, fixed);
      continue;
    }
    std::vector<Problem> with;
    SceneSpec changed;
    try {
      changed = readScene(withValue(root, set->path, parseYamlValue(set->value, set->place), set->place),
                          name, with, false);
    } catch (const SceneError& fault) {
      with.insert(with.end(), fault.problems().begin(), fault.problems().end());
    }
    bool fine = true;
    for (const Problem& problem : with) {
      const bool known = std::any_of(without.begin(), without.end(), [&](const Problem& old) {
        return old.message == problem.message && old.place.line == problem.place.line;
      });
      if (known || problem.warning) continue;
      reader.error(mark, "setting `" + set->path + "`: " + problem.message, problem.hint);
      fine = false;
    }
    if (!fine || std::any_of(without.begin(), without.end(), [](const Problem& p) { return !p.warning; }))
      continue;
    for (int side = 0; side < 4; ++side)
      if (changed.domain.walls[side].kind != plain.domain.walls[side].kind)
        reader.error(mark, "setting `" + set->path + "`: the kind of a wall cannot change during a run");
    if (changed.hasFluid != plain.hasFluid)
      reader.error(mark,
                   "setting `" + set->path + "`: the scene has no fluid, and none can be added during a run",
                   "add `fluid: {}`");
    if (changed.temperature.named != plain.temperature.named)
      reader.error(
          mark,
          "setting `" + set->path + "`: the scene has no temperature, and none can be added during a run",
          "add `temperature: {}`");
    for (const SourceSpec& source : changed.smoke.sources) spec.laterSmokeColors.push_back(source.color);
  }
}

void checkFormulas(MapReader& scene, const SceneSpec& spec) {
  constexpr int kSamples = 9;
  const Grid& grid = spec.domain.grid;
  const auto& velocity = spec.fluid.velocity;
  for (int k = 0; k < kSamples * kSamples && !(velocity[0].isConstant() && velocity[1].isConstant()); ++k) {
    const Vec2 at{(k % kSamples + 0.5) / kSamples * grid.width(),
                  (k / kSamples + 0.5) / kSamples * grid.height()};
    if (std::isfinite(velocity[0](at.x, at.y, 0)) && std::isfinite(velocity[1](at.x, at.y, 0))) continue;
    scene.reader().error(scene.find("fluid")->entry("velocity")->value->mark,
                         "`fluid.velocity` is not a finite number at x = " + std::to_string(at.x) +
                             ", y = " + std::to_string(at.y));
    break;
  }
  for (std::size_t k = 0; k < spec.solids.size(); ++k) {
    const SolidSpec& solid = spec.solids[k];
    for (int m = 0; m < kSamples && !solid.motion.isStill(); ++m) {
      const double t = m * spec.time.duration / (kSamples - 1);
      const Pose pose = solid.motion.poseAt(t, solid.shape.pose);
      if (std::isfinite(pose.position.x) && std::isfinite(pose.position.y) && std::isfinite(pose.angleRad))
        continue;
      scene.reader().error(
          scene.find("solids")->items[k]->entry("motion")->value->mark,
          "the motion of `" + solid.name + "` is not a finite number at t = " + std::to_string(t));
      break;
    }
  }
}

void checkPlacement(MapReader& scene, const SceneSpec& spec) {
  const double width = spec.domain.grid.width(), height = spec.domain.grid.height();
  auto boxOf = [](const std::vector<Outline>& outlines) {
    std::array<Vec2, 2> box{Vec2{INFINITY, INFINITY}, Vec2{-INFINITY, -INFINITY}};
    for (const Outline& outline : outlines)
      for (const Vec2 p : outline) {
        box[0] = {std::min(box[0].x, p.x), std::min(box[0].y, p.y)};
        box[1] = {std::max(box[1].x, p.x), std::max(box[1].y, p.y)};
      }
    return box;
  };
  auto meets = [&](const std::array<Vec2, 2>& box) {
    return box[1].x > 0 && box[1].y > 0 && box[0].x < width && box[0].y < height;
  };
  const double tolerance = std::max(width, height) / 200;  // a warning can be coarse
  auto itemMark = [&](const char* list, std::size_t index) -> const YamlMark& {
    return scene.find(list)->items[index]->mark;
  };

  for (std::size_t k = 0; k < spec.solids.size(); ++k) {
    const SolidSpec& solid = spec.solids[k];
    const std::vector<Outline> own = outlinesOf({solid.shape.shape, {}}, tolerance);
    const int moments = solid.motion.isStill() ? 1 : 65;
    bool seen = false;
    for (int m = 0; m < moments && !seen; ++m) {
      const Pose pose = solid.motion.poseAt(m * spec.time.duration / 64, solid.shape.pose);
      std::vector<Outline> now;
      for (const Outline& outline : own) now.push_back(transformed(outline, pose));
      seen = meets(boxOf(now));
    }
    if (!seen)
      scene.reader().warning(itemMark("solids", k), "solid `" + solid.name + "` lies outside of the domain",
                             solid.motion.isStill() ? "" : "at all of 65 moments that were looked at");
  }
  for (std::size_t k = 0; k < spec.smoke.sources.size(); ++k)
    if (!meets(boxOf(outlinesOf(spec.smoke.sources[k].shape, tolerance))))
      scene.reader().warning(scene.find("smoke")->entry("sources")->value->items[k]->mark,
                             "this source lies outside of the domain");
  for (std::size_t k = 0; k < spec.probes.size(); ++k) {
    const ProbeSpec& probe = spec.probes[k];
    const bool inside =
        probe.region ? meets(boxOf(outlinesOf(*probe.region, tolerance)))
                     : probe.at->x >= 0 && probe.at->y >= 0 && probe.at->x <= width && probe.at->y <= height;
    if (!inside)
      scene.reader().warning(itemMark("probes", k),
                             "probe `" + probe.name + "` lies outside of the domain at the start");
  }
}

}  // namespace smokebox
