// World::capture: copies what the layers of the view need, extended into solids so that it can be
// interpolated smoothly right up to their edges.
#include <algorithm>

#include "world/world.h"

namespace smokebox {

namespace {

bool hasOpenFace(const Boundary& boundary, int i, int j) {
  return boundary.openX(i, j) > 0 || boundary.openX(i + 1, j) > 0 || boundary.openY(i, j) > 0 ||
         boundary.openY(i, j + 1) > 0;
}

// Fills the cells without a value, layer by layer, with the mean of the neighbours that have one.
void extendIntoSolids(const Grid& grid, Field& value, std::vector<unsigned char>& known) {
  constexpr int kLayers = 4;
  const int nx = grid.nx, ny = grid.ny;
  auto at = [&](int i, int j) -> unsigned char& { return known[static_cast<std::size_t>(j) * nx + i]; };
  std::vector<std::pair<int, int>> unknown, next, filled;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      if (!at(i, j)) unknown.emplace_back(i, j);
  for (int layer = 0; layer < kLayers && !unknown.empty(); ++layer) {
    filled.clear();
    next.clear();
    for (const auto& [i, j] : unknown) {
      float sum = 0;
      int count = 0;
      for (int dj = -1; dj <= 1; ++dj)
        for (int di = -1; di <= 1; ++di) {
          const int p = i + di, q = j + dj;
          if (p < 0 || q < 0 || p >= nx || q >= ny || !at(p, q)) continue;
          sum += value(p, q);
          ++count;
        }
      if (count == 0) {
        next.emplace_back(i, j);
        continue;
      }
      value(i, j) = sum / static_cast<float>(count);
      filled.emplace_back(i, j);
    }
    for (const auto& [i, j] : filled) at(i, j) = 1;
    unknown.swap(next);
  }
}

void ensure(Field& field, const Grid& grid) {
  if (field.nx() != grid.nx || field.ny() != grid.ny) field = Field(grid.nx, grid.ny);
}

}  // namespace

void World::capture(Snapshot& snapshot) const {
  const Grid& grid = boundary_.grid;
  snapshot.time = time();
  snapshot.step = stepCount_;
  snapshot.grid = grid;
  snapshot.view = spec_.view;
  std::erase_if(snapshot.view.layers, [](const LayerSpec& layer) { return !layer.shown; });
  snapshot.periodicX = boundary_.periodicX();
  snapshot.periodicY = boundary_.periodicY();

  if (fluid_) snapshot.open = boundary_.volume;
  if (smoke_ && snapshot.shows(LayerKind::smoke)) {
    snapshot.smoke.resize(smoke_->colors().size());
    for (std::size_t c = 0; c < snapshot.smoke.size(); ++c) {
      snapshot.smoke[c].color = smoke_->colors()[c];
      snapshot.smoke[c].value = smoke_->smoke().value(static_cast<int>(c));
    }
  } else {
    snapshot.smoke.clear();
  }

  auto wants = [&](LayerKind kind) { return fluid_ && snapshot.shows(kind); };
  if (wants(LayerKind::pressure)) capturePressure(snapshot.pressure);
  if (heat_ && wants(LayerKind::temperature)) captureTemperature(snapshot.temperature);
  if (wants(LayerKind::vorticity) || wants(LayerKind::speed) || wants(LayerKind::velocity))
    captureVelocity(wants(LayerKind::vorticity), snapshot);

  snapshot.solids.clear();
  for (int k = 0; k < solids_.count(); ++k)
    if (solids_.shown(k))
      snapshot.solids.push_back(
          {solids_.spec(k).name, k, solids_.moving()[k].outlines, solids_.pose(k), solids_.spec(k).color});
  // What sticks out of a periodic side comes in again on the other.
  for (int k = 0; k < solids_.count(); ++k) {
    if (!solids_.shown(k)) continue;
    for (const Vec2 shift : SolidsOnGrid::imagesOf(solids_.moving()[k], boundary_)) {
      if (shift == Vec2{}) continue;
      std::vector<Outline> outlines = solids_.moving()[k].outlines;
      for (Outline& outline : outlines)
        for (Vec2& point : outline) point = point + shift;
      snapshot.solids.push_back(
          {solids_.spec(k).name, k, std::move(outlines), solids_.pose(k), solids_.spec(k).color});
    }
  }
  if (rigid_) rigid_->capture(time(), snapshot);
  const std::string& follow = spec_.view.camera.follow;
  snapshot.followed.reset();
  if (const auto at = follow.empty() || !rigid_ ? std::nullopt : rigid_->carried(follow))
    snapshot.followed = at->now.position;
  probes_.capture([this](const std::string& name) { return carried(name); }, snapshot.probes);

  snapshot.captions.clear();
  for (const CaptionSpec& caption : spec_.view.captions)
    if (time() >= caption.from && time() < caption.until) snapshot.captions.push_back(caption.text);
  for (const ActiveCaption& caption : captions_) snapshot.captions.push_back(caption.text);
}

void World::capturePressure(Field& pressure) const {
  const Grid& grid = boundary_.grid;
  ensure(pressure, grid);
  const double scale = spec_.fluid.density * grid.h / spec_.time.step;
  std::vector<unsigned char> known(grid.cells());
  // Without an open side the pressure is known but for a constant: its mean over the open cells is shown as
  // 0.
  const bool anyOpen = std::any_of(boundary_.sides.begin(), boundary_.sides.end(),
                                   [](const SideFlow& side) { return side.kind == WallKind::open; });
  double sum = 0;
  long count = 0;
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      const bool open = boundary_.volume(i, j) > 0 && hasOpenFace(boundary_, i, j);
      known[static_cast<std::size_t>(j) * grid.nx + i] = open;
      if (!open) continue;
      sum += fluid_->phi()(i, j);
      ++count;
    }
  const double zero = anyOpen || count == 0 ? 0 : sum / count;
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i)
      pressure(i, j) = static_cast<float>(scale * (fluid_->phi()(i, j) - zero));
  extendIntoSolids(grid, pressure, known);
}

void World::captureTemperature(Field& temperature) const {
  const Grid& grid = boundary_.grid;
  ensure(temperature, grid);
  std::vector<unsigned char> known(grid.cells());
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      known[static_cast<std::size_t>(j) * grid.nx + i] = heat_->isOpen(i, j);
      temperature(i, j) = static_cast<float>(heat_->at(i, j));
    }
  extendIntoSolids(grid, temperature, known);
}

void World::captureVelocity(bool vorticity, Snapshot& snapshot) const {
  const Grid& grid = boundary_.grid;
  Fluid::ExtendedVelocity extended = fluid_->extended(boundary_);
  if (vorticity) {
    ensure(snapshot.vorticity, grid);
    vorticityAtNodes(boundary_, extended.u, extended.v, pool_, snapshot.vorticity);
  }
  ensure(snapshot.velocityX, grid);
  ensure(snapshot.velocityY, grid);
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      snapshot.velocityX(i, j) = 0.5f * (extended.u(i, j) + extended.u(i + 1, j));
      snapshot.velocityY(i, j) = 0.5f * (extended.v(i, j) + extended.v(i, j + 1));
    }
}

}  // namespace smokebox
