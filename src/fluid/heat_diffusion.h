// The implicit diffusion of the temperature: capacity (T - before) = c (links to the open neighbours, and to
// walls that keep their temperature), c = diffusivity dt / h^2, by Chebyshev's iteration as in viscosity.h.
// Second order at the walls: what the link of half a cell lacks is taken from the start of the step and
// added to the right side.
#pragma once
#include "base/threads.h"
#include "fluid/boundary.h"
#include "fluid/heat.h"

namespace smokebox {

class HeatDiffusion {
 public:
  HeatDiffusion(const Boundary& boundary, ThreadPool& pool);

  /// `perCapacity`: one over what the cells hold, 0 in closed ones.
  void rebuild(const Boundary& boundary, const HeatSides& sides, const Field& perCapacity);

  /// Takes what the links to walls lack, of the second derivative, from the state `t`.
  void bendAtWalls(const HeatSides& sides, const Field& t);

  struct Result {
    int iterations = 0;
    bool converged = true;
  };
  /// `before`: without any diffusion in this step; x: the best guess in, the new values out, between
  /// `lowest` and `highest` as `before` is.
  Result solve(const HeatSides& sides, const Field& before, double c, float lowest, float highest, Field& x);

  std::size_t bytes() const;

 private:
  void findInverse(float c);
  void findRightSide(const HeatSides& sides, const Field& before, float c, float lowest, float highest);
  void wrap(Field& f) const;

  ThreadPool& pool_;
  int nx_, ny_;
  bool wrapX_, wrapY_;
  Field linkX_, linkY_;    // weights of the links through the faces: their open share, 0 on closed sides
  Field wall_;             // sum of the weights of links to walls
  Field capacity_;         // 1 in closed cells
  Field inverse_, right_;  // one over the diagonal; right side
  Field next_;
  std::array<std::vector<float>, 4> bend_;  // by side and cell
  double mostLinks_ = 0;                    // largest sum of a cell's links, over its capacity
  float inverseOf_ = -1;                    // the c that inverse_ is for
};

}  // namespace smokebox
