#include <algorithm>
#include <cmath>

#include "render/body_layers.h"
#include "render/cloth_lines.h"
#include "render/link_shapes.h"

namespace smokebox {

namespace {
// Line widths in 1/720 of the picture's height.
constexpr double kHemUnits = 2.0, kWeaveUnits = 0.9, kLooseUnits = 1.3;
constexpr double kWeavePixels = 11;  // between lines of the weave, at least
constexpr double kWeaveOpacity = 0.22;
constexpr double kBright = 0.45, kDark = 0.6;  // shares of white and black in the brightest and darkest cloth

Color shaded(const Color& color, float light) {
  return light > 0 ? mixed(color, {1, 1, 1}, kBright * light) : mixed(color, {0, 0, 0}, -kDark * light);
}
}  // namespace

void ClothLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  for (const ClothPicture& cloth : snapshot.cloths) {
    const Color color = cloth.color ? *cloth.color : layer.color.value_or(bodyColor(cloth.index));
    pixels_.clear();
    for (const Vec2& position : cloth.positions) pixels_.push_back(frame.toPixels(position));
    drawCells(cloth, color, layer.opacity);
    drawLines(cloth, color, layer.opacity, frame);
  }
}

void ClothLayer::drawCells(const ClothPicture& cloth, const Color& color, double opacity) {
  const std::vector<float> light = shadingOf(cloth);
  std::vector<LinearColor> colors;
  for (const float value : light) colors.push_back(linear(shaded(color, value), opacity));
  records_.clear();
  for (int j = 0; j + 1 < cloth.rows; ++j)
    for (int i = 0; i + 1 < cloth.columns; ++i) {
      if (!cloth.whole[static_cast<std::size_t>(j) * (cloth.columns - 1) + i]) continue;
      const int corner = j * cloth.columns + i;
      const int nodes[] = {corner, corner + 1, corner + cloth.columns, corner + cloth.columns + 1};
      for (const int node : nodes)
        records_.insert(records_.end(), {float(pixels_[node].x), float(pixels_[node].y)});
      for (const int node : nodes) records_.insert(records_.end(), colors[node].begin(), colors[node].end());
    }
  if (records_.empty()) return;
  if (!program_) {
    program_.emplace(palette_.gl, "mesh.vert", "mesh.frag");
    instances_.emplace(palette_.gl, std::vector<int>{4, 4, 4, 4, 4, 4});
  }
  program_->use();
  program_->set("pictureSize", float(palette_.width), float(palette_.height));
  instances_->draw(records_);
}

/// The hem also smooths the edges of the cells.
void ClothLayer::drawLines(const ClothPicture& cloth, const Color& color, double opacity,
                           const PictureFrame& frame) {
  const auto pointsOf = [&](const std::vector<int>& nodes) {
    std::vector<Vec2> points;
    for (const int node : nodes) points.push_back(pixels_[node]);
    return points;
  };
  const double width =
      cloth.columns > 1 ? length(pixels_[cloth.columns - 1] - pixels_[0]) / (cloth.columns - 1) : 0;
  const double height =
      cloth.rows > 1 ? length(pixels_.back() - pixels_[cloth.columns - 1]) / (cloth.rows - 1) : 0;
  const double cell = std::max(width, height);
  if (cell > 0) {
    // Powers of two, so that lines do not wander as the cloth stretches.
    int every = 1;
    while (every * cell < kWeavePixels * std::max(frame.unit, 0.4) && every < cloth.columns + cloth.rows)
      every *= 2;
    const StrokeBatch::Look thread{kWeaveUnits * frame.unit,
                                   linear(mixed(color, {0, 0, 0}, 0.75), kWeaveOpacity * opacity)};
    for (const std::vector<int>& line : weaveOf(cloth, every)) palette_.strokes.add(pointsOf(line), thread);
  }
  const Color hemColor = mixed(color, frame.darkGround ? Color{1, 1, 1} : Color{0, 0, 0}, 0.35);
  const StrokeBatch::Look hem{std::max(1.6, kHemUnits * frame.unit), linear(hemColor, opacity)};
  for (const std::vector<int>& loop : hemOf(cloth)) palette_.strokes.addLoop(pointsOf(loop), hem);
  const StrokeBatch::Look loose{1.3 * hem.width, linear(color, opacity)};
  std::vector<char> held(cloth.positions.size(), 0);
  for (const auto& [a, b] : cloth.threads) {
    palette_.strokes.add({pixels_[a], pixels_[b]}, loose);
    held[a] = held[b] = 1;
  }
  palette_.strokes.flush();
  for (const int node : looseNodes(cloth))
    if (!held[node])
      palette_.sprites.addDisk(pixels_[node], std::max(cloth.radius * frame.scale, kLooseUnits * frame.unit),
                               linear(color, opacity));
  palette_.sprites.flush();
}

}  // namespace smokebox
