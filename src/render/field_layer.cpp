#include <algorithm>
#include <cmath>

#include "render/layers.h"

namespace smokebox {

FieldLayer::FieldLayer(const Gl& gl)
    : program_(gl, "smoke.vert", "field.frag"),
      texture_(gl, GL_R32F, GL_RED, GL_FLOAT, GL_LINEAR),
      quad_(gl, {4, 4}) {}

bool hasField(const Snapshot& snapshot, LayerKind kind) {
  switch (kind) {
    case LayerKind::pressure:
      return !snapshot.pressure.empty();
    case LayerKind::vorticity:
      return !snapshot.vorticity.empty();
    case LayerKind::speed:
      return !snapshot.velocityX.empty() && !snapshot.velocityY.empty();
    default:
      return false;
  }
}

FieldStyle fieldStyle(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  const bool dark = frame.darkGround;
  if (layer.kind == LayerKind::pressure)
    return {colorMap(ColorMapKind::pressure, dark), layer.range.value_or(snapshot.pressureRange),
            "pressure (Pa)"};
  if (layer.kind == LayerKind::vorticity)
    return {colorMap(ColorMapKind::vorticity, dark), layer.range.value_or(snapshot.vorticityRange),
            "vorticity (1/s)"};
  return {colorMap(ColorMapKind::speed, dark), layer.range.value_or(snapshot.speedRange), "speed (m/s)"};
}

void setColorMap(const GlProgram& program, const ColorMap& map, const std::array<double, 2>& range) {
  static_assert(sizeof(Color) == 3 * sizeof(float));
  const ColorMapScale scale = colorMapScale(range, map.diverging);
  program.setVec3s("positiveArm[0]", &map.positive[0].r, ColorMap::kTerms);
  program.setVec3s("negativeArm[0]", &map.negative[0].r, ColorMap::kTerms);
  // A sequential map has one arm: what lies below its start is held there.
  program.set("scale", {float(scale.zero), float(scale.above), float(scale.below), 0});
}

void FieldLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  const Grid& grid = snapshot.grid;
  const bool nodes = layer.kind == LayerKind::vorticity;
  const Vec2 first = nodes ? Vec2{} : Vec2{grid.h / 2, grid.h / 2};
  const int nx = grid.nx + nodes, ny = grid.ny + nodes;
  const LatticeWindow window = visibleWindow(frame, grid, first, nx, ny);
  lattice_.resize(window.nx(), window.ny(), 1);
  const int periodX = snapshot.periodicX ? grid.nx : 0, periodY = snapshot.periodicY ? grid.ny : 0;
  for (int j = window.j0; j < window.j1; ++j) {
    const int fromJ = wrapIndex(j, ny, periodY);
    float* out = lattice_.row(j - window.j0);
    for (int i = window.i0; i < window.i1; ++i) {
      const int fromI = wrapIndex(i, nx, periodX);
      float value;
      if (layer.kind == LayerKind::pressure) {
        value = snapshot.pressure(fromI, fromJ);
      } else if (nodes) {
        value = snapshot.vorticity(fromI, fromJ);
      } else {
        const float u = snapshot.velocityX(fromI, fromJ), v = snapshot.velocityY(fromI, fromJ);
        value = std::sqrt(u * u + v * v);
      }
      out[i - window.i0] = value;
    }
  }
  lattice_.origin = {first.x + window.i0 * grid.h, first.y + window.j0 * grid.h};
  lattice_.spacing = grid.h;
  smoothFor(lattice_, frame.scale, scratch_);
  texture_.bind(0);
  texture_.upload(lattice_.nx, lattice_.ny, lattice_.values.data());

  const FieldStyle style = fieldStyle(snapshot, layer, frame);
  program_.use();
  program_.set("pictureSize", float(frame.width), float(frame.height));
  program_.set("lattice", 0);
  program_.set("opacity", float(layer.opacity));
  setColorMap(program_, style.map, style.range);
  auto u = [&](double x) {
    return float(((x - lattice_.origin.x) / lattice_.spacing + 0.5) / texture_.width());
  };
  auto v = [&](double y) {
    return float(((y - lattice_.origin.y) / lattice_.spacing + 0.5) / texture_.height());
  };
  quad_.draw({float(frame.left), float(frame.top), float(frame.right), float(frame.bottom), u(0),
              v(grid.height()), u(grid.width()), v(0)});
}

}  // namespace smokebox
