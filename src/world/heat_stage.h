// The temperature in a scene: its start, the walls that keep one, the buoyancy it gives the fluid
// (Boussinesq) and its transport.
#pragma once
#include "fluid/fluid.h"
#include "fluid/heat.h"
#include "scene/spec.h"

namespace smokebox {

class HeatStage {
 public:
  HeatStage(const SceneSpec& spec, const Boundary& boundary, bool diffuses, ThreadPool& pool);

  /// Takes over what the walls keep and what comes in at a time: at the start, when an event has changed it,
  /// and in each step if it depends on the time.
  void setSides(const SceneSpec& spec, const Boundary& boundary, double time);
  bool sidesDependOnTime() const { return sidesDependOnTime_; }
  void boundaryChanged(const Boundary& boundary) { heat_.boundaryChanged(boundary); }

  /// Adds -gravity expansion (T - reference) to the faces.
  void addBuoyancy(const SceneSpec& spec, const Boundary& boundary, Field& accelerationU,
                   Field& accelerationV) const;
  Heat::Result transport(const Boundary& boundary, const Fluid& fluid, double diffusivity, double dt) {
    return heat_.advance(boundary, fluid.u(), fluid.v(), diffusivity, dt);
  }

  double at(int i, int j) const { return origin_ + heat_.value()(i, j); }
  bool isOpen(int i, int j) const { return heat_.isOpen(i, j); }
  /// The temperature that a value of 0 stands for: the mean of the start.
  double origin() const { return origin_; }
  const Heat& heat() const { return heat_; }
  std::size_t bytes() const { return heat_.bytes(); }

 private:
  Grid grid_;
  ThreadPool& pool_;
  Heat heat_;
  HeatSides sides_;
  double origin_ = 0;
  bool sidesDependOnTime_ = false;
};

}  // namespace smokebox
