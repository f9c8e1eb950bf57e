// Makes the velocity divergence-free: the projection, by conjugate gradients preconditioned with multigrid.
//
// Finds phi such that, for each cell,  sum over its faces of  open (u - grad phi) + (1 - open) wall = 0 ,
// where grad phi on an x-face is phi(i, j) - phi(i-1, j), and phi = 0 beyond an open side. phi is in m/s: the
// pressure is rho h phi / dt. (Ng, Min and Gibou 2009; preconditioner: McAdams 2010, with coarse cells split
// along solids after Dick, Rogowsky and Westermann 2016.)
#pragma once
#include <memory>

#include "base/threads.h"
#include "fluid/boundary.h"

namespace smokebox {

class PressureSolver {
 public:
  struct Result {
    int iterations = 0;
    double divergence = 0;   // as section 3 of the design defines it, measured on the velocity that comes out
    double compression = 0;  // largest |rate| (1/s) that was spread over a sealed region, see the design
    bool converged = false;
  };

  PressureSolver(const Boundary& boundary, ThreadPool& pool);
  ~PressureSolver();

  /// Rebuilds the hierarchy; needed when boundary.version has changed.
  void rebuild(const Boundary& boundary);

  /// u, v: velocity in, divergence-free velocity out (closed faces are set to the wall's velocity). phi: the
  /// increment that was subtracted is ADDED to it. The divergence is measured against max(largest |u|,|v| on
  /// open faces, `smallestSpeed`); section 3: 1e-6 h / step. Stops at `tolerance` or after `maxIterations`.
  Result project(const Boundary& boundary, Field& u, Field& v, Field& phi, double smallestSpeed,
                 double tolerance, int maxIterations);

  /// project() starts from the increment that it found the last time, which a smooth flow nearly repeats. Not
  /// so after this, nor after rebuild().
  void forget();

  /// A rough projection for the middle of a step: `cycles` iterations, or a bare multigrid cycle for 0, which
  /// costs two thirds of one; nothing measured. `gain` times the increment that was subtracted is added to
  /// `phi`, unless that is null.
  void projectRoughly(const Boundary& boundary, Field& u, Field& v, int cycles, Field* phi = nullptr,
                      double gain = 1);

  std::size_t bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace smokebox
