#include "world/ledger.h"

#include <cmath>
#include <cstdio>

#include "base/maths.h"

namespace smokebox {

FluidTotals fluidTotals(const Boundary& boundary, const Fluid& fluid, double density, ThreadPool& pool) {
  const Grid& grid = boundary.grid;
  constexpr int kRows = 16;
  // A face on the rim stands for half a cell; a periodic one is counted once, on its first side.
  auto sum = [&](const Field& q, const Field& open, int columns, int rows, bool alongX, int power) {
    return pool.sum(0, rows, kRows, [&](int begin, int end) {
      double total = 0;
      for (int j = begin; j < end; ++j)
        for (int i = 0; i < columns; ++i) {
          const int k = alongX ? i : j, n = alongX ? columns : rows;
          const double share = k == 0 || k == n - 1 ? 0.5 : 1;
          const double value = q(i, j);
          total += share * open(i, j) * (power == 1 ? value : value * value);
        }
      return total;
    });
  };
  const double mass = density * grid.h * grid.h;
  FluidTotals totals;
  totals.momentum.x = mass * sum(fluid.u(), boundary.openX, grid.nx + 1, grid.ny, true, 1);
  totals.momentum.y = mass * sum(fluid.v(), boundary.openY, grid.nx, grid.ny + 1, false, 1);
  totals.kineticEnergy = 0.5 * mass *
                         (sum(fluid.u(), boundary.openX, grid.nx + 1, grid.ny, true, 2) +
                          sum(fluid.v(), boundary.openY, grid.nx, grid.ny + 1, false, 2));
  return totals;
}

void reportSolids(const Boundary& boundary, const Fluid& fluid, const SolidScripts& solids,
                  double pressureScale, double dynamicViscosity, Field& pressure,
                  std::vector<BodyFigures>& out) {
  const Grid& grid = boundary.grid;
  if (pressure.empty()) pressure = Field(grid.nx, grid.ny);
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) pressure(i, j) = static_cast<float>(pressureScale * fluid.phi()(i, j));
  const std::vector<SurfaceForce> forces =
      surfaceForces(boundary, solids.moving(), pressure, fluid.u(), fluid.v(), dynamicViscosity);
  for (int k = 0; k < solids.count(); ++k) {
    if (!solids.spec(k).report) continue;
    const MovingSolid& moving = solids.moving()[k];
    const Vec2 centre = transformed(solids.mass(k).centre, solids.pose(k));
    BodyFigures body;
    body.name = solids.spec(k).name;
    body.position = centre;
    body.angleDegrees = degrees(solids.pose(k).angleRad);
    body.velocity = moving.velocityAt(centre);
    body.spinDegrees = degrees(moving.spin);
    body.force = forces[k].force;
    // About the centre of mass instead of the origin.
    body.torque = forces[k].torque - cross(centre - moving.origin, forces[k].force);
    out.push_back(body);
  }
}

std::string whereNotFinite(const Fluid& fluid, const Grid& grid) {
  for (int j = 0; j <= grid.ny; ++j)
    for (int i = 0; i <= grid.nx; ++i)
      if (!std::isfinite(fluid.u()(i, j)) || !std::isfinite(fluid.v()(i, j))) {
        char text[96];
        std::snprintf(text, sizeof text, "in cell (%d, %d), at (%.4g, %.4g)", i, j, (i + 0.5) * grid.h,
                      (j + 0.5) * grid.h);
        return text;
      }
  return "somewhere";
}

}  // namespace smokebox
