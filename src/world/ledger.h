// The ledger of what is conserved, and the forces on solids that report them. Only built into a run that
// wants figures.
#pragma once
#include <string>
#include <vector>

#include "fluid/fluid.h"
#include "world/figures.h"
#include "world/solid_scripts.h"

namespace smokebox {

struct FluidTotals {
  Vec2 momentum;             // N s per metre of depth
  double kineticEnergy = 0;  // J per metre of depth
};
/// Sums over the open faces, weighted by their open share (a face stands for one cell's area), in float64.
FluidTotals fluidTotals(const Boundary& boundary, const Fluid& fluid, double density, ThreadPool& pool);

/// The solids with `report: true` and their motion, without forces.
void listSolids(const SolidScripts& solids, std::vector<BodyFigures>& out);

/// The same with the forces of the fluid on them; `covered`: all that is on the grid, the solids first;
/// `pressure` is scratch memory.
void reportSolids(const Boundary& boundary, const Fluid& fluid, const SolidScripts& solids,
                  const std::vector<MovingSolid>& covered, double pressureScale, double dynamicViscosity,
                  Field& pressure, std::vector<BodyFigures>& out);

/// "in cell (i, j), at (x, y)" of the first velocity that is not finite; "somewhere" if there is none.
std::string whereNotFinite(const Fluid& fluid, const Grid& grid);

}  // namespace smokebox
