// The solids of a scene in motion: where each is, how fast it moves over the step, whether it is shown.
#pragma once
#include <vector>

#include "coupling/solids_on_grid.h"
#include "scene/spec.h"

namespace smokebox {

class SolidScripts {
 public:
  /// `tolerance`: how far a polygon may be from a curve, metres. All solids are placed for time 0, at rest.
  SolidScripts(const std::vector<SolidSpec>& specs, double tolerance);

  /// Moves every solid from its pose at `time` to that at `time + dt`; the velocity is displacement over
  /// step.
  void move(double time, double dt);
  /// Takes over drags and motions that an event has changed. A steady motion (velocity, spin) that was
  /// replaced goes on from where the solid is; keyframes and formulas are absolute.
  void adopt(const std::vector<SolidSpec>& specs);
  void motionReplaced(int solid, double time);
  void stop(int solid);
  void setShown(int solid, bool shown) { scripts_[solid].shown = shown; }

  int count() const { return static_cast<int>(scripts_.size()); }
  int find(const std::string& name) const;  // -1: none
  /// As the fluid sees them, after the last move.
  const std::vector<MovingSolid>& moving() const { return moving_; }
  /// Has any shape moved in the last move()?
  bool shapesMoved() const { return shapesMoved_; }
  bool anyCanMove() const;
  bool shown(int solid) const { return scripts_[solid].shown; }
  const Pose& pose(int solid) const { return scripts_[solid].pose; }
  const Pose& startPose(int solid) const { return scripts_[solid].start; }
  const SolidSpec& spec(int solid) const { return scripts_[solid].spec; }
  /// Area, centre and second moment in the shape's own coordinates.
  const MassProperties& mass(int solid) const { return scripts_[solid].mass; }

 private:
  struct Script {
    SolidSpec spec;
    std::vector<Outline> local;  // in the shape's own coordinates
    MassProperties mass;
    Pose rest;         // what the motion starts from
    double since = 0;  // time at which `rest` holds, for steady motions
    Pose pose, start;
    bool stopped = false, shown = true;
  };
  void place(int solid, const Pose& pose);

  std::vector<Script> scripts_;
  std::vector<MovingSolid> moving_;
  double leastMove_;  // m, in a step
  bool shapesMoved_ = true;
};

}  // namespace smokebox
