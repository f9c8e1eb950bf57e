#include "rigid/joint_rows.h"

namespace smokebox {

namespace {

/// Of d . (q - p), d fixed to the world.
void along(Vec2 d, Vec2 armA, Vec2 armB, Jacobian& a, Jacobian& b) {
  a = {-d.x, -d.y, -cross(armA, d)};
  b = {d.x, d.y, cross(armB, d)};
}

}  // namespace

int equalities(JointKind kind) {
  switch (kind) {
    case JointKind::weld:
      return 3;
    case JointKind::rope:
      return 0;
    default:
      return 2;
  }
}

bool hasDrive(const JointDef& def) {
  if (def.kind == JointKind::weld) return false;
  if (def.kind == JointKind::rope) return true;
  const double none = std::numeric_limits<double>::infinity();
  return def.lower > -none || def.upper < none || def.motorLimit > 0;
}

bool isAngle(JointKind kind, int row) {
  return kind == JointKind::slide ? row == 1 : kind != JointKind::rope && row == 2;
}

JointRow gapsOf(const JointDef& def, double startAngle, const JointPlace& place) {
  const Vec2 between = toWorld(place.b, def.b.at) - toWorld(place.a, def.a.at);
  const double angle = place.angleB - place.angleA - startAngle;
  switch (def.kind) {
    case JointKind::slide: {
      const Vec2 line = rotate(place.a.turn, def.axis);
      return {cross(line, between), angle, dot(line, between)};
    }
    case JointKind::rope:
      return {0, 0, length(between)};
    default:
      return {between.x, between.y, angle};
  }
}

JointJacobians jacobiansOf(const JointDef& def, const JointPlace& place) {
  const Vec2 armA = rotate(place.a.turn, def.a.at), armB = rotate(place.b.turn, def.b.at);
  const Vec2 between = place.b.position + armB - (place.a.position + armA);
  JointJacobians rows;
  switch (def.kind) {
    case JointKind::slide: {
      const Vec2 line = rotate(place.a.turn, def.axis), across = perpendicular(line);
      along(across, armA + between, armB, rows.a[0], rows.b[0]);
      rows.a[1].turn = -1, rows.b[1].turn = 1;
      along(line, armA + between, armB, rows.a[2], rows.b[2]);
      break;
    }
    case JointKind::rope: {
      const double distance = length(between);
      along(distance > 0 ? (1 / distance) * between : Vec2{1, 0}, armA, armB, rows.a[2], rows.b[2]);
      break;
    }
    default:
      along({1, 0}, armA, armB, rows.a[0], rows.b[0]);
      along({0, 1}, armA, armB, rows.a[1], rows.b[1]);
      rows.a[2].turn = -1, rows.b[2].turn = 1;
  }
  return rows;
}

}  // namespace smokebox
