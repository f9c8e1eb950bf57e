#include <algorithm>
#include <cmath>

#include "base/maths.h"
#include "render/body_layers.h"
#include "render/link_shapes.h"

namespace smokebox {

namespace {
// In 1/720 of the picture's height.
constexpr double kPinUnits = 4.6, kWeldUnits = 4.2, kMotorUnits = 13, kRailUnits = 170, kLineUnits = 1.7;
constexpr double kArcFrom = 0.75 * kPi,
                 kArcTo = -0.75 * kPi;  // of a motor; y is down, so it turns to the left
constexpr double kArrowUnits = 6;
}  // namespace

void JointsLayer::draw(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  if (snapshot.joints.empty()) return;
  const Color ink =
      layer.color.value_or(frame.darkGround ? Color{0.93f, 0.94f, 0.96f} : Color{0.13f, 0.15f, 0.19f});
  const Color ground = frame.darkGround ? Color{0.10f, 0.11f, 0.13f} : Color{0.97f, 0.97f, 0.98f};
  const Ink inks{linear(ink, layer.opacity), linear(ground, layer.opacity),
                 linear(ground, 0.5 * layer.opacity)};
  // Ropes lie below the rings that they may end in.
  for (const JointPicture& joint : snapshot.joints)
    if (joint.kind == JointSpec::Kind::rope) addRope(joint, inks, frame);
  palette_.strokes.flush();
  for (const JointPicture& joint : snapshot.joints) {
    switch (joint.kind) {
      case JointSpec::Kind::pin:
        addPin(joint, inks, frame);
        break;
      case JointSpec::Kind::weld:
        addWeld(joint, inks, frame);
        break;
      case JointSpec::Kind::slide:
        addSlide(joint, inks, frame);
        break;
      case JointSpec::Kind::rope:
        for (const Vec2 end : {joint.a, joint.b})
          palette_.sprites.addDisk(frame.toPixels(end), std::max(1.5, 2.4 * frame.unit), inks.line);
        break;
    }
  }
  palette_.sprites.flush();
  palette_.strokes.flush();
}

void JointsLayer::addPin(const JointPicture& joint, const Ink& ink, const PictureFrame& frame) {
  const Vec2 at = frame.toPixels(joint.a);
  const double radius = std::max(2.5, kPinUnits * frame.unit), width = frame.line(kLineUnits);
  palette_.sprites.addDisk(at, radius, ink.ground, width, ink.line);
  if (joint.motor == 0) return;
  const double reach = std::max(7.0, kMotorUnits * frame.unit),
               arrow = std::max(3.0, kArrowUnits * frame.unit);
  const double way = joint.motor > 0 ? 1 : -1;
  const std::vector<Vec2> line = arc(at, reach, way * kArcFrom, way * kArcTo);
  palette_.strokes.add(line, {width + 2 * frame.unit, ink.halo});
  palette_.strokes.add(line, {width, ink.line});
  const Vec2 tip = line.back();
  const Vec2 forward{std::sin(kArcTo), -way * std::cos(kArcTo)};  // along the arc
  for (const double side : {1.0, -1.0})
    palette_.strokes.add({tip - arrow * (0.8 * forward + side * 0.55 * perpendicular(forward)), tip},
                         {width, ink.line});
}

void JointsLayer::addWeld(const JointPicture& joint, const Ink& ink, const PictureFrame& frame) {
  const Vec2 at = frame.toPixels(joint.a);
  const double half = std::max(2.5, kWeldUnits * frame.unit), width = frame.line(kLineUnits);
  const Vec2 right{half, 0}, down{0, half};
  palette_.sprites.addDisk(at, half, ink.ground);
  const Vec2 corners[] = {at - right - down, at + right - down, at + right + down, at - right + down};
  for (int k = 0; k < 4; ++k) palette_.sprites.addSegment(corners[k], corners[(k + 1) % 4], width, ink.line);
  palette_.sprites.addSegment(corners[0], corners[2], width, ink.line);
  palette_.sprites.addSegment(corners[1], corners[3], width, ink.line);
}

/// The rail reaches as far as its limits let it go; without limits it fades out a long way from its start.
void JointsLayer::addSlide(const JointPicture& joint, const Ink& ink, const PictureFrame& frame) {
  const Vec2 start = frame.toPixels(joint.a);
  const Vec2 along = frame.toPixels(joint.a + joint.axis) - start;
  const double size = length(along);
  if (!(size > 0)) return;
  const Vec2 forward = (1 / size) * along, across = perpendicular(forward);
  const double now = dot(frame.toPixels(joint.b) - start, forward), unit = std::max(frame.unit, 0.5);
  const double width = frame.line(kLineUnits), tick = 5 * unit, bar = 8 * unit;
  const double fades = std::max(kRailUnits * unit, 1.2 * std::abs(now));
  const LinearColor none{};
  for (const double way : {-1.0, 1.0}) {
    const double limit = way * (way < 0 ? joint.lower : joint.upper) * size;
    const bool ends = limit < 2 * std::max(frame.width, frame.height);  // not far outside of the picture
    const Vec2 end = start + way * (ends ? limit : fades) * forward;
    const LinearColor line = ends ? ink.line : none, halo = ends ? ink.halo : none;
    palette_.strokes.add({start, end}, {{width + 1.8 * unit, ink.halo}, {width + 1.8 * unit, halo}});
    palette_.strokes.add({start, end}, {{width, ink.line}, {width, line}});
    if (ends) palette_.strokes.add({end - tick * across, end + tick * across}, {1.3 * width, ink.line});
  }
  palette_.strokes.flush();
  const Vec2 slider = start + now * forward;
  palette_.sprites.addSegment(slider - bar * forward, slider + bar * forward, 3.6 * width, ink.line,
                              ink.halo);
  if (joint.motor == 0) return;
  const Vec2 ahead = joint.motor > 0 ? forward : -forward, tip = slider + (bar + 12 * unit) * ahead;
  palette_.sprites.addSegment(tip, tip - 5 * unit * ahead + 4 * unit * across, width, ink.line);
  palette_.sprites.addSegment(tip, tip - 5 * unit * ahead - 4 * unit * across, width, ink.line);
}

void JointsLayer::addRope(const JointPicture& joint, const Ink& ink, const PictureFrame& frame) {
  const Vec2 a = frame.toPixels(joint.a), b = frame.toPixels(joint.b);
  const std::vector<Vec2> line = hangingRope(a, b, joint.length * frame.scale, {0, 1});
  const double width = frame.line(kLineUnits);
  palette_.strokes.add(line, {width + 1.8 * frame.unit, ink.halo});
  palette_.strokes.add(line, {width, ink.line});
}

}  // namespace smokebox
