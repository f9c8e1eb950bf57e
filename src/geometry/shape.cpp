#include "geometry/shape.h"

#include <algorithm>
#include <cmath>

#include "base/maths.h"

namespace smokebox {
namespace {

struct Turn {
  double cosine = 1, sine = 0;
};

/// Quarter turns come out exact, so that boxes turned by 90 degrees stay aligned with the grid.
Turn turnBy(double angleRad) {
  if (angleRad == 0) return {};
  Turn turn{exact::cos(angleRad), exact::sin(angleRad)};
  if (std::fabs(turn.cosine) < 1e-15) return {0, turn.sine < 0 ? -1.0 : 1.0};
  if (std::fabs(turn.sine) < 1e-15) return {turn.cosine < 0 ? -1.0 : 1.0, 0};
  return turn;
}

Vec2 moved(Vec2 p, const Turn& turn, Vec2 shift) {
  return {turn.cosine * p.x - turn.sine * p.y + shift.x, turn.sine * p.x + turn.cosine * p.y + shift.y};
}

/// Number of corners, a multiple of 4: the equal-area polygon is off by at most radius (pi / n)^2 / 3.
int cornersOf(double radius, double tolerance) {
  const double wanted = tolerance > 0 ? kPi * std::sqrt(radius / (3 * tolerance)) : 65536;
  return 4 * static_cast<int>(std::clamp(std::ceil(wanted / 4), 4.0, 16384.0));
}

/// Unit vectors at angles 2 pi k / n, k = 0..n/4, both ends exact. n is a multiple of 4.
std::vector<Vec2> quarterCircle(int n) {
  std::vector<Vec2> points(n / 4 + 1);
  for (int k = 0; k <= n / 4; ++k) points[k] = {exact::cos(2 * kPi * k / n), exact::sin(2 * kPi * k / n)};
  points.front() = {1, 0};
  points.back() = {0, 1};
  return points;
}

/// Two half ellipses around (+-half, 0); mirrored from one quarter, so symmetric about both axes to the bit.
Outline roundOutline(int n, Vec2 radii, double half) {
  const std::vector<Vec2> quarter = quarterCircle(n);
  std::vector<Vec2> upperRight;
  for (Vec2 q : quarter) upperRight.push_back({half + radii.x * q.x, radii.y * q.y});
  Outline outline;
  outline.reserve(n + 2);
  for (Vec2 p : upperRight) outline.push_back(p);
  for (auto p = upperRight.rbegin(); p != upperRight.rend(); ++p)
    if (half > 0 || p->x > 0) outline.push_back({-p->x, p->y});
  for (std::size_t k = 1; k < upperRight.size(); ++k) outline.push_back({-upperRight[k].x, -upperRight[k].y});
  for (auto p = upperRight.rbegin(); p != upperRight.rend(); ++p)
    if ((half > 0 || p->x > 0) && p->y > 0) outline.push_back({p->x, -p->y});
  return outline;
}

Outline regularOutline(int sides, double radius) {
  Outline outline(sides);
  for (int k = 0; k < sides; ++k) {
    const int folded = std::min(k, sides - k);  // mirrored about x
    const bool left = sides % 2 == 0 && 4 * folded > sides;
    const int first = left ? sides / 2 - folded : folded;  // mirrored about y
    const bool top = 4 * first == sides;
    const double x = top ? 0 : radius * exact::cos(2 * kPi * first / sides);
    const double y = first == 0 ? 0 : top ? radius : radius * exact::sin(2 * kPi * first / sides);
    outline[k] = {left ? -x : x, 2 * k > sides ? -y : y};
  }
  return outline;
}

std::vector<Outline> localOutlines(const EllipseShape& ellipse, double tolerance) {
  const int n = cornersOf(std::max(ellipse.radii.x, ellipse.radii.y), tolerance);
  // The polygon's area is n/2 s^2 sin(2 pi / n) times that of the unit radii; the true one pi.
  const double scale = std::sqrt(2 * kPi / n / exact::sin(2 * kPi / n));
  return {roundOutline(n, scale * ellipse.radii, 0)};
}

std::vector<Outline> localOutlines(const CircleShape& circle, double tolerance) {
  return localOutlines(EllipseShape{{circle.radius, circle.radius}}, tolerance);
}

std::vector<Outline> localOutlines(const CapsuleShape& capsule, double tolerance) {
  if (capsule.length <= 0) return localOutlines(CircleShape{capsule.radius}, tolerance);
  const int n = cornersOf(capsule.radius, tolerance);
  // Radius R of the corners: 2 L R + n/2 sin(2 pi / n) R^2 = 2 L r + pi r^2.
  const double a = n / 2.0 * exact::sin(2 * kPi / n), b = capsule.length, r = capsule.radius;
  const double radius = (-b + std::sqrt(b * b + a * (2 * b * r + kPi * r * r))) / a;
  return {roundOutline(n, {radius, radius}, capsule.length / 2)};
}

std::vector<Outline> localOutlines(const BoxShape& box, double) {
  const double x = box.size.x / 2, y = box.size.y / 2;
  return {{{-x, -y}, {x, -y}, {x, y}, {-x, y}}};
}

std::vector<Outline> localOutlines(const RegularShape& regular, double) {
  return {regularOutline(regular.sides, regular.radius)};
}

std::vector<Outline> localOutlines(const PolygonShape& polygon, double) {
  Outline outline = polygon.points;
  if (signedArea(outline) < 0) std::reverse(outline.begin(), outline.end());
  return {outline};
}

std::vector<Outline> localOutlines(const UnionShape& parts, double tolerance) {
  std::vector<Outline> all;
  for (const PlacedShape& part : parts.parts)
    for (Outline& outline : outlinesOf(part, tolerance)) all.push_back(std::move(outline));
  return merged(all);
}

}  // namespace

std::vector<Outline> outlinesOf(const PlacedShape& placed, double tolerance) {
  std::vector<Outline> outlines =
      std::visit([tolerance](const auto& shape) { return localOutlines(shape, tolerance); }, placed.shape);
  for (Outline& outline : outlines) outline = transformed(outline, placed.pose);
  return outlines;
}

Outline transformed(const Outline& outline, const Pose& pose) {
  const Turn turn = turnBy(pose.angleRad);
  Outline result(outline.size());
  for (std::size_t k = 0; k < outline.size(); ++k) result[k] = moved(outline[k], turn, pose.position);
  return result;
}

Vec2 transformed(Vec2 point, const Pose& pose) { return moved(point, turnBy(pose.angleRad), pose.position); }

Pose combined(const Pose& outer, const Pose& inner) {
  return {transformed(inner.position, outer), outer.angleRad + inner.angleRad};
}

}  // namespace smokebox
