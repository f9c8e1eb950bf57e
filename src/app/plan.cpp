// `smokebox plan SCENE`: what will be modelled, what not, and what it takes.
#include "world/plan.h"

#include <algorithm>
#include <cstdio>

#include "app/commands.h"
#include "app/scene_file.h"

namespace smokebox {

int runPlan(const PlanOptions& options) {
  const SceneSpec spec = loadScene(options.scene, options.settings).spec();
  const Plan plan = planOf(spec);
  std::printf("%s%s%s\n", spec.name.c_str(), spec.title.empty() ? "" : ": ", spec.title.c_str());
  std::printf("  %d x %d cells (%ld), %ld steps of %g s, %ld frames\n", plan.nx, plan.ny, plan.cells,
              plan.steps, spec.time.step, plan.frames);
  std::printf("  %d solids, %d free bodies, %d colours of smoke\n", plan.solids, plan.bodies,
              plan.smokeColors);
  std::printf("  about %.1f MB of memory\n", plan.memoryMb);
  std::size_t width = 0;
  for (const PlanLine& line : plan.lines) width = std::max(width, line.stage.size());
  for (const PlanLine& line : plan.lines)
    std::printf("  %s %-*s  %s\n", line.modelled ? "+" : "-", static_cast<int>(width), line.stage.c_str(),
                line.why.c_str());
  return 0;
}

}  // namespace smokebox
