// What a RigidSystem holds, and the stages of its step.
#pragma once
#include <vector>

#include "rigid/bodies.h"
#include "rigid/broad_phase.h"
#include "rigid/conjugate_sweeps.h"
#include "rigid/contact_blocks.h"
#include "rigid/impacts.h"
#include "rigid/joint_set.h"
#include "rigid/lanes.h"
#include "rigid/narrow_phase.h"
#include "rigid/press.h"
#include "rigid/rough_contacts.h"
#include "rigid/spring_set.h"

namespace smokebox {

struct RigidSystem::State {
  static constexpr int kWalls = 4;  // the first bodies: left, right, bottom, top

  State(const RigidWalls& bounds, Vec2 pull, const RigidMethod& how, ThreadPool& threads);

  // --- the stages of a step, in order
  void beginStep(double dt);
  void predict(double h);
  void bounce(double h);
  void solveContacts(double h);
  void move(double h);
  void endStep(double dt);

  void addWalls();
  /// What follows from the bodies' definitions alone.
  void takeCensus();
  void startVelocities(double h);
  /// todo(body) for all but the walls, by several threads: it must touch that body alone.
  template <class Todo>
  void eachBody(Todo&& todo) {
    constexpr int kGrain = 1024;
    pool.blocks(kWalls, bodies.count(), kGrain, [&](int b, int end) {
      for (; b < end; ++b) todo(b);
    });
  }
  void findAhead(int body, double h);
  void giveBackSpare();
  void setInverse(int body);
  /// Lets the bodies of a joint pass through each other, or no longer.
  void setJoined(const JointDef& joint, bool on);
  double sweep(double h, bool first, double enough);
  /// Sweeps whose change of a relative velocity is beyond this leave a rough state, m/s.
  double roughFrom(double h) const;
  void sweepRough(double h, double change);
  MoveApart moveApart(double h) const;
  void separateAll(double h);
  void takeOutLone();
  void findFlying(double h);
  void yieldTorn();
  void impacts(double h);
  void moveOn(double h);
  bool isSqueezed(const Contact& contact) const;
  bool meetsFast(const Contact& contact, double h) const;
  bool isInside(int body) const;
  void keepInside(int body);
  void remember(double h, double left);
  /// A velocity after what the body does by itself in a sub-step.
  Lanes drivenBy(int body, Lanes velocity) const;
  void warmStartAll(double h);
  void collectTouch(const Contact& contact);
  void sortTouches();
  void wrap(int body);
  bool leaves(int body);

  RigidWalls walls;
  Vec2 edge;  // of the domain: who is nearer to a side than so much is not inside, m
  Vec2 gravity;
  RigidMethod method;
  ThreadPool& pool;

  Bodies bodies;
  std::vector<Motion> resume;  // velocity that a held body goes on with
  std::vector<char> fresh;  // velocity (1), spin (2) was set: it is that of now, not of half a sub-step ago
  std::vector<char> departed;     // has been reported
  std::vector<Vec2> targetPlace;  // of bodies without mass: at the end of the coming step
  std::vector<double> targetAngle;
  std::vector<Motion> ahead;       // what brings the velocity of the last sub-step's middle to its end
  std::vector<Motion> before;      // velocities before the last sub-step
  std::vector<Motion> beforeThat;  // and before the one before it
  std::vector<Motion> struck;      // what impacts add to a body's way in this sub-step
  std::vector<Motion> start;       // velocities before the contact solver; else, what is carried
  std::vector<char> flying;        // it hardly changed them; kept where something may bounce
  /// To the next sub-step, in `start`: nothing, what the calm contacts add to its velocities, or all that it
  /// begins to solve with; `velocity` is then predicted already.
  enum class Carried { nothing, share, all };
  Carried carried = Carried::nothing;
  bool firstOfStep = false;  // sub-step
  bool stirred = false, anyStruck = false, mayBounce = false;
  std::vector<char> torn;   // hangs on joints that no motion satisfies, or touches what does
  std::vector<Motion> way;  // of a sub-step, where pairs may pass through each other

  /// What a time does to a body's velocity by itself: gravity, and damping that decays exponentially.
  struct Drive {
    Vec2 gain;                       // m/s
    double linear = 1, angular = 1;  // what is left of it; read in one with the gain
  };
  Drive driveOver(const BodyDef& def, double time) const;
  /// Damping takes its share of what a force gives a body in a sub-step, as it does of what gravity gives:
  /// seen by forces the body is that much heavier, by impacts it is not.
  void findSeenByForces();
  bool damped = false;                    // a body is
  std::vector<InverseMass> forImpacts;    // while bodies.inverse is for forces
  std::vector<Drive> drives, halfDrives;  // of a sub-step, of half of one
  double drivesStep = 0;                  // the sub-step and the gravity that they are for
  Vec2 drivesGravity;
  BroadPhase broad;
  NarrowPhase narrow;
  ContactBlocks blocks;
  std::vector<int> uncoloured;       // calm contacts that found no colour: solved one by one
  std::vector<SolvedContact> spare;  // those
  std::vector<int> bouncing;         // calm contacts that may bounce
  std::vector<Contact*> bouncers;
  std::vector<SolvedContact*> deepOnes;
  RoughContacts roughOnes;
  ConjugateSweeps conjugate;
  SpringSet springs;
  JointSet joints;
  Impacts impact{joints};
  Press press;

  std::vector<Turn> turned;        // by how much since the step began
  std::vector<Touch> touches;      // in order once they are asked for
  std::ptrdiff_t calmTouches = 0;  // where those of calm pairs begin, until then
  RigidTotals contactTotals;       // contacts and overlap of the last step
  std::vector<int> gone;
  double dt = 0, timeLeft = 0;
  double leftUndone = 0;    // largest change of a relative velocity in a last sweep of this step, m/s
  double typicalWidth = 0;  // mean of the moving bodies' smallest widths, m
};

}  // namespace smokebox
