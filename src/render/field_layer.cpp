#include <algorithm>
#include <cmath>

#include "render/layers.h"

namespace smokebox {

namespace {
constexpr int kArm = 512;  // steps of a colour table from its middle to an end
}  // namespace

FieldLayer::FieldLayer(const Gl& gl, GlTarget& target)
    : program_(gl, "smoke.vert", "field.frag"),
      texture_(gl, GL_RGBA32F, GL_RGBA, GL_FLOAT, GL_LINEAR),
      quad_(gl, {4, 4}),
      encoded_(target) {}

bool hasField(const Snapshot& snapshot, LayerKind kind) {
  switch (kind) {
    case LayerKind::pressure:
      return !snapshot.pressure.empty();
    case LayerKind::vorticity:
      return !snapshot.vorticity.empty();
    case LayerKind::temperature:
      return !snapshot.temperature.empty();
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
  if (layer.kind == LayerKind::temperature)
    return {colorMap(ColorMapKind::temperature, dark), layer.range.value_or(snapshot.temperatureRange),
            "temperature"};
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
      const float* row = (nodes                            ? snapshot.vorticity
                          : kind == LayerKind::temperature ? snapshot.temperature
                                                           : snapshot.pressure)
                             .row(fromJ);
      eachColumn([&](int i) { return row[i]; });
    }
  }
  lattice_.origin = {first.x + window.i0 * grid.h, first.y + window.j0 * grid.h};
  lattice_.spacing = grid.h;
  smoothFor(lattice_, frame.scale, scratch_);
}

template <class Value, class Make>
void FieldLayer::color(const ColorMap& map, const std::array<double, 2>& range, std::vector<Value>& colors,
                       Make&& make) {
  std::array<Value, 2 * kArm + 1> table;
  for (int k = -kArm; k <= kArm; ++k) table[k + kArm] = make(map.at(double(k) / kArm));
  const ColorMapScale scale = colorMapScale(range, map.diverging);
  const float zero = static_cast<float>(scale.zero), above = static_cast<float>(scale.above * kArm),
              below = static_cast<float>(scale.below * kArm), lowest = map.diverging ? -float(kArm) : 0.0f;
  colors.resize(lattice_.values.size());
  for (std::size_t k = 0; k < colors.size(); ++k) {
    const float offset = lattice_.values[k] - zero;
    const float place = offset * (offset < 0 ? below : above);
    // Written so that a NaN takes the first branch, and shows as the middle.
    const float held = !(place == place) ? 0.0f : std::clamp(place, lowest, float(kArm));
    colors[k] = table[static_cast<int>(held + kArm + 0.5f)];
  }
}

void FieldLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame,
                      bool onGround) {
  gather(snapshot, layer.kind, frame);
  const FieldStyle style = fieldStyle(snapshot, layer, frame);
  const std::vector<PictureTile> domain{{frame.left, frame.top, frame.right, frame.bottom}};
  if (onGround) {
    color(style.map, style.range, finished_, [](const Color& c) {
      auto byte = [](float x) { return static_cast<std::uint32_t>(255 * std::clamp(x, 0.0f, 1.0f) + 0.5f); };
      return byte(c.r) | byte(c.g) << 8 | byte(c.b) << 16 | 0xff000000u;
    });
    encoded_.draw(encoder_.packed(linear(snapshot.view.background)), finished_, lattice_, domain, frame);
    return;
  }
  color(style.map, style.range, colors_, [](const Color& c) { return linear(c); });
  texture_.bind(0);
  texture_.upload(lattice_.nx, lattice_.ny, colors_.data());
  records_.clear();
  appendTiles(domain, lattice_, texture_, frame, records_);
  program_.use();
  program_.set("pictureSize", float(frame.width), float(frame.height));
  program_.set("lattice", 0);
  program_.set("opacity", float(layer.opacity));
  quad_.draw(records_);
}

}  // namespace smokebox
