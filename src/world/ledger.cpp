#include "world/ledger.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "base/maths.h"

namespace smokebox {

namespace {

// Sums go over eight fixed lanes, so that they do not depend on the instruction set. Vectors wider than the
// machine's stay inside this file.
#pragma GCC diagnostic ignored "-Wpsabi"
constexpr int kLanes = 8;
typedef double Lanes __attribute__((vector_size(kLanes * sizeof(double))));
typedef float Floats __attribute__((vector_size(kLanes * sizeof(float)), aligned(4), may_alias));

/// Of open q and of open q^2.
struct Sums {
  double first = 0, second = 0;
  void add(const Sums& other, double share) {
    first += share * other.first;
    second += share * other.second;
  }
};

Sums sumsOf(float open, float q) {
  const double weighted = static_cast<double>(open) * q;
  return {weighted, weighted * q};
}

Sums sumsOfRow(const float* open, const float* q, int count) {
  Lanes first = {}, second = {};
  int i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    const Lanes value = __builtin_convertvector(*reinterpret_cast<const Floats*>(q + i), Lanes);
    const Lanes weighted = __builtin_convertvector(*reinterpret_cast<const Floats*>(open + i), Lanes) * value;
    first += weighted;
    second += weighted * value;
  }
  Sums sums;
  for (int k = 0; k < kLanes; ++k) sums.add({first[k], second[k]}, 1);
  for (; i < count; ++i) sums.add(sumsOf(open[i], q[i]), 1);
  return sums;
}

/// Over all faces of one component. A face on the rim stands for half a cell; a periodic one is counted once,
/// on its first side.
Sums sumsOfFaces(const Field& q, const Field& open, int columns, int rows, bool alongX, ThreadPool& pool) {
  constexpr int kBlocks = 64;
  std::array<Sums, kBlocks> blocks;
  const int grain = (rows + kBlocks - 1) / kBlocks;
  pool.blocks(0, rows, grain, [&](int begin, int end) {
    Sums& block = blocks[begin / grain];
    for (int j = begin; j < end; ++j) {
      const float *o = open.row(j), *f = q.row(j);
      block.add(sumsOfRow(o, f, columns), !alongX && (j == 0 || j == rows - 1) ? 0.5 : 1);
      if (alongX)
        for (const int i : {0, columns - 1}) block.add(sumsOf(o[i], f[i]), -0.5);
    }
  });
  Sums sums;
  for (const Sums& block : blocks) sums.add(block, 1);
  return sums;
}

}  // namespace

FluidTotals fluidTotals(const Boundary& boundary, const Fluid& fluid, double density, ThreadPool& pool) {
  const Grid& grid = boundary.grid;
  const double mass = density * grid.h * grid.h;
  const Sums u = sumsOfFaces(fluid.u(), boundary.openX, grid.nx + 1, grid.ny, true, pool),
             v = sumsOfFaces(fluid.v(), boundary.openY, grid.nx, grid.ny + 1, false, pool);
  FluidTotals totals;
  totals.momentum = {mass * u.first, mass * v.first};
  totals.kineticEnergy = 0.5 * mass * (u.second + v.second);
  return totals;
}

void listSolids(const SolidScripts& solids, std::vector<BodyFigures>& out) {
  for (int k = 0; k < solids.count(); ++k) {
    if (!solids.spec(k).report) continue;
    const Vec2 centre = transformed(solids.mass(k).centre, solids.pose(k));
    const MovingSolid& moving = solids.moving()[k];
    BodyFigures body;
    body.name = solids.spec(k).name;
    body.position = centre;
    body.angleDegrees = degrees(solids.pose(k).angleRad);
    body.velocity = moving.velocityAt(centre);
    body.spinDegrees = degrees(moving.spin);
    out.push_back(body);
  }
}

void reportSolids(const Boundary& boundary, const Fluid& fluid, const SolidScripts& solids,
                  const std::vector<MovingSolid>& covered, double pressureScale, double dynamicViscosity,
                  Field& pressure, std::vector<BodyFigures>& out) {
  const Grid& grid = boundary.grid;
  if (pressure.empty()) pressure = Field(grid.nx, grid.ny);
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) pressure(i, j) = static_cast<float>(pressureScale * fluid.phi()(i, j));
  const std::vector<SurfaceForce> forces =
      surfaceForces(boundary, covered, pressure, fluid.shear(), dynamicViscosity);
  const std::size_t first = out.size();
  listSolids(solids, out);
  auto body = out.begin() + static_cast<std::ptrdiff_t>(first);
  for (int k = 0; k < solids.count(); ++k) {
    if (!solids.spec(k).report) continue;
    body->force = forces[k].force;
    // About the centre of mass instead of the origin.
    body->torque = forces[k].torque - cross(body->position - solids.moving()[k].origin, forces[k].force);
    ++body;
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
