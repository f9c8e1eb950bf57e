#include <algorithm>

#include "render/layers.h"

namespace smokebox {

namespace {
constexpr double kOutlineUnits = 2.0;   // width of the outline, in 1/720 of the picture's height
constexpr double kThinnestUnits = 2.2;  // thinner solids are widened to this, or they would fade away

struct SolidColors {
  Color fill, outline;
};

SolidColors colorsOf(const SolidPicture& solid, bool darkGround) {
  if (solid.color) {
    const Color toward = darkGround ? Color{1, 1, 1} : Color{0, 0, 0};
    return {*solid.color, mixed(*solid.color, toward, 0.4)};
  }
  if (darkGround) return {{0.255f, 0.290f, 0.345f}, {0.700f, 0.745f, 0.810f}};
  return {{0.420f, 0.455f, 0.505f}, {0.120f, 0.140f, 0.175f}};
}
}  // namespace

SolidsLayer::SolidsLayer(Palette& palette) : palette_(palette), painter_(palette.width, palette.height) {}

void SolidsLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  if (kept_.size() < snapshot.solids.size()) kept_.resize(snapshot.solids.size());
  for (std::size_t k = 0; k < snapshot.solids.size(); ++k) {
    const SolidPicture& solid = snapshot.solids[k];
    pixels_.resize(solid.outlines.size());
    for (std::size_t m = 0; m < pixels_.size(); ++m) {
      pixels_[m].clear();
      for (const Vec2& point : solid.outlines[m]) pixels_[m].push_back(frame.toPixels(point));
    }
    Kept& kept = kept_[k];
    if (kept.outlines != pixels_) {
      kept.mask =
          painter_.solid(pixels_, frame.line(kOutlineUnits), std::max(1.6, kThinnestUnits * frame.unit));
      std::swap(kept.outlines, pixels_);
    }
    const SolidColors colors = colorsOf(solid, frame.darkGround);
    palette_.sprites.add(kept.mask, linear(colors.fill, layer.opacity),
                         linear(colors.outline, layer.opacity));
  }
  palette_.sprites.flush();
}

}  // namespace smokebox
