#include <algorithm>
#include <cmath>

#include "base/maths.h"
#include "render/layers.h"

namespace smokebox {

namespace {
constexpr double kMarkerUnits = 5;  // radius of a point's ring, 1/720 of the picture's height
constexpr double kLineUnits = 1.6;
constexpr int kRingCorners = 32;
}  // namespace

ProbesLayer::ProbesLayer(Palette& palette) : palette_(palette), painter_(palette.width, palette.height) {}

void ProbesLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  const Color ink =
      layer.color.value_or(frame.darkGround ? Color{1.0f, 0.85f, 0.45f} : Color{0.55f, 0.22f, 0.02f});
  const Color halo = frame.darkGround ? Color{0, 0, 0} : Color{1, 1, 1};
  const LinearColor over = linear(ink, layer.opacity), under = linear(halo, 0.5 * layer.opacity);
  const int size = fontSize(frame, 16);
  const double width = frame.line(kLineUnits), haloWidth = frame.line(1.2);
  for (const ProbePicture& probe : snapshot.probes) {
    pixels_.clear();
    Vec2 nameAt;  // left end of the name's middle line
    if (probe.region.empty()) {
      const Vec2 centre = frame.toPixels(probe.at);
      const double radius = std::max(2.5, kMarkerUnits * frame.unit);
      Outline ring;
      for (int k = 0; k < kRingCorners; ++k) {
        const double angle = 2 * kPi * k / kRingCorners;
        ring.push_back(centre + Vec2{radius * std::cos(angle), radius * std::sin(angle)});
      }
      pixels_.push_back(std::move(ring));
      pixels_.push_back({centre, centre + Vec2{0.01, 0}});  // the dot in the middle
      nameAt = centre + Vec2{radius + 0.5 * size, 0};
    } else {
      nameAt = {1e30, 1e30};
      for (const Outline& outline : probe.region) {
        Outline line;
        for (const Vec2& point : outline) {
          line.push_back(frame.toPixels(point));
          nameAt = {std::min(nameAt.x, line.back().x), std::min(nameAt.y, line.back().y)};
        }
        pixels_.push_back(std::move(line));
      }
      nameAt.y -= 0.6 * size;  // above the region's upper left
    }
    palette_.sprites.add(painter_.line(pixels_, width, haloWidth), under, over);
    const bool near =
        std::abs(nameAt.x) < 1e6 && std::abs(nameAt.y) < 1e6;  // far ones would overflow, unseen
    if (!probe.name.empty() && near)
      palette_.sprites.add(haloedText(palette_.text, probe.name, size, FontWeight::regular,
                                      static_cast<int>(std::lround(nameAt.x)),
                                      static_cast<int>(std::lround(nameAt.y + 0.36 * size)),
                                      std::max(1, size / 8), frame.width, frame.height),
                           under, over);
  }
  palette_.sprites.flush();
}

}  // namespace smokebox
