#include <algorithm>

#include "render/body_layers.h"
#include "render/link_shapes.h"

namespace smokebox {

namespace {
constexpr double kSmallestUnits = 1.2;  // radius, in 1/720 of the picture's height; smaller ones would vanish
constexpr double kOutlineFrom = 4;      // pixels of radius
}  // namespace

void ParticlesLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  for (const ParticlePicture& particle : snapshot.particles) {
    const Color fill = particle.color ? *particle.color : layer.color.value_or(bodyColor(particle.index));
    const double radius = std::max(particle.radius * frame.scale, kSmallestUnits * frame.unit);
    palette_.sprites.addDisk(frame.toPixels(particle.position), radius, linear(fill, layer.opacity),
                             radius < kOutlineFrom ? 0 : std::min(frame.line(1.4), 0.2 * radius),
                             linear(outlineColor(fill, 0.45), layer.opacity));
  }
  palette_.sprites.flush();
}

}  // namespace smokebox
