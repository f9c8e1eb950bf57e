// Everything in a scene that moves by itself: builds the system of bodies from the scene, drives it step by
// step with the scripted solids, and does to it what events ask for. Built only into a scene that has a body,
// a particle or a cloth.
#pragma once
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/hash.h"
#include "coupling/solids_on_grid.h"
#include "rigid/system.h"
#include "scene/spec.h"
#include "world/cloth_mesh.h"
#include "world/figures.h"
#include "world/probes.h"
#include "world/snapshot.h"
#include "world/solid_scripts.h"

namespace smokebox {

/// Of a side of the domain along itself, m/s.
double wallSpeed(const DomainSpec& domain, int side);

class RigidStage {
 public:
  /// `tolerance`: how far an outline may be from a curve, metres. `inFluid`: bodies have to be put on a grid.
  RigidStage(const SceneSpec& spec, const SolidScripts& solids, double tolerance, bool inFluid,
             ThreadPool& pool);

  // --- events, between steps; what has been removed is passed over
  void impulse(const ImpulseAction& action);
  void pull(const PullAction& action, double time);
  void hold(const HoldAction& action);
  void remove(const RemoveAction& action);
  /// `event`: the position of the event; each time it adds the next ones.
  void add(const AddAction& action, int event);
  void cut(const CutAction& action);
  void setShown(const std::string& name, bool shown);
  /// Takes over what an event has set at `path`.
  void adopt(const SceneSpec& spec, const std::string& path);

  /// From `time` to `time + dt`; the solids are where they are at the end. Throws SimulationError that names
  /// a body whose state is not finite.
  void step(const SolidScripts& solids, long step, double dt);

  /// Bodies as the fluid sees them, after the last step.
  const std::vector<MovingSolid>& moving() const { return moving_; }
  /// Has any of them moved, come or gone since the step before?
  bool shapesMoved() const { return shapesMoved_; }
  /// What a user should be told once, since the last call.
  std::vector<std::string> takeNotices();

  void record(StepFigures& figures) const;
  void capture(double time, Snapshot& snapshot) const;
  void hashInto(Fnv1a& hash) const { system_.hashInto(hash); }
  const RigidSystem& system() const { return system_; }
  /// Poses of a body's centre of mass at the start and now; none if it is not there.
  std::optional<Carried> carried(const std::string& name) const;
  std::size_t bytes() const { return system_.bytes(); }

 private:
  struct Body {
    BodySpec spec;
    std::shared_ptr<const BodyShape> shape;
    Vec2 centre;  // of mass, in the coordinates of the outline as it is given
    int id = -1;  // in the system; -1: not there yet
    bool shown = true;
  };
  struct Pull {
    PullAction action;
    int spring;
    double until;
  };
  struct KeptTouch {
    Touch touch;
    double time;
  };

  void addSolids(const SceneSpec& spec, const SolidScripts& solids, double tolerance);
  void addLinks(const SceneSpec& spec);
  void readGroups(const SceneSpec& spec);
  std::uint64_t groupBits(const std::vector<std::string>& groups) const;
  std::shared_ptr<const BodyShape> shapeOf(const std::shared_ptr<const Shape>& shape, double tolerance,
                                           Vec2& centre);
  void addBody(Body& body);
  bool isThere(const Body& body) const { return body.id >= 0 && system_.isThere(body.id); }
  double massOf(const Body& body) const;
  double findUsualImpulse(Vec2 gravity) const;
  double findUsualTension(Vec2 gravity) const;
  double inertiaOf(const Body& body) const;
  /// `at` in the coordinates of the outline as it is given; the number is -1 for what is not there.
  std::optional<Anchor> anchorOf(const HoldSpec& hold) const;
  /// `at` in the world, now.
  Anchor anchorAt(const HoldSpec& hold, Vec2 at) const;
  Vec2 centreNow(const HoldSpec& hold) const;

  void hold(int id, bool held);
  void adoptBody(Body& body, const BodySpec& now, const std::string& key);
  void adoptLinks(const SceneSpec& spec, const std::vector<std::string>& steps);

  void releaseDue(double now);
  void movePulls(double start, double end);
  void takeDeparted(double time);
  void placeInFluid(double dt);
  void keepPast(double time, double dt);
  void keepImpact(const Touch& touch, double time);

  /// Where a thing of this box is seen: once, and where it sticks out of periodic sides once more.
  std::vector<Vec2> imagesOf(Vec2 low, Vec2 high) const;
  std::vector<Vec2> imagesBetween(Vec2 p, Vec2 q) const;
  void captureBodies(Snapshot& snapshot) const;
  void captureLinks(Snapshot& snapshot) const;
  double tensionNow(const SpringDef& spring) const;
  void captureTouches(double time, Snapshot& snapshot) const;
  void captureTrails(Snapshot& snapshot) const;

  RigidSystem system_;
  RigidWalls walls_;
  bool inFluid_;
  double dt_;
  std::vector<Body> bodies_;  // as in SceneSpec::bodies
  std::vector<ClothMesh> cloths_;
  std::vector<char> clothIsThere_;
  struct Solid {
    int id = -1;
    Vec2 centre;  // of mass, in the shape's own coordinates
    bool moves = false;
  };
  std::vector<Solid> solids_;
  std::vector<int> springs_, joints_;  // numbers of SceneSpec's in the system
  std::vector<std::optional<Color>> springColors_;
  std::vector<Pull> pulls_;
  std::map<std::string, int> groups_;
  std::map<const Shape*, std::pair<std::shared_ptr<const BodyShape>, Vec2>> shapes_;  // copies share theirs
  std::map<int, int> added_;          // times that an event has added
  std::vector<int> held_, ofSystem_;  // bodies that wait for `held_until`; body of a number, -1: none
  std::vector<std::string> notices_;

  std::vector<MovingSolid> moving_;
  std::vector<Pose> posesBefore_;  // of the bodies in the fluid, by their number here
  bool shapesMoved_ = true;

  double touchSeconds_ = 0, trailSeconds_ = 0;  // 0: no layer shows them
  double usualImpulse_ = 1, usualTension_ = 1;
  std::deque<KeptTouch> impacts_;
  struct LastImpact {
    double impulse, time;
    Vec2 point;
  };
  std::map<std::pair<int, int>, LastImpact> lastImpacts_;  // of each pair, while its mark is seen
  std::vector<std::deque<Vec2>> trails_;
};

}  // namespace smokebox
