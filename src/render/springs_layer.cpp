#include <algorithm>
#include <cmath>

#include "render/body_layers.h"
#include "render/link_shapes.h"

namespace smokebox {

namespace {
constexpr double kWireUnits = 1.7, kThinWireUnits = 1.1;  // widths, in 1/720 of the picture's height
constexpr double kEyeUnits = 2.4;                         // radius of the dots at a spring's ends
constexpr double kRingUnits = 5.5;                        // radius, at the end that pulls
}  // namespace

void SpringsLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  if (snapshot.springs.empty()) return;
  const Color neutral =
      layer.color.value_or(frame.darkGround ? Color{0.80f, 0.83f, 0.88f} : Color{0.36f, 0.39f, 0.44f});
  const Color pulling = frame.darkGround ? Color{1.0f, 0.86f, 0.48f} : Color{0.70f, 0.38f, 0.02f};
  records_.clear();
  for (const SpringPicture& spring : snapshot.springs) {
    if (spring.pull) {
      addPull(spring, spring.color.value_or(pulling), layer, frame);
      continue;
    }
    const Vec2 from = frame.toPixels(spring.from), to = frame.toPixels(spring.to);
    const double reach = length(to - from), rest = spring.length * frame.scale;
    const Zigzag shape = zigzag(rest, reach, frame.unit);
    const Color color = spring.color  ? *spring.color
                        : layer.range ? tensionColor(spring.tension, *layer.range, neutral)
                                      : tensionColor(spring.tension, snapshot.usualTension, neutral);
    const double width = (shape.period > 0 ? kWireUnits : kThinWireUnits) * frame.unit;
    records_.insert(records_.end(),
                    {float(from.x), float(from.y), float(to.x), float(to.y), float(shape.straight),
                     float(shape.period), float(shape.amplitude), float(0.5 * width)});
    const LinearColor ink = linear(color, layer.opacity);
    records_.insert(records_.end(), ink.begin(), ink.end());
  }
  if (!records_.empty()) {
    if (!program_) {
      program_.emplace(palette_.gl, "spring.vert", "spring.frag");
      instances_.emplace(palette_.gl, std::vector<int>{4, 4, 4});
    }
    const double haloWidth = 0.9 * frame.unit, eyes = std::max(1.5, kEyeUnits * frame.unit);
    program_->use();
    program_->set("pictureSize", float(frame.width), float(frame.height));
    program_->set("haloWidth", float(haloWidth));
    program_->set("haloColor", linear(frame.darkGround ? Color{0, 0, 0} : Color{1, 1, 1}, 0.45));
    program_->set("eyes", float(eyes));
    program_->set("margin", float(eyes + haloWidth + 1));
    instances_->draw(records_);
  }
  palette_.sprites.flush();
}

void SpringsLayer::addPull(const SpringPicture& spring, const Color& ink, const LayerSpec& layer,
                           const PictureFrame& frame) {
  const LinearColor color = linear(ink, layer.opacity);
  const LinearColor halo = linear(frame.darkGround ? Color{0, 0, 0} : Color{1, 1, 1}, 0.4 * layer.opacity);
  const Vec2 from = frame.toPixels(spring.from), to = frame.toPixels(spring.to);
  const double radius = std::max(3.0, kRingUnits * frame.unit), width = frame.line(kWireUnits);
  const double reach = length(to - from);
  if (reach > radius)
    palette_.sprites.addSegment(from, to - (radius / reach) * (to - from), width, color, halo);
  palette_.sprites.addDisk(from, std::max(1.5, kEyeUnits * frame.unit), color);
  palette_.sprites.addDisk(to, radius, {}, width, color);
  palette_.sprites.addDisk(to, std::max(1.0, 0.3 * radius), color);
}

}  // namespace smokebox
