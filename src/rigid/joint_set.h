// All joints. Those that hang together through bodies that move are solved at once (joint_island.h).
#pragma once
#include "rigid/joint_island.h"

namespace smokebox {

class Fnv1a;

class JointSet {
 public:
  /// The angle between the bodies is measured now.
  int add(const JointDef& def, const Bodies& bodies);
  void remove(int joint);
  void removeAt(int body);
  /// Is there a joint at the body?
  bool ties(int body) const;
  int count() const { return static_cast<int>(joints_.size()); }
  bool isThere(int joint) const { return joints_[joint].there; }
  const JointDef& def(int joint) const { return joints_[joint].def; }
  JointDef& def(int joint) { return joints_[joint].def; }
  void setMotor(int joint, double speed, double limit);
  bool empty() const;

  void beginStep(Bodies& bodies, double dt, int subSteps);
  void warmStart(Bodies& bodies, double h);
  /// One sweep over all; the largest change of a relative velocity, m/s.
  double solve(Bodies& bodies, double h);
  void beginImpacts() { isReady_.assign(islands_.size(), 0); }
  /// Does the body hang on joints, of which an impact on it must know?
  bool holds(int body) const { return body < static_cast<int>(islandOf_.size()) && islandOf_[body] >= 0; }
  /// The bodies that an impact on these two changes, those two too if they move.
  void listTogether(const Bodies& bodies, int a, int b, std::vector<int>& all) const;
  /// The velocities of a and b were just changed at once: adds what joints make of it to those of all.
  void beginImpact(Bodies& bodies, int a, int b);
  void react(Bodies& bodies, int a, const Motion& changeA, int b, const Motion& changeB);
  /// For the rest of the sub-step, where sweeps over joints and contacts diverge.
  void stayLinear(const Bodies& bodies);
  void doubt(const Bodies& bodies);
  bool anyTorn() const;
  /// Marks by body who hangs on torn joints, or together with one that is marked. False: nothing new.
  bool mark(std::vector<char>& marked) const;
  void endStep(Bodies& bodies);

  /// Size of the force that holds the bodies together in the last sub-step, N; of a rope, its tension.
  double tension(int joint) const;
  /// On b, about the anchor, in the last sub-step, N m.
  double torque(int joint) const;

  void hashInto(Fnv1a& hash) const;
  std::size_t bytes() const;

 private:
  void layOut(const Bodies& bodies);

  std::vector<Joint> joints_;
  std::vector<JointIsland> islands_;
  std::vector<int> islandOf_;               // by body; -1: none, or too dense
  std::vector<char> isReady_;               // for impacts
  std::vector<std::array<char, 2>> moved_;  // by joint: whether its bodies could move when it was laid out
  bool stale_ = false;                      // the islands must be laid out anew
  double h_ = 0;                            // of the last sub-step, s
};

}  // namespace smokebox
