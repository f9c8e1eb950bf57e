// Many springs between particles (cloth). The velocities v that obey
//   M v = M v* + J^T impulses,  impulse = -(bias + hardness J v)   (spring_row.h)
// are found by conjugate gradients on M + J^T hardness J, started from the impulses of the last sub-step. All
// that is ever added is a sum of forces between two ends along their line: momentum and angular momentum are
// kept however early it stops. At rest it has nothing to do.
//
// Sums run in a fixed order, with the two components of a vector as the two lanes that every x86-64 has.
#pragma once
#include "rigid/spring_island.h"

namespace smokebox {

class SpringSheet {
 public:
  /// Whether a spring is of the kind that this can do: between two bodies, at their centres or where they do
  /// not turn.
  static bool takes(const Spring& spring, const Bodies& bodies);
  void layOut(const std::vector<int>& springs, const std::vector<Spring>& all, const Bodies& bodies);
  bool empty() const { return links_.empty(); }

  void beginStep(const std::vector<Spring>& springs, const Bodies& bodies, double h);
  /// `hBefore`: the length of the last sub-step.
  void warmStart(Bodies& bodies, double h, double hBefore);
  /// The largest change of a velocity, m/s.
  double solve(Bodies& bodies);
  void endStep(const Bodies& bodies, double h);

  /// N, of the last sub-step; 0 if the spring is not here.
  double tension(int spring) const;
  bool has(int spring) const { return slotOf(spring) >= 0; }
  std::size_t bytes() const;
  /// Conjugate gradient iterations since it was made.
  long iterations() const { return iterations_; }

 private:
  typedef double Pair __attribute__((vector_size(16)));
  struct Link {
    int spring, a, b;  // a and b: nodes
    // As they were when `hardness` and the like were found.
    double length, stiffness, damping, inverseA, inverseB;
    double hardness, perStretch, perRate;  // bias = perStretch C + perRate u0
    double tension;
  };
  struct Force {      // impulse on b = -(bias + matrix (vb - va))
    Pair columns[2];  // of the matrix
    Pair bias;
  };

  int slotOf(int spring) const;
  void prepare(Link& link, const SpringDef& def, const Bodies& bodies, double h);
  void multiply(const std::vector<Pair>& p, std::vector<Pair>& out) const;

  std::vector<Link> links_;  // in the order of their nodes
  std::vector<Force> forces_;
  std::vector<int> slotOf_;  // by spring; -1: not here
  // By node.
  std::vector<int> body_;
  std::vector<double> mass_, inverse_;  // 0 for what does not move
  std::vector<Pair> place_, moved_;     // at the sub-step's start; within the last sub-step
  std::vector<Pair> impulse_;           // of the springs, in this sub-step
  std::vector<Pair> velocity_, rest_, direction_, product_, change_;
  double h_ = 0, size_ = 0, total_ = 0;  // mean length; mass of what moves
  long iterations_ = 0;
  bool started_ = false;
};

}  // namespace smokebox
