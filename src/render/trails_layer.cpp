#include <cmath>

#include "render/body_layers.h"
#include "render/link_shapes.h"

namespace smokebox {

namespace {
constexpr double kWidthUnits = 4.0;  // where the thing is now, in 1/720 of the picture's height
constexpr double kStrongest = 0.85;  // opacity there
constexpr double kFades = 1.4;       // power of the share of its time that it has left
constexpr double kStep2 = 2.25;      // squared pixels between points: less would not show
}  // namespace

void TrailsLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  const double width = kWidthUnits * frame.unit;
  for (const TrailPicture& trail : snapshot.trails) {
    const Color color = trail.color ? *trail.color : layer.color.value_or(bodyColor(trail.index));
    const auto finish = [&] {
      palette_.strokes.add(points_, looks_);
      points_.clear();
      looks_.clear();
    };
    points_.clear();
    looks_.clear();
    const std::size_t count = trail.points.size();
    for (std::size_t k = 0; k < count; ++k) {
      const Vec2 point = frame.toPixels(trail.points[k]);
      if (!std::isfinite(point.x) || !std::isfinite(point.y)) {  // wrapped around
        finish();
        continue;
      }
      const bool near = !points_.empty() && dot(point - points_.back(), point - points_.back()) < kStep2;
      if (near && k + 1 < count) continue;
      const double young = static_cast<double>(k + 1) / static_cast<double>(count);
      points_.push_back(point);
      looks_.push_back({width * young, linear(color, kStrongest * std::pow(young, kFades) * layer.opacity)});
    }
    finish();
  }
  palette_.strokes.flush();
}

}  // namespace smokebox
