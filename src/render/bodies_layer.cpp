#include <algorithm>
#include <cmath>

#include "base/maths.h"
#include "render/body_layers.h"
#include "render/link_shapes.h"

namespace smokebox {

namespace {
constexpr double kOutlineUnits = 1.8;   // width of the outline, in 1/720 of the picture's height
constexpr double kThinnestUnits = 1.6;  // thinner bodies are widened to this
constexpr double kOutlineShare = 0.14;  // of a small body's radius: its outline does not swallow it
constexpr double kMarkFromPixels = 5;   // smaller bodies have no mark

struct BodyColors {
  Color fill, outline;
};

BodyColors colorsOf(const BodyPicture& body, const LayerSpec& layer) {
  const Color fill = body.color ? *body.color : layer.color.value_or(bodyColor(body.index));
  return {fill, outlineColor(fill)};
}

Vec2 inOwn(Vec2 point, const Pose& pose) { return transformed(point - pose.position, {{}, -pose.angleRad}); }

double strokeFor(double radius, const PictureFrame& frame) {
  return std::min(frame.line(kOutlineUnits), std::max(kOutlineShare * radius, 0.6));
}
}  // namespace

BodiesLayer::BodiesLayer(Palette& palette) : palette_(palette), painter_(palette.width, palette.height) {}

void BodiesLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  if (kept_.size() < snapshot.bodies.size()) kept_.resize(snapshot.bodies.size());
  for (std::size_t k = 0; k < snapshot.bodies.size(); ++k) {
    const BodyPicture& body = snapshot.bodies[k];
    if (body.radius > 0)
      drawDisk(body, layer, frame);
    else
      drawOutlines(body, k, layer, frame);
  }
  palette_.sprites.flush();
}

/// Its mark is a spoke.
void BodiesLayer::drawDisk(const BodyPicture& body, const LayerSpec& layer, const PictureFrame& frame) {
  const BodyColors colors = colorsOf(body, layer);
  const LinearColor outline = linear(colors.outline, layer.opacity);
  const Vec2 centre = frame.toPixels(body.pose.position);
  const double radius = std::max(body.radius * frame.scale, 0.5 * kThinnestUnits * frame.unit);
  const double stroke = strokeFor(radius, frame);
  palette_.sprites.addDisk(centre, radius, linear(colors.fill, layer.opacity), stroke, outline);
  if (!layer.mark || radius < kMarkFromPixels) return;
  const Vec2 rim = frame.toPixels(transformed(Vec2{body.radius, 0}, body.pose)) - centre;
  palette_.sprites.addSegment(centre, centre + (1 - stroke / radius) * rim, stroke, outline);
}

/// Its mark is a spoke from a dot, which is the centre of mass wherever that can be seen.
void BodiesLayer::drawOutlines(const BodyPicture& body, std::size_t place, const LayerSpec& layer,
                               const PictureFrame& frame) {
  pixels_.resize(body.outlines.size());
  for (std::size_t m = 0; m < pixels_.size(); ++m) {
    pixels_[m].clear();
    for (const Vec2& point : body.outlines[m]) pixels_[m].push_back(frame.toPixels(point));
  }
  if (pixels_.empty() || pixels_[0].empty()) return;
  const BodyColors colors = colorsOf(body, layer);
  const Vec2 centre = frame.toPixels(body.pose.position), corner = pixels_[0][0];
  const double radius = length(corner - centre);
  const double stroke = strokeFor(radius, frame);
  Kept& kept = kept_[place];
  if (kept.outlines != pixels_ || kept.marked != layer.mark) {
    std::optional<Spoke> spoke;
    if (layer.mark && radius >= kMarkFromPixels) spoke = spokeOf(body, kept, stroke, frame);
    kept.mask = painter_.solid(pixels_, stroke, std::max(1.2, kThinnestUnits * frame.unit),
                               spoke ? &*spoke : nullptr);
    kept.outlines = pixels_;
    kept.marked = layer.mark;
  }
  palette_.sprites.add(kept.mask, linear(colors.fill, layer.opacity), linear(colors.outline, layer.opacity));
}

std::optional<Spoke> BodiesLayer::spokeOf(const BodyPicture& body, Kept& kept, double stroke,
                                          const PictureFrame& frame) const {
  if (kept.index != body.index) {
    // Its shape stays what it is, so the mark is looked for once.
    kept.mark = markOf(body.outlines, body.pose);
    kept.index = body.index;
    if (kept.mark) kept.mark = BodyMark{inOwn(kept.mark->from, body.pose), inOwn(kept.mark->to, body.pose)};
  }
  if (!kept.mark) return {};
  Spoke spoke{frame.toPixels(transformed(kept.mark->from, body.pose)),
              frame.toPixels(transformed(kept.mark->to, body.pose)), 0.8 * stroke, 1.2 * stroke};
  if (length(spoke.to - spoke.from) < 4 * spoke.width) return {};
  return spoke;
}

}  // namespace smokebox
