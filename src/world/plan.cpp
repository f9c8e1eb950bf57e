#include "world/plan.h"

#include <algorithm>

#include "world/needs.h"

namespace smokebox {

namespace {

/// Which fields the pictures show, and when.
PlanLine fieldsInPictures(const SceneSpec& spec) {
  PlanLine line{"fields in pictures", false, ""};
  std::string hidden;
  for (const LayerKind kind : {LayerKind::pressure, LayerKind::vorticity, LayerKind::speed,
                               LayerKind::temperature, LayerKind::velocity}) {
    bool listed = false, atStart = false;
    for (const LayerSpec& layer : spec.view.layers) {
      listed |= layer.kind == kind;
      atStart |= layer.kind == kind && layer.shown;
    }
    auto add = [&](std::string& text, const char* how) {
      text += (text.empty() ? "" : ", ") + std::string(layerName(kind)) + how;
    };
    const bool there = kind == LayerKind::temperature ? spec.temperature.named : spec.hasFluid;
    if (there && canShow(spec, kind)) {
      line.modelled = true;
      add(line.why, atStart ? "" : listed ? " (when an event shows it)" : " (if an event adds it)");
    } else if (listed) {
      add(hidden, there           ? " is hidden, and no event shows it"
                  : spec.hasFluid ? " is not modelled"
                                  : " needs a fluid");
    }
  }
  if (!line.modelled) line.why = hidden.empty() ? "no layer shows one" : hidden;
  return line;
}

std::string counted(std::size_t count, const char* what) { return std::to_string(count) + " " + what; }

/// What moves by itself; counts the bodies.
void addBodies(const SceneSpec& spec, Plan& plan) {
  std::size_t particles = 0, threads = 0, nodes = 0;
  for (const BodySpec& body : spec.bodies) particles += body.particle;
  const std::size_t bodies = spec.bodies.size() - particles;
  for (const ClothSpec& cloth : spec.cloths) {
    const std::size_t i = cloth.columns(), j = cloth.rows();
    nodes += i * j;
    threads += (i - 1) * j + i * (j - 1) + (cloth.shear > 0 ? 2 * (i - 1) * (j - 1) : 0);
    if (cloth.bend > 0)
      threads += (std::max<std::size_t>(i, 2) - 2) * j + i * (std::max<std::size_t>(j, 2) - 2);
  }
  plan.bodies = static_cast<int>(bodies);
  auto line = [&](const char* stage, bool modelled, const std::string& yes, const char* no) {
    plan.lines.push_back({stage, modelled, modelled ? yes : no});
  };
  line("bodies", bodies > 0, counted(bodies, "of them, with contacts"), "no bodies");
  line("particles", particles > 0, counted(particles, "of them, with contacts"), "no particles");
  line("cloth", nodes > 0, counted(nodes, "particles and ") + counted(threads, "springs"), "no cloth");
  line("springs", !spec.springs.empty(), counted(spec.springs.size(), "of them"), "no springs");
  line("joints", !spec.joints.empty(), counted(spec.joints.size(), "of them"), "no joints");
  constexpr double kBytesEach = 1200, kBytesOfSpring = 200;  // with their contacts
  plan.memoryMb += (kBytesEach * static_cast<double>(spec.bodies.size() + nodes) +
                    kBytesOfSpring * static_cast<double>(threads + spec.springs.size())) /
                   (1024 * 1024);
}

}  // namespace

Plan planOf(const SceneSpec& spec) {
  const Needs needs = needsOf(spec);
  Plan plan;
  plan.nx = spec.domain.grid.nx;
  plan.ny = spec.domain.grid.ny;
  plan.cells = needs.fluid ? spec.domain.grid.cells() : 0;
  plan.steps = spec.time.steps;
  plan.frames = spec.time.steps / spec.time.stepsPerFrame;
  plan.solids = static_cast<int>(spec.solids.size());
  plan.smokeColors = needs.smoke ? static_cast<int>(spec.smokeColors().size()) : 0;

  auto line = [&](const char* stage, bool modelled, const char* yes, const char* no) {
    plan.lines.push_back({stage, modelled, modelled ? yes : no});
  };
  line("fluid", needs.fluid, "the scene names a fluid, smoke, a temperature or an inflow",
       "no fluid, smoke, temperature or inflow is named");
  line("pressure projection", needs.fluid, "an incompressible fluid", "no fluid");
  line("viscosity", needs.parts.viscous, "fluid.viscosity", "fluid.viscosity is 0");
  line("vorticity confinement", needs.parts.confined, "fluid.vorticity", "fluid.vorticity is 0");
  line("surface drag", needs.parts.inviscidDrag, "a solid or body with drag in an inviscid fluid",
       needs.parts.viscous ? "the viscosity does it" : "no solid and no body has drag");
  line("smoke", needs.smoke, "sources or bursts", "no source and no burst");
  line("buoyancy", needs.buoyancy, "smoke.buoyancy", needs.smoke ? "smoke.buoyancy is 0" : "no smoke");
  line("temperature", needs.heat, "temperature", "no temperature is named");
  line("diffusion of heat", needs.heatDiffuses, "temperature.diffusivity",
       needs.heat ? "temperature.diffusivity is 0" : "no temperature");
  line("buoyancy of heat", needs.heatRises, "temperature.expansion and gravity",
       needs.heat ? "no gravity, or temperature.expansion is 0" : "no temperature");
  line("driven sources", needs.sourcesDrive, "a source with a velocity", "no source has a velocity");
  const bool bodies = std::any_of(spec.bodies.begin(), spec.bodies.end(),
                                  [](const BodySpec& body) { return !body.particle; });
  line("solids on the grid", needs.fluid && (plan.solids > 0 || bodies),
       needs.movingSolids || bodies ? "anew when one moves" : "once: none moves",
       "no solids and no bodies in a fluid");
  line("forces on solids", needs.reports, "report: true", "no solid reports");
  addBodies(spec, plan);
  line("probes", !spec.probes.empty(), "probes", "no probes");
  plan.lines.push_back(fieldsInPictures(spec));
  line("events", !spec.events.empty(), "events", "no events");

  // Fields of floats: velocity, pressure, fractions and wall velocities; stages of the integrator; the
  // multigrid (a third more for its coarse levels); then what each part adds.
  double fields = 0;
  if (needs.fluid) {
    fields = 8 + 8 + 8 * 4.0 / 3;
    if (needs.parts.forced) fields += 2;
    if (needs.parts.confined) fields += 2;
    if (needs.parts.viscous) fields += 10;
    if (needs.heat) fields += 9;
    if (needs.heatDiffuses) fields += 8;
    if (needs.smoke) fields += 3.0 * plan.smokeColors + 6 + static_cast<double>(spec.smoke.sources.size());
  }
  plan.memoryMb += fields * 4 * (plan.nx + 32.0) * (plan.ny + 8.0) / (1024 * 1024);
  return plan;
}

}  // namespace smokebox
