// What the projection does with velocities: the net flux of every cell, and the gradient that is taken off.
#pragma once
#include <vector>

#include "base/threads.h"
#include "fluid/boundary.h"
#include "fluid/multigrid_level.h"

namespace smokebox {

class PressureFlux {
 public:
  PressureFlux(const Boundary& boundary, ThreadPool& pool);

  /// Sets closed faces to the wall's velocity, and the last faces of periodic sides to the first.
  void closeFaces(const Boundary& boundary, const multigrid::Level& links, Field& u, Field& v);

  /// b = minus the net flux out of each cell (0 in cells without an open face): float64 inside, in m/s.
  struct Largest {
    double flux = 0, speed = 0;  // of any cell; |u|, |v| on open faces. A NaN anywhere gives a NaN.
  };
  Largest measure(const Boundary& boundary, const multigrid::Level& links, const Field& u, const Field& v,
                  multigrid::Floats& b);

  /// u -= grad phi on open faces. phi: on the finest level's grid, copies beyond the sides in place.
  void subtractGradient(const multigrid::Level& links, const multigrid::Floats& phi, Field& u, Field& v);

 private:
  ThreadPool& pool_;
  std::vector<Largest> rows_;
};

}  // namespace smokebox
