#include <algorithm>
#include <cmath>

#include "render/body_layers.h"

namespace smokebox {

namespace {
// In 1/720 of the picture's height.
constexpr double kLargestUnits = 44;  // half of the normal of a blow beyond measure
constexpr double kDotUnits = 7;       // radius of its dot
constexpr double kWidthUnits = 5;     // of the normal at the dot; it ends in a point
constexpr double kRestUnits = 1.5;    // radius of the dot of a contact at rest
constexpr double kRestOpacity = 0.45;
constexpr double kGrows = 0.5;      // of the ring, as it fades
constexpr double kRingFrom = 0.5;   // size from which a blow has a ring
constexpr double kFaintest = 0.15;  // size below which a blow is no more than a contact at rest
}  // namespace

void CollisionsLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  const Color ink =
      layer.color.value_or(frame.darkGround ? Color{1.0f, 0.85f, 0.30f} : Color{0.80f, 0.16f, 0.05f});
  const Color shade = frame.darkGround ? Color{0, 0, 0} : Color{1, 1, 1};
  const double unit = std::max(frame.unit, 0.4);
  for (const TouchPicture& touch : snapshot.touches) {
    const Vec2 at = frame.toPixels(touch.point);
    const double root = std::sqrt(std::max(touch.impulse, 0.0) / snapshot.usualImpulse);
    const double size = root / (1 + root);  // the root for what is usual, never beyond 1
    if (touch.approach == 0 || !(size > kFaintest)) {
      if (touch.age == 0)
        palette_.sprites.addDisk(at, kRestUnits * unit, linear(ink, kRestOpacity * layer.opacity));
      continue;
    }
    const double fade = std::clamp(1 - touch.age / layer.fade, 0.0, 1.0);
    const double opacity = fade * layer.opacity;
    if (!(opacity > 0)) continue;
    const Vec2 normal{touch.normal.x, -touch.normal.y};
    const double half = kLargestUnits * size * unit, dot = std::max(1.4, kDotUnits * size * unit);
    const double width = std::max(1.4, kWidthUnits * size * unit);
    const LinearColor color = linear(ink, opacity), halo = linear(shade, 0.5 * opacity);
    for (const double side : {-half, half}) {
      palette_.strokes.add({at, at + side * normal}, {{width + 3, halo}, {2.6, halo}});
      palette_.strokes.add({at, at + side * normal}, {{width, color}, {0.6, color}});
    }
    palette_.sprites.addDisk(at, dot + 1.2, halo);
    palette_.sprites.addDisk(at, dot, color);
    if (size < kRingFrom) continue;
    palette_.sprites.addDisk(at, (0.5 + kGrows * (1 - fade)) * half, {}, std::max(1.2, 0.3 * width),
                             linear(ink, 0.65 * opacity));
  }
  palette_.strokes.flush();
  palette_.sprites.flush();
}

}  // namespace smokebox
