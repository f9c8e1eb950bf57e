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
  std::vector<std::array<char, 2>> moved_;  // by joint: whether its bodies could move when it was laid out
  bool stale_ = false;                      // the islands must be laid out anew
  double h_ = 0;                            // of the last sub-step, s
};

}  // namespace smokebox
