// What the projection does with velocities: the net flux of every cell, and the gradient that is taken off.
#pragma once
#include <vector>

#include "base/threads.h"
#include "fluid/boundary.h"
#include "fluid/multigrid.h"

namespace smokebox {

class PressureFlux {
 public:
  PressureFlux(const Boundary& boundary, ThreadPool& pool);

  /// Sets closed faces to the wall's velocity, and the last faces of periodic sides to the first.
  void closeFaces(const Boundary& boundary, const multigrid::Level& links, Field& u, Field& v);

  /// b = minus the net flux out of each cell (0 in cells without an open face): float64 inside where faces
  /// are open in part, in m/s.
  struct Largest {
    double flux = 0, speed = 0;  // of any cell; |u|, |v| on open faces. A NaN anywhere gives a NaN.
  };
  Largest measure(const Boundary& boundary, const multigrid::Level& links, const Field& u, const Field& v,
                  multigrid::Floats& b);

  /// u -= grad phi on open faces. phi: on the finest level's grid, copies beyond the sides in place. first(j)
  /// is called for each row before phi's is read (on one thread, from the lowest on), also(j) after.
  template <class First, class Also>
  void subtractGradient(const multigrid::Level& links, const multigrid::Floats& phi, Field& u, Field& v,
                        First&& first, Also&& also);

  /// Both in one pass, as far as rows go one after the other.
  template <class First, class Also>
  Largest subtractAndMeasure(const Boundary& boundary, const multigrid::Level& links,
                             const multigrid::Floats& phi, Field& u, Field& v, multigrid::Floats& b,
                             First&& first, Also&& also);

 private:
  /// The lower and left faces of row j, and those of the last sides beside it.
  static void subtractFromRow(const multigrid::Level& links, const multigrid::Floats& phi, Field& u, Field& v,
                              int j);
  void measureRow(const Boundary& boundary, const multigrid::Level& links, const Field& u, const Field& v,
                  multigrid::Floats& b, int j);
  Largest largest() const;

  ThreadPool& pool_;
  std::vector<Largest> rows_;
};

template <class First, class Also>
void PressureFlux::subtractGradient(const multigrid::Level& links, const multigrid::Floats& phi, Field& u,
                                    Field& v, First&& first, Also&& also) {
  forRows(pool_, static_cast<long>(links.nx) * links.ny, 0, links.ny, [&](int j) {
    first(j);
    subtractFromRow(links, phi, u, v, j);
    also(j);
  });
}

template <class First, class Also>
PressureFlux::Largest PressureFlux::subtractAndMeasure(const Boundary& boundary,
                                                       const multigrid::Level& links,
                                                       const multigrid::Floats& phi, Field& u, Field& v,
                                                       multigrid::Floats& b, First&& first, Also&& also) {
  if (pool_.threads() > 1) {
    subtractGradient(links, phi, u, v, first, also);
    return measure(boundary, links, u, v, b);
  }
  for (int j = 0; j <= links.ny; ++j) {
    if (j < links.ny) {
      first(j);
      subtractFromRow(links, phi, u, v, j);
      also(j);
    }
    if (j > 0) measureRow(boundary, links, u, v, b, j - 1);
  }
  return largest();
}

}  // namespace smokebox
