// A velocity with the stages that carry and project it: the smallest whole fluid step.
#pragma once
#include "fluid/advection.h"
#include "fluid/pressure.h"
#include "support/velocity_helpers.h"

namespace smokebox::test {

struct VelocityRun {
  explicit VelocityRun(const Boundary& b, int threads = 1)
      : boundary(b),
        pool(threads),
        advection(boundary, pool),
        pressure(boundary, pool),
        u(b.grid.nx, b.grid.ny),
        v(u),
        phi(u) {}

  /// Sets u and v from functions of a place.
  template <class U, class V>
  void set(U&& ofU, V&& ofV) {
    const Grid& g = boundary.grid;
    for (int j = 0; j <= g.ny; ++j)
      for (int i = 0; i <= g.nx; ++i) {
        if (j < g.ny) u(i, j) = static_cast<float>(ofU(g.xFaceCentre(i, j)));
        if (i < g.nx) v(i, j) = static_cast<float>(ofV(g.yFaceCentre(i, j)));
      }
  }

  PressureSolver::Result project(double dt = 1) {
    return pressure.project(boundary, u, v, phi, 1e-6 * boundary.grid.h / dt, 1e-6, 60);
  }

  Advection::Result carry(double dt, const Field* accelerationU = nullptr,
                          const Field* accelerationV = nullptr) {
    return advection.advance(boundary, u, v, phi, accelerationU, accelerationV, dt,
                             [&](Field& a, Field& b, int cycles, double gain) {
                               pressure.projectRoughly(boundary, a, b, cycles, &phi, gain);
                             });
  }

  Advection::Result step(double dt) {
    const Advection::Result result = carry(dt);
    project(dt);
    return result;
  }

  /// Repeats the first step to find the pressure that belongs to the velocity at the start.
  void findPressure(double dt) {
    const Field u0 = u, v0 = v;
    for (int k = 0; k < 3; ++k) {
      u = u0;
      v = v0;
      step(dt);
    }
    u = u0;
    v = v0;
  }

  /// Mean of u^2 + v^2 over the open faces.
  double energy() const {
    const Grid& g = boundary.grid;
    double sum = 0;
    for (int j = 0; j < g.ny; ++j)
      for (int i = 0; i < g.nx; ++i)
        sum += boundary.openX(i, j) * std::pow(u(i, j), 2.0) + boundary.openY(i, j) * std::pow(v(i, j), 2.0);
    return sum / static_cast<double>(g.cells());
  }

  Boundary boundary;
  ThreadPool pool;
  Advection advection;
  PressureSolver pressure;
  Field u, v, phi;
};

}  // namespace smokebox::test
