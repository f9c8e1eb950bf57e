// Many springs between particles (cloth). The velocities v that obey
//   M v = M v* + J^T impulses,  impulse = -(bias + hardness J v)   (spring_row.h)
// are found by conjugate gradients on M + J^T hardness J, started from the impulses of the last sub-step. All
// that is ever added is a sum of forces between two ends: momentum is kept however early it stops, and
// angular momentum as well as it converges. At rest it has nothing to do. Where it stops at its most
// iterations (very stiff cloth), a last search along what was found and along the velocities themselves sees
// to it that the energy does not grow.
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
  /// What `before` knew of their bodies is carried on.
  void layOut(const std::vector<int>& springs, const std::vector<Spring>& all,
              const std::vector<SpringSheet>& before);
  /// sheetOf[spring] = number, for all its springs.
  void mark(std::vector<int>& sheetOf, int number) const;

  void beginStep(const std::vector<Spring>& springs, const Bodies& bodies, double h);
  /// `hBefore`: the length of the last sub-step.
  void warmStart(Bodies& bodies, double h, double hBefore);
  /// The largest change of a velocity, m/s.
  double solve(Bodies& bodies);
  void endStep(const Bodies& bodies, double h);

  /// N, of the last sub-step.
  double tension(int spring) const;
  std::size_t bytes() const;
  /// Conjugate gradient iterations since it was made.
  long iterations() const { return iterations_; }

 private:
  typedef double Pair __attribute__((vector_size(16)));
  struct Link {
    int spring, a, b;  // a and b: nodes
    double stiffness, damping, inverseA, inverseB, tension;
  };
  // A symmetric matrix in three numbers: xx, xy, yy.
  struct Matrix {
    double xx, xy, yy;
  };

  void prepare(int slot, const SpringDef& def, const Bodies& bodies, double h);
  void findForces(int begin, int end, double h, double perSecond);
  void stiffenAcross(int slot, double h, double perSecond);
  Pair force(int slot, Pair rate) const;
  double multiply(const std::vector<Pair>& p, std::vector<Pair>& out) const;
  void keepEnergy();

  std::vector<Link> links_;       // in the order of their nodes a
  std::vector<int> nodeStart_;    // by node: the first link of which it is a; one more at the end
  std::vector<int> start_, end_;  // a and b again, close together
  // Impulse on b = -(bias + matrix (vb - va)), by link; and what it is made of: bias = perStretch C + perRate
  // u0, hardness, and (w h)^2.
  std::vector<Matrix> matrix_;
  std::vector<Pair> bias_;
  std::vector<double> length_, perStretch_, perRate_, hardness_, squared_;
  std::vector<std::array<int, 2>> slotOf_;  // spring and its slot, in the order of springs
  // By node.
  std::vector<int> body_;
  std::vector<char> fresh_;             // nothing is known of its last sub-step
  std::vector<double> mass_, inverse_;  // 0 for what does not move
  std::vector<Pair> place_, moved_;     // at the sub-step's start; within the last sub-step
  std::vector<Pair> impulse_;           // of the springs, in this sub-step
  std::vector<Pair> biases_;            // that of its springs, with their signs
  std::vector<Pair> velocity_, rest_, direction_, product_, change_;
  double h_ = 0, size_ = 0, total_ = 0;  // mean length; mass of what moves
  long iterations_ = 0;
  bool free_ = false;  // no node is fixed
};

}  // namespace smokebox
