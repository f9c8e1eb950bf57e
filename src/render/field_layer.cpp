#include <algorithm>
#include <cmath>

#include "render/layers.h"

namespace smokebox {

namespace {
constexpr int kArm = 512;  // steps of a colour table from its middle to an end
}  // namespace

FieldLayer::FieldLayer(const Gl& gl)
    : gl_(gl),
      program_(gl, "smoke.vert", "field.frag"),
      texture_(gl, GL_RGBA32F, GL_RGBA, GL_FLOAT, GL_LINEAR),
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

void FieldLayer::gather(const Snapshot& snapshot, LayerKind kind, const PictureFrame& frame) {
  const Grid& grid = snapshot.grid;
  const bool nodes = kind == LayerKind::vorticity;
  const Vec2 first = nodes ? Vec2{} : Vec2{grid.h / 2, grid.h / 2};
  const int nx = grid.nx + nodes, ny = grid.ny + nodes;
  const LatticeWindow window = visibleWindow(frame, grid, first, nx, ny);
  lattice_.resize(window.nx(), window.ny(), 1);
  const int periodX = snapshot.periodicX ? grid.nx : 0, periodY = snapshot.periodicY ? grid.ny : 0;
  for (int j = window.j0; j < window.j1; ++j) {
    const int fromJ = wrapIndex(j, ny, periodY);
    float* out = lattice_.row(j - window.j0) - window.i0;
    auto eachColumn = [&](auto&& value) {
      for (int i = window.i0; i < window.i1; ++i) out[i] = value(wrapIndex(i, nx, periodX));
    };
    if (kind == LayerKind::speed) {
      const float *u = snapshot.velocityX.row(fromJ), *v = snapshot.velocityY.row(fromJ);
      eachColumn([&](int i) { return std::sqrt(u[i] * u[i] + v[i] * v[i]); });
    } else {
      const float* row = (nodes ? snapshot.vorticity : snapshot.pressure).row(fromJ);
      eachColumn([&](int i) { return row[i]; });
    }
  }
  lattice_.origin = {first.x + window.i0 * grid.h, first.y + window.j0 * grid.h};
  lattice_.spacing = grid.h;
  smoothFor(lattice_, frame.scale, scratch_);
}

void FieldLayer::color(const ColorMap& map, const std::array<double, 2>& range) {
  if (tableOf_ != &map) {
    tableOf_ = &map;
    table_.resize(2 * kArm + 1);
    for (int k = -kArm; k <= kArm; ++k) table_[k + kArm] = linear(map.at(double(k) / kArm));
  }
  const ColorMapScale scale = colorMapScale(range, map.diverging);
  const float zero = static_cast<float>(scale.zero), above = static_cast<float>(scale.above * kArm),
              below = static_cast<float>(scale.below * kArm), lowest = map.diverging ? -float(kArm) : 0.0f;
  colors_.resize(lattice_.values.size());
  for (std::size_t k = 0; k < colors_.size(); ++k) {
    const float offset = lattice_.values[k] - zero;
    const float place = offset * (offset < 0 ? below : above);
    // Written so that a NaN takes the first branch, and shows as the middle.
    const float held = !(place == place) ? 0.0f : std::clamp(place, lowest, float(kArm));
    colors_[k] = table_[static_cast<int>(held + kArm + 0.5f)];
  }
}

void FieldLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  const Grid& grid = snapshot.grid;
  gather(snapshot, layer.kind, frame);
  const FieldStyle style = fieldStyle(snapshot, layer, frame);
  color(style.map, style.range);
  texture_.bind(0);
  texture_.upload(lattice_.nx, lattice_.ny, colors_.data());
  program_.use();
  program_.set("pictureSize", float(frame.width), float(frame.height));
  program_.set("lattice", 0);
  program_.set("opacity", float(layer.opacity));
  auto u = [&](double x) {
    return float(((x - lattice_.origin.x) / lattice_.spacing + 0.5) / texture_.width());
  };
  auto v = [&](double y) {
    return float(((y - lattice_.origin.y) / lattice_.spacing + 0.5) / texture_.height());
  };
  if (layer.opacity >= 1) gl_.Disable(GL_BLEND);
  quad_.draw({float(frame.left), float(frame.top), float(frame.right), float(frame.bottom), u(0),
              v(grid.height()), u(grid.width()), v(0)});
  gl_.Enable(GL_BLEND);
}

}  // namespace smokebox
