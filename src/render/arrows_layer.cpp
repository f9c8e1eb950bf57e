#include <algorithm>
#include <cmath>

#include "render/layers.h"

namespace smokebox {

namespace {
constexpr double kSpacingUnits = 34;      // between arrows where the scene does not say, 1/720 of the height
constexpr double kLongestShare = 0.92;    // of the spacing: the longest arrow never touches its neighbour
constexpr double kHalfWidthUnits = 0.95;  // of the shaft
constexpr float kHalfOpen = 0.5f;         // cells less open than this are taken for the solid's
}  // namespace

ArrowsLayer::ArrowsLayer(const Gl& gl) : program_(gl, "arrow.vert", "arrow.frag"), instances_(gl, {4}) {}

void ArrowsLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  if (snapshot.velocityX.empty() || snapshot.velocityY.empty()) return;
  const Grid& grid = snapshot.grid;
  const double wanted = layer.spacing > 0 ? layer.spacing : kSpacingUnits * frame.unit / frame.scale;
  // As many as fit evenly, half a spacing from the walls; the same spacing in both directions but for
  // rounding.
  const int countX = std::clamp(static_cast<int>(std::lround(grid.width() / wanted)), 1, 4 * grid.nx);
  const int countY = std::clamp(static_cast<int>(std::lround(grid.height() / wanted)), 1, 4 * grid.ny);
  const double stepX = grid.width() / countX, stepY = grid.height() / countY;
  const double longest = kLongestShare * std::min(stepX, stepY) * frame.scale;
  const double fastest = std::max(std::abs(snapshot.speedRange[0]), std::abs(snapshot.speedRange[1]));
  // Pixels for each m/s: an arrow shows `scale` seconds of motion; by default the film's fastest is the
  // longest.
  const double perSpeed = layer.scale > 0 ? layer.scale * frame.scale : fastest > 0 ? longest / fastest : 0;

  auto sample = [&](const Field& field, double x, double y) {  // bilinear, held at the walls
    const double i = std::clamp(x / grid.h - 0.5, 0.0, grid.nx - 1.0),
                 j = std::clamp(y / grid.h - 0.5, 0.0, grid.ny - 1.0);
    const int i0 = std::min(static_cast<int>(i), std::max(grid.nx - 2, 0));
    const int j0 = std::min(static_cast<int>(j), std::max(grid.ny - 2, 0));
    const int i1 = std::min(i0 + 1, grid.nx - 1), j1 = std::min(j0 + 1, grid.ny - 1);
    const double fx = i - i0, fy = j - j0;
    return (1 - fy) * ((1 - fx) * field(i0, j0) + fx * field(i1, j0)) +
           fy * ((1 - fx) * field(i0, j1) + fx * field(i1, j1));
  };
  records_.clear();
  for (int b = 0; b < countY; ++b)
    for (int a = 0; a < countX; ++a) {
      const Vec2 at{(a + 0.5) * stepX, (b + 0.5) * stepY};
      const Vec2 pixel = frame.toPixels(at);
      if (pixel.x < -longest || pixel.y < -longest || pixel.x > frame.width + longest ||
          pixel.y > frame.height + longest)
        continue;
      const int i = std::min(static_cast<int>(at.x / grid.h), grid.nx - 1);
      const int j = std::min(static_cast<int>(at.y / grid.h), grid.ny - 1);
      if (!snapshot.open.empty() && snapshot.open(i, j) < kHalfOpen) continue;
      const bool inSolid = std::any_of(snapshot.solids.begin(), snapshot.solids.end(),
                                       [&](const SolidPicture& s) { return contains(s.outlines, at); });
      if (inSolid) continue;
      Vec2 vector{perSpeed * sample(snapshot.velocityX, at.x, at.y),
                  -perSpeed * sample(snapshot.velocityY, at.x, at.y)};
      const double size = length(vector);
      if (size > longest) vector = (longest / size) * vector;
      // Centred on its point, so that the pattern stays even.
      const Vec2 tail = pixel - 0.5 * vector;
      records_.insert(records_.end(), {float(tail.x), float(tail.y), float(vector.x), float(vector.y)});
    }
  const Color color =
      layer.color.value_or(frame.darkGround ? Color{0.93f, 0.95f, 0.98f} : Color{0.10f, 0.12f, 0.16f});
  const Color halo = frame.darkGround ? Color{0, 0, 0} : Color{1, 1, 1};
  program_.use();
  program_.set("pictureSize", float(frame.width), float(frame.height));
  program_.set("halfWidth", float(std::max(0.6, kHalfWidthUnits * frame.unit)));
  program_.set("haloWidth", float(std::max(0.5, 0.9 * frame.unit)));
  program_.set("color", linear(color, layer.opacity));
  program_.set("haloColor", linear(halo, 0.4 * layer.opacity));
  instances_.draw(records_);
}

}  // namespace smokebox
