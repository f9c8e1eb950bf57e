// The simulator: builds from a scene just the stages that it needs, and takes fixed steps.
//
// Start reading at World::step(): it is the table of contents of the whole program.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "base/threads.h"
#include "coupling/solids_on_grid.h"
#include "fluid/fluid.h"
#include "scene/document.h"
#include "world/event_schedule.h"
#include "world/figures.h"
#include "world/heat_stage.h"
#include "world/needs.h"
#include "world/probes.h"
#include "world/rigid_stage.h"
#include "world/smoke_stage.h"
#include "world/snapshot.h"
#include "world/solid_scripts.h"
#include "world/stage_clock.h"

namespace smokebox {

class World {
 public:
  struct Options {
    int threads = 1;
    bool figures = false;  // also momentum, energy, probes and forces of each step
  };

  /// Throws SceneError if the scene is wrong.
  World(const SceneDocument& document, const Options& options);
  ~World();

  /// Advances by one fixed step. Throws SimulationError when the simulation goes wrong.
  void step();

  double time() const { return stepCount_ * spec_.time.step; }
  long stepCount() const { return stepCount_; }
  const SceneSpec& spec() const { return spec_; }
  const StepFigures& figures() const { return figures_; }
  /// Of all steps so far.
  SummaryFigures summary() const;

  /// What a user should be told, once, since the last call: "step 12 (t = 0.1 s): ...".
  std::vector<std::string> takeNotices();

  /// Copies what the layers need that are shown now; the snapshot's view has only these.
  void capture(Snapshot& snapshot) const;

  /// 64-bit hash of the whole state (velocity, pressure, smoke, temperature, poses, bodies); equal for any
  /// number of threads.
  std::uint64_t stateHash() const;

  /// For tests: null in a scene without a fluid.
  const Fluid* fluid() const { return fluid_ ? &*fluid_ : nullptr; }
  const Boundary& boundary() const { return boundary_; }
  const SmokeStage* smoke() const { return smoke_ ? &*smoke_ : nullptr; }
  const HeatStage* heat() const { return heat_ ? &*heat_ : nullptr; }
  const SolidScripts& solids() const { return solids_; }
  /// Null in a scene without bodies, particles and cloth.
  const RigidStage* rigid() const { return rigid_.get(); }
  std::size_t bytes() const;

 private:
  /// A force on a region of the fluid that lasts for a while.
  struct ActiveForce {
    Field share;
    Vec2 acceleration;  // m/s^2
    long untilStep;
  };
  struct ActiveCaption {
    std::string text;
    double until;
  };

  void buildFluid();
  void setWalls(double time);
  void fireEvents();
  void adoptSettings(const SetAction& action);
  void fireRigid(const EventSpec& event, int index);
  void moveSolids();
  void moveBodies();
  /// All that parts the fluid: the solids, then the bodies.
  const std::vector<MovingSolid>& covered() const { return rigid_ ? covered_ : solids_.moving(); }
  void gatherCovered();
  /// Of a solid or a body; none if a body is not there.
  std::optional<Carried> carried(const std::string& name) const;
  void coverGrid(bool shapesMoved);
  void addForces();
  void projectFluid();
  void carryHeat();
  void recordFigures();
  void captureTemperature(Field& temperature) const;
  void capturePressure(Field& pressure) const;
  void captureVelocity(bool vorticity, Snapshot& snapshot) const;
  [[noreturn]] void fail(const std::string& what, const std::string& hint) const;

  SceneDocument document_;
  SceneSpec spec_;
  Options options_;
  mutable ThreadPool pool_;
  StageClock clock_;

  EventSchedule events_;
  SolidScripts solids_;
  Needs needs_;
  Boundary boundary_;
  SolidsOnGrid onGrid_;
  std::unique_ptr<RigidStage> rigid_;
  std::vector<MovingSolid> covered_;  // only with bodies
  std::optional<Fluid> fluid_;
  std::optional<SmokeStage> smoke_;
  std::optional<HeatStage> heat_;
  ProbeSet probes_;
  std::vector<ActiveForce> forces_;
  std::vector<ActiveCaption> captions_;
  bool wallsDependOnTime_ = false, solidsMovedBefore_ = false;
  Field pressure_;  // Pa; only for forces on solids

  long stepCount_ = 0;
  StepFigures figures_;
  std::vector<float> stepMs_;
  double divergenceMax_ = 0, overlapMax_ = 0;
};

}  // namespace smokebox
