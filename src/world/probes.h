// Probes: the fluid at a point, or averaged over a region that may follow a solid or a body.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fluid/fluid.h"
#include "fluid/smoke.h"
#include "scene/spec.h"
#include "world/figures.h"
#include "world/heat_stage.h"
#include "world/snapshot.h"

namespace smokebox {

/// Poses of what probes follow, at the start and now, by their names; none: it is not there.
struct Carried {
  Pose start, now;
};
using FindCarried = std::function<std::optional<Carried>(const std::string& name)>;

class ProbeSet {
 public:
  ProbeSet(const std::vector<ProbeSpec>& specs, double tolerance);

  /// Reads all probes. `pressureScale`: Pa for one unit of phi. `fluid`, `smoke` and `heat` may be
  /// null.
  void read(const Boundary& boundary, const Fluid* fluid, const Smoke* smoke, const HeatStage* heat,
            double pressureScale, const FindCarried& find, std::vector<ProbeFigures>& out);
  void capture(const FindCarried& find, std::vector<ProbePicture>& out) const;
  bool empty() const { return probes_.empty(); }

 private:
  struct Probe {
    ProbeSpec spec;
    std::vector<Outline> region;  // at the start; empty for a point
  };
  Vec2 pointNow(const Probe& probe, const FindCarried& find) const;
  std::vector<Outline> regionNow(const Probe& probe, const FindCarried& find) const;

  std::vector<Probe> probes_;
  Field share_;
};

}  // namespace smokebox
