// Everything that moves by itself: bodies, particles, springs and joints, with the solids and walls that they
// meet. Takes fixed steps; within one, sub-steps of equal length in which contacts and joints are hard.
//
// The scheme of a sub-step of h seconds (leapfrog: velocities belong to its middle, so free flight is a
// parabola to rounding and joints neither gain nor lose energy):
//   v += h gravity; impacts at their own moments within the sub-step; contacts, joints and springs by
//   warm-started Gauss-Seidel on impulses; x += h v; what still overlaps is moved apart without touching v.
// A body is never rolled back but for the pair of a swept test, and the work of a step is bounded.
//
// All quantities are per metre of depth, SI units, angles in radians.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/threads.h"
#include "geometry/shape.h"
#include "rigid/links.h"
#include "rigid/pieces.h"

namespace smokebox {

/// How a body begins. Positions are those of its centre of mass (of the shape's own (0, 0) for a solid).
struct BodyDef {
  std::shared_ptr<const BodyShape> shape;
  Vec2 position;
  double angleRad = 0;
  Vec2 velocity;              // m/s
  double spin = 0;            // rad/s
  double mass = 0;            // kg; 0: nothing moves it but moveTo()
  double inertia = 0;         // kg m^2; 0: never turns by itself (a particle)
  double bounce = 0;          // 0..1
  double friction = 0.5;      // 0 or more
  double linearDamping = 0;   // 1/s
  double angularDamping = 0;  // 1/s
  double gravityScale = 1;    // share of gravity that it feels
  std::uint64_t ignore = 0;   // bodies that share a bit pass through each other
  bool held = false;          // stays where it is until release()
};

/// What bounds the world of bodies: the domain's sides, at 0 and at width or height.
struct RigidWalls {
  enum class Kind { closed, open, periodic };
  double width = 0, height = 0;
  Kind sides[4] = {Kind::closed, Kind::closed, Kind::closed, Kind::closed};  // left, right, bottom, top
  double speeds[4] = {0, 0, 0, 0};  // of the wall along itself: vy of left and right, vx of bottom and top
  double bounce = 0, friction = 0.5;
};

struct RigidMethod {
  int subSteps = 16;
  /// Gauss-Seidel sweeps of a sub-step: at least one; more, up to this many, while contacts have not settled
  /// and the bound of the work of a step allows it.
  int maxSweeps = 400;
};

/// A touching point during the last step.
struct Touch {
  int a = -1, b = -1;   // bodies; -1: a wall of the domain
  Vec2 point, normal;   // from a to b
  double impulse = 0;   // N s along the normal, over the step
  double approach = 0;  // speed at which they met, m/s; 0 where they rested
};

struct RigidTotals {
  Vec2 momentum;
  double angularMomentum = 0;  // about the world's origin
  double kineticEnergy = 0;    // J
  double potentialEnergy = 0;  // of gravity (height 0 at the origin) and springs, J
  int contacts = 0;            // points that touch
  double overlap = 0;          // deepest, m
};

class RigidSystem {
 public:
  RigidSystem(const RigidWalls& walls, Vec2 gravity, const RigidMethod& method, ThreadPool& pool);
  ~RigidSystem();

  // --- what there is. Numbers are given in order, and never used again.
  int add(const BodyDef& def);
  int addSpring(const SpringDef& def);
  int addJoint(const JointDef& def);
  /// Springs and joints at the body go with it.
  void remove(int body);
  void removeSpring(int spring);
  void removeJoint(int joint);

  // --- what events and scripts do, between steps
  void setGravity(Vec2 gravity);
  void setVelocity(int body, Vec2 velocity);
  void setSpin(int body, double spin);
  /// N s at a point of the world.
  void applyImpulse(int body, Vec2 at, Vec2 impulse);
  void hold(int body);
  void release(int body);
  void setSurface(int body, double bounce, double friction);
  void setDamping(int body, double linear, double angular);
  void setGravityScale(int body, double scale);
  void setMass(int body, double mass, double inertia);
  void setSpring(int spring, double length, double stiffness, double damping);
  void setSpringSlack(int spring, double slack);
  void setMotor(int joint, double speed, double limit);
  /// Of a wall of the domain along itself (see RigidWalls).
  void setWallSpeed(int side, double speed);
  /// A body without mass: where it is at the end of the next step; it pushes, carries and spins what it
  /// meets.
  void moveTo(int body, Vec2 position, double angleRad);
  /// The end of a spring that is in the world: where it is at the end of the next step.
  void moveSpringEnd(int spring, Vec2 to);

  /// Throws SimulationError if a body's state is not finite (it says which).
  void step(double dt);

  // --- what there is now
  int bodyCount() const;
  bool isThere(int body) const;  // false once removed
  const BodyDef& def(int body) const;
  Vec2 position(int body) const;
  double angleRad(int body) const;
  Vec2 velocity(int body) const;
  double spin(int body) const;
  bool held(int body) const;
  bool springIsThere(int spring) const;
  long springsRemoved() const;  // so far, torn ones among them
  const SpringDef& spring(int spring) const;
  /// N; positive: it pulls.
  double springTension(int spring) const;
  bool jointIsThere(int joint) const;
  const JointDef& joint(int joint) const;
  Vec2 anchorPoint(const Anchor& anchor) const;
  /// Of a spring or joint: the second end beyond a periodic side, if that is where it is from the first one;
  /// a first one in the world likewise.
  std::array<Vec2, 2> endsOf(const Anchor& from, const Anchor& to) const;
  /// Where a body is from another that it is tied to: beyond a periodic side, if one of them has come in
  /// again.
  Vec2 positionBeside(int body, int other) const;
  const std::vector<Touch>& touches() const;
  RigidTotals totals() const;
  /// Bodies whose last part has left through an open side since the last call, each once.
  std::vector<int> takeDeparted();
  /// Feeds the whole state to a hash.
  void hashInto(class Fnv1a& hash) const;
  std::size_t bytes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace smokebox
