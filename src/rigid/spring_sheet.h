// Many springs between particles (cloth). The velocities v that obey
//   M v = M v* + J^T impulses,  impulse = -(bias + hardness J v)   (spring_row.h)
// are found by conjugate gradients on M + J^T hardness J, started from the impulses of the last sub-step. All
// that is ever added is a sum of forces between two ends: momentum is kept however early it stops, and
// angular momentum as well as it converges. At rest it has nothing to do. Where it stops at its most
// iterations (very stiff cloth), a last search along what was found and along the velocities themselves sees
// to it that the energy does not grow.
//
// What is missing is known to all digits; the search for it, which only has to be 1e-3 of it near, has seven
// digits. Springs lie in memory as bands (spring_bands.h).
#pragma once
#include "rigid/spring_island.h"
#include "rigid/spring_laws.h"

namespace smokebox {

class SpringSheet {
 public:
  explicit SpringSheet(ThreadPool& pool) : pool_(&pool) {}
  /// Whether a spring is of the kind that this can do: between two bodies, at their centres or where they do
  /// not turn.
  static bool takes(const Spring& spring, const Bodies& bodies);
  /// What `before` knew of their bodies is carried on.
  void layOut(const std::vector<int>& springs, const std::vector<Spring>& all,
              const std::vector<SpringSheet>& before);
  /// sheetOf[spring] = number, for all its springs.
  void mark(std::vector<int>& sheetOf, int number) const;

  /// `changed`: a spring may be another than in the last step.
  void beginStep(const std::vector<Spring>& springs, const Bodies& bodies, double h, bool changed);
  /// `hBefore`: the length of the last sub-step.
  void warmStart(Bodies& bodies, double h, double hBefore);
  /// The largest change of a velocity, m/s.
  double solve(Bodies& bodies);
  void endStep(const Bodies& bodies);
  int count() const { return static_cast<int>(links_.size()); }

  /// N, of the last sub-step.
  double tension(int spring) const;
  std::size_t bytes() const;
  /// Conjugate gradient iterations since it was made.
  long iterations() const { return iterations_; }

 private:
  struct Link {
    int spring, a, b, slot;  // a and b: nodes, a < b
    SpringDef def;           // as of the last step
  };

  SpringRows startRows() const;
  void findRows();
  void findRowsOf(int first, int last);
  void findLooseRows();
  double residual(const Bodies& bodies, double& made);
  double conjugateGradients(double left, double enough, double scale);
  double advance(float along);
  void turn(float keep);
  void keepEnergy(const Bodies& bodies, double scale);

  ThreadPool* pool_;
  std::vector<Link> links_;  // in the order of springs
  SpringBands bands_;
  SpringLaws laws_;
  SpringMatrices matrices_;
  // By node.
  std::vector<int> body_;
  std::vector<char> fresh_;                  // nothing is known of its last sub-step
  std::vector<double> mass_, inverse_;       // 0 for what does not move
  std::vector<float> share_, inverseShare_;  // of unit_
  NodeField<double> place_, moved_;          // at the sub-step's start; within the last sub-step
  NodeField<double> impulse_;                // of the springs, in this sub-step
  NodeField<double> velocity_;               // of the warm start
  NodeField<double> pulls_;                  // bias + matrix rate of springs then, with their signs
  std::vector<NodeField<double>> beyond_;    // by part of the nodes: what its springs add to later parts
  NodeField<double> rest_;                   // impulses that are missing before the last solve
  NodeField<double> left_;                   // velocities as they were left by the last solve
  NodeField<double> made_, product_;         // for keepEnergy
  NodeField<float> missing_, direction_, step_, change_;  // of the conjugate gradients
  std::vector<double> sums_;                              // by part of the nodes
  double h_ = 0, hBefore_ = 0;                            // s
  double size_ = 0, total_ = 0, unit_ = 1;                // mean length; mass of what moves, all and the mean
  long iterations_ = 0;
  bool free_ = false;     // no node is fixed
  bool settled_ = false;  // has been solved in this sub-step
};

}  // namespace smokebox
