// Temperature: carried along by conservative 5th-order upwind fluxes in Wicker-Skamarock RK3 steps, flux-
// corrected (Zalesak 1979) so that it stays between the extremes of the start, the walls and what flows in;
// diffused implicitly, with the last step's diffusion inside the stages, so that a steady state is steady
// whatever the step (as Fluid does it with viscosity).
//
// Solids are insulated. Beside them, and beside walls, the order falls to third and first. A cell that is cut
// to less than half holds heat like half a cell: no small cell limits the step, and what one loses another
// gains to rounding while solids stand still. A cell that a solid uncovers takes the mean of its neighbours.
//
// The values are differences to a reference, so that a uniform temperature is exactly 0.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "base/threads.h"
#include "fluid/boundary.h"

namespace smokebox {

/// What the sides of the domain do to the temperature, by the index of the side.
struct HeatSides {
  /// By face: what a closed wall keeps, or what the fluid brings that comes in through an inflow or an open
  /// side.
  std::array<std::vector<float>, 4> value;
  std::array<bool, 4> keeps{};  // a closed wall that keeps its temperature; the others are insulated
};

class Heat {
 public:
  /// `diffuses`: a diffusivity that is not 0, now or after an event.
  Heat(const Boundary& boundary, bool diffuses, ThreadPool& pool);
  ~Heat();

  /// Sets the temperature at the cell centres, in the open cells.
  template <class Value>
  void start(const Boundary& boundary, Value&& valueAt) {
    for (int j = 0; j < boundary.grid.ny; ++j)
      for (int i = 0; i < boundary.grid.nx; ++i) values()(i, j) = valueAt(i, j);
    started(boundary);
  }
  /// Widens the bounds: the start may reach further between the centres than at them.
  void allow(double low, double high);
  void setSides(const Boundary& boundary, const HeatSides& sides);
  /// The fractions have changed.
  void boundaryChanged(const Boundary& boundary);

  struct Result {
    int subSteps = 0, iterations = 0;
    bool converged = true, finite = true;
  };
  /// Carries by the divergence-free u, v over dt, and diffuses; `diffusivity` in m^2/s.
  Result advance(const Boundary& boundary, const Field& u, const Field& v, double diffusivity, double dt);

  /// At the cell centres; of no meaning in closed cells.
  const Field& value() const;
  /// Does the cell have fluid in it?
  bool isOpen(int i, int j) const;

  std::size_t bytes() const;

 private:
  struct Impl;
  Field& values();
  void started(const Boundary& boundary);
  std::unique_ptr<Impl> impl_;
};

}  // namespace smokebox
