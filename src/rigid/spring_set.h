// All springs. Few that hang together, and chains, are solved at once (spring_island.h); cloth by
// conjugate gradients (spring_sheet.h). Both have the exact equilibrium as the only state at rest, however
// few the sweeps.
#pragma once
#include "rigid/spring_sheet.h"

namespace smokebox {

class Fnv1a;

class SpringSet {
 public:
  explicit SpringSet(ThreadPool& pool) : pool_(&pool) {}

  int add(const SpringDef& def, const Bodies& bodies);
  void remove(int spring);
  void removeAt(int body);
  /// Is there a spring at the body?
  bool ties(int body);
  int count() const { return static_cast<int>(springs_.size()); }
  bool isThere(int spring) const { return springs_[spring].there; }
  const SpringDef& def(int spring) const { return springs_[spring].def; }
  /// Length, stiffness, damping, slack and tear may be changed between steps; not the ends.
  SpringDef& def(int spring) {
    changed_ = true;
    return springs_[spring].def;
  }
  /// Where its end in the world is at the end of the next step.
  void moveEnd(int spring, Vec2 to);
  bool empty() const { return there_ == 0; }
  /// How many have been removed, since it was made.
  long removed() const { return removed_; }

  void beginStep(Bodies& bodies, double dt, int subSteps);
  void warmStart(Bodies& bodies, double h);
  /// One sweep over all; the largest change of a relative velocity, m/s.
  double solve(Bodies& bodies, double h);
  /// Of a sweep, in points of contact that would take as long.
  long sweepCost() const;
  void endStep(Bodies& bodies);
  /// After the first sub-step: velocities that belong to its middle have had half of it, where the spring is
  /// new, or the body's velocity was set (1 in `fresh`).
  void takeBackHalf(Bodies& bodies, const std::vector<char>& fresh, double h);
  /// The other half of the last sub-step, for a spring that is cut.
  void giveHalf(int spring, Bodies& bodies) const;

  /// N, of the last sub-step; positive: it pulls.
  double tension(int spring) const;
  /// Elastic, J.
  double energy(const Bodies& bodies) const;

  /// Conjugate gradient iterations since it was made.
  long iterations() const;

  void hashInto(Fnv1a& hash) const;
  std::size_t bytes() const;

 private:
  void layOut(const Bodies& bodies);
  void listByBody();
  double distance(int spring, const Bodies& bodies) const;
  void push(int spring, Bodies& bodies, double share, const std::vector<char>* fresh) const;

  ThreadPool* pool_;
  std::vector<Spring> springs_;
  std::vector<SpringIsland> islands_;
  std::vector<SpringSheet> sheets_;       // one for each group that hangs together
  std::vector<int> sheetOf_;              // by spring; -1: it is in an island
  std::vector<int> firstAt_, springsAt_;  // of each body; firstAt_ is empty: to be listed
  std::vector<char> moved_;  // by body: 1 if it could move when springs were laid out; 2: no spring is there
  StepClock clock_;
  double h_ = 0;  // of the last sub-step, s
  int there_ = 0;
  long removed_ = 0;
  bool fresh_ = false;     // a spring is
  bool stale_ = false;     // the islands must be laid out anew
  bool changed_ = false;   // one may be another than in the last step
  bool carrying_ = false;  // an end in the world is on its way
  bool tearing_ = false;   // a spring can tear
};

}  // namespace smokebox
