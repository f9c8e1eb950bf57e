// The figures of a run: of each step, of the whole, and the fingerprint of the state.
#include <algorithm>
#include <cstdio>

#include "base/hash.h"
#include "world/ledger.h"
#include "world/world.h"

namespace smokebox {

void World::recordFigures() {
  const double pressureScale = spec_.fluid.density * boundary_.grid.h / spec_.time.step;
  figures_.bodies.clear();
  if (!fluid_ && needs_.reports) listSolids(solids_, figures_.bodies);
  if (fluid_) {
    const FluidTotals totals = fluidTotals(boundary_, *fluid_, spec_.fluid.density, pool_);
    figures_.momentum = totals.momentum;
    figures_.energyFluid = totals.kineticEnergy;
    if (needs_.reports)
      reportSolids(boundary_, *fluid_, solids_, covered(), pressureScale,
                   spec_.fluid.density * spec_.fluid.viscosity, pressure_, figures_.bodies);
  }
  if (!fluid_) figures_.momentum = {};
  if (rigid_) rigid_->record(figures_);
  overlapMax_ = std::max(overlapMax_, figures_.overlap);
  if (smoke_) {
    const Smoke::Totals totals = smoke_->smoke().totals();
    figures_.smoke = {totals.mass, totals.emitted, totals.left, totals.min, totals.max};
  }
  if (!probes_.empty())
    probes_.read(
        boundary_, fluid(), smoke_ ? &smoke_->smoke() : nullptr, heat(), pressureScale,
        [this](const std::string& name) { return carried(name); }, figures_.probes);
}

SummaryFigures World::summary() const {
  SummaryFigures summary;
  summary.steps = stepCount_;
  summary.cells = boundary_.grid.cells();
  summary.threads = options_.threads;
  if (!stepMs_.empty()) {
    std::vector<float> sorted = stepMs_;
    std::nth_element(sorted.begin(), sorted.begin() + sorted.size() / 2, sorted.end());
    summary.stepMsMedian = sorted[sorted.size() / 2];
  }
  summary.divergenceMax = divergenceMax_;
  summary.overlapMax = overlapMax_;
  if (smoke_) {
    const Smoke::Totals totals = smoke_->smoke().totals();
    if (totals.emitted > 0)
      summary.smokeError = (totals.mass - (totals.emitted - totals.left)) / totals.emitted;
  }
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(stateHash()));
  summary.stateHash = text;
  return summary;
}

std::uint64_t World::stateHash() const {
  Fnv1a hash;
  const Grid& grid = boundary_.grid;
  auto add = [&](const Field& field, int columns, int rows) {
    for (int j = 0; j < rows; ++j) hash.update(field.row(j), columns * sizeof(float));
  };
  hash.update(&stepCount_, sizeof stepCount_);
  if (fluid_) {
    add(fluid_->u(), grid.nx + 1, grid.ny);
    add(fluid_->v(), grid.nx, grid.ny + 1);
    add(fluid_->phi(), grid.nx, grid.ny);
  }
  if (smoke_)
    for (int c = 0; c < smoke_->smoke().channels(); ++c) add(smoke_->smoke().value(c), grid.nx, grid.ny);
  if (heat_) add(heat_->heat().value(), grid.nx, grid.ny);
  for (int k = 0; k < solids_.count(); ++k) hash.update(&solids_.pose(k), sizeof(Pose));
  if (rigid_) rigid_->hashInto(hash);
  return hash.value();
}

std::size_t World::bytes() const {
  std::size_t bytes = 0;
  if (fluid_)
    bytes += fluid_->bytes() + boundary_.openX.bytes() + boundary_.openY.bytes() + boundary_.volume.bytes() +
             boundary_.wallU.bytes() + boundary_.wallV.bytes();
  if (smoke_) bytes += smoke_->bytes();
  if (heat_) bytes += heat_->bytes();
  if (rigid_) bytes += rigid_->bytes();
  return bytes;
}

}  // namespace smokebox
