// The shapes that a scene can name, and their outlines as polygons.
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "geometry/vec2.h"

namespace smokebox {

/// Where a shape's own (0, 0) lies in the world, and how far it is turned (counterclockwise).
struct Pose {
  Vec2 position;
  double angleRad = 0;
  bool operator==(const Pose&) const = default;
};

struct PlacedShape;

struct CircleShape {
  double radius = 0;
};
struct EllipseShape {
  Vec2 radii;
};
struct BoxShape {
  Vec2 size;
};  // centred on (0, 0)
struct CapsuleShape {
  double length = 0, radius = 0;
};  // along x; length between the centres of the caps
struct RegularShape {
  int sides = 3;
  double radius = 0;
};  // circumradius; the first corner points along +x
struct PolygonShape {
  std::vector<Vec2> points;
};  // any simple polygon, either orientation
struct UnionShape {
  std::vector<PlacedShape> parts;
};

using Shape =
    std::variant<CircleShape, EllipseShape, BoxShape, CapsuleShape, RegularShape, PolygonShape, UnionShape>;

struct PlacedShape {
  Shape shape;
  Pose pose;
};

/// A closed polygon without self-crossings, counterclockwise (a hole: clockwise); the last point joins the
/// first.
using Outline = std::vector<Vec2>;

/// The outlines of a placed shape in the world. Curves become polygons of the same area whose largest
/// distance from the true curve is about `tolerance` metres. A union gives the outlines of the merged region.
std::vector<Outline> outlinesOf(const PlacedShape& placed, double tolerance);

/// The same outlines under a further motion: turned about (0, 0), then shifted.
Outline transformed(const Outline& outline, const Pose& pose);
Vec2 transformed(Vec2 point, const Pose& pose);
/// First `inner`, then `outer`.
Pose combined(const Pose& outer, const Pose& inner);

/// What is wrong with a polygon's points, in words that name the edges; empty if it is simple and has area.
std::string polygonFault(const std::vector<Vec2>& points);

/// Signed: positive if counterclockwise.
double signedArea(const Outline& outline);
/// Area, centre of mass and second moment of area about it (m^4), of outlines with holes.
struct MassProperties {
  double area = 0;
  Vec2 centre;
  double secondMoment = 0;
};
MassProperties massProperties(const std::vector<Outline>& outlines);

/// Is the point inside (even-odd rule over all outlines)?
bool contains(const std::vector<Outline>& outlines, Vec2 point);

/// The outlines of the merged region of many polygons that may overlap or touch.
std::vector<Outline> merged(const std::vector<Outline>& outlines);

}  // namespace smokebox
