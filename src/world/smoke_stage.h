// Smoke in a scene: one channel for each colour, the sources and bursts that add to it, its buoyancy and its
// transport.
#pragma once
#include <vector>

#include "fluid/fluid.h"
#include "fluid/smoke.h"
#include "geometry/coverage.h"
#include "scene/spec.h"

namespace smokebox {

class SmokeStage {
 public:
  /// `tolerance`: how far the outline of a round source may be from the curve, metres.
  SmokeStage(const SceneSpec& spec, const Boundary& boundary, double tolerance, ThreadPool& pool);

  /// Takes over the scene's sources: at the start, and when an event has changed them.
  void placeSources(const SceneSpec& spec, const Boundary& boundary);
  /// Adds what the sources give in [time, time + dt).
  void emit(const Boundary& boundary, double time, double dt);
  void burst(const Boundary& boundary, const BurstAction& burst);
  /// Adds upward (against gravity) acceleration per unit of smoke, to the faces.
  void addBuoyancy(const Boundary& boundary, double buoyancy, Vec2 gravity, Field& accelerationU,
                   Field& accelerationV) const;
  /// Drives the fluid in the sources that have a velocity.
  void driveFluid(const Boundary& boundary, double time, Fluid& fluid) const;
  void transport(const Boundary& boundary, const Fluid& fluid, double dt) {
    smoke_.transport(boundary, fluid.u(), fluid.v(), dt);
  }

  const Smoke& smoke() const { return smoke_; }
  const std::vector<Color>& colors() const { return colors_; }
  std::size_t bytes() const;

 private:
  int channelOf(const Color& color) const;

  Grid grid_;
  double tolerance_;
  ThreadPool& pool_;
  std::vector<Color> colors_;  // one for each channel
  struct Source {
    SourceSpec spec;
    int channel = 0;
    Field share;  // part of each cell's area inside the shape
  };
  std::vector<Source> sources_;
  Smoke smoke_;
};

}  // namespace smokebox
