// Probes: the fluid at a point, or averaged over a region that may follow a solid.
#pragma once
#include <vector>

#include "fluid/fluid.h"
#include "fluid/smoke.h"
#include "scene/spec.h"
#include "world/figures.h"
#include "world/heat_stage.h"
#include "world/snapshot.h"
#include "world/solid_scripts.h"

namespace smokebox {

class ProbeSet {
 public:
  ProbeSet(const std::vector<ProbeSpec>& specs, double tolerance);

  /// Reads all probes. `pressureScale`: Pa for one unit of phi. `fluid`, `smoke` and `heat` may be
  /// null.
  void read(const Boundary& boundary, const Fluid* fluid, const Smoke* smoke, const HeatStage* heat,
            double pressureScale, const SolidScripts& solids, std::vector<ProbeFigures>& out);
  void capture(const SolidScripts& solids, std::vector<ProbePicture>& out) const;
  bool empty() const { return probes_.empty(); }

 private:
  struct Probe {
    ProbeSpec spec;
    std::vector<Outline> region;  // at the start; empty for a point
  };
  Vec2 pointNow(const Probe& probe, const SolidScripts& solids) const;
  std::vector<Outline> regionNow(const Probe& probe, const SolidScripts& solids) const;

  std::vector<Probe> probes_;
  Field share_;
};

}  // namespace smokebox
