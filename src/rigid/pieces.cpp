#include "rigid/pieces.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "rigid/clean_outlines.h"

namespace smokebox {
namespace {

void flatten(const PlacedShape& placed, const Pose& outer, std::vector<PlacedShape>& parts) {
  const Pose pose = combined(outer, placed.pose);
  if (const auto* all = std::get_if<UnionShape>(&placed.shape)) {
    for (const PlacedShape& part : all->parts) flatten(part, pose, parts);
  } else {
    parts.push_back({placed.shape, pose});
  }
}

std::vector<Vec2> roundCore(const PlacedShape& part) {
  if (std::holds_alternative<CircleShape>(part.shape)) return {part.pose.position};
  const auto* capsule = std::get_if<CapsuleShape>(&part.shape);
  if (!capsule) return {};
  if (!(capsule->length > 0)) return {part.pose.position};
  return {transformed(Vec2{-capsule->length / 2, 0}, part.pose),
          transformed(Vec2{capsule->length / 2, 0}, part.pose)};
}

double roundRadius(const PlacedShape& part) {
  const auto* circle = std::get_if<CircleShape>(&part.shape);
  return circle ? circle->radius : std::get<CapsuleShape>(part.shape).radius;
}

/// Of the shape alone, about its centre of mass; outlines are exact for shapes of straight edges.
MassProperties exactMass(const PlacedShape& part) {
  MassProperties mass;
  mass.centre = part.pose.position;
  if (const auto* circle = std::get_if<CircleShape>(&part.shape)) {
    const double square = circle->radius * circle->radius;
    mass.area = kPi * square;
    mass.secondMoment = kPi / 2 * square * square;
    return mass;
  }
  if (const auto* ellipse = std::get_if<EllipseShape>(&part.shape)) {
    mass.area = kPi * ellipse->radii.x * ellipse->radii.y;
    mass.secondMoment = mass.area / 4 * dot(ellipse->radii, ellipse->radii);
    return mass;
  }
  if (const auto* capsule = std::get_if<CapsuleShape>(&part.shape)) {
    const double r = capsule->radius, l = std::max(capsule->length, 0.0), d = l / 2;
    mass.area = 2 * r * l + kPi * r * r;
    mass.secondMoment = 2 * r * l * (l * l + 4 * r * r) / 12 + kPi / 2 * r * r * r * r + kPi * r * r * d * d +
                        8.0 / 3 * r * r * r * d;
    return mass;
  }
  return massProperties(outlinesOf(part, 1));
}

MassProperties sumOf(const std::vector<MassProperties>& parts) {
  MassProperties sum;
  for (const MassProperties& part : parts) {
    sum.area += part.area;
    sum.centre = sum.centre + part.area * part.centre;
  }
  sum.centre = (1 / sum.area) * sum.centre;
  for (const MassProperties& part : parts) {
    const Vec2 away = part.centre - sum.centre;
    sum.secondMoment += part.secondMoment + part.area * dot(away, away);
  }
  return sum;
}

double areaOf(const std::vector<Outline>& outlines) {
  double area = 0;
  for (const Outline& outline : outlines) area += signedArea(outline);
  return area;
}

MassProperties massOf(const PlacedShape& shape, const std::vector<PlacedShape>& parts,
                      const std::vector<Outline>& outlines, double tolerance) {
  std::vector<MassProperties> each;
  for (const PlacedShape& part : parts) each.push_back(exactMass(part));
  const MassProperties sum = sumOf(each);
  // The polygons of curves have the curves' area: less of it in the union tells that parts overlap.
  if (parts.size() == 1 || std::fabs(areaOf(outlines) - sum.area) <= 1e-7 * sum.area) return sum;
  return massProperties(outlinesOf(shape, tolerance / 16));
}

/// Tolerance at which an ellipse becomes a polygon that rolls smoothly: 64 corners or more.
double smoothTolerance(const PlacedShape& part, double tolerance) {
  const auto* ellipse = std::get_if<EllipseShape>(&part.shape);
  if (!ellipse) return tolerance;
  const double step = kPi / 64;
  return std::min(tolerance, std::max(ellipse->radii.x, ellipse->radii.y) * step * step / 3);
}

/// From each edge of a convex core to its farthest corner, rounding included.
double smallestWidth(const ConvexPiece& piece) {
  if (piece.points.size() < 3) return 2 * piece.radius;
  double smallest = 1e300;
  for (std::size_t k = 0; k < piece.normals.size(); ++k) {
    double width = 0;
    for (Vec2 p : piece.points) width = std::max(width, dot(piece.normals[k], piece.points[k] - p));
    smallest = std::min(smallest, width);
  }
  return smallest + 2 * piece.radius;
}

/// How deep the region is behind the middle of an edge, where that is least. Not the pieces' widths: these
/// are cut anyhow, and a sliver of a thick body is no danger. Edges below a millionth of the extent do not
/// count.
double smallestDepth(const std::vector<Outline>& outlines, double extent) {
  struct Edge {
    Vec2 from, along;
  };
  std::vector<Edge> edges;
  for (const Outline& outline : outlines)
    for (std::size_t k = 0; k < outline.size(); ++k)
      edges.push_back({outline[k], outline[k + 1 < outline.size() ? k + 1 : 0] - outline[k]});
  const std::size_t stride = 1 + edges.size() / 4000;  // a sample of very many
  double smallest = extent;
  for (std::size_t i = 0; i < edges.size(); i += stride) {
    const double size = length(edges[i].along);
    if (size <= 1e-6 * extent) continue;
    const Vec2 middle = edges[i].from + 0.5 * edges[i].along,
               inward = (1 / size) * perpendicular(edges[i].along);
    for (std::size_t j = 0; j < edges.size(); ++j) {
      const Vec2 from = edges[j].from - middle;
      const double a = cross(inward, from), b = cross(inward, from + edges[j].along);
      if (j == i || a > 0 || b <= 0) continue;  // the far side runs from right to left
      const double depth = dot(inward, from + (a / (a - b)) * edges[j].along);
      if (depth > 1e-6 * extent) smallest = std::min(smallest, depth);
    }
  }
  return smallest;
}

struct CutShape {
  std::vector<ConvexPiece> pieces;
  double thinnest = 1e300;
};

CutShape cutShape(const std::vector<PlacedShape>& parts, double tolerance) {
  CutShape cut;
  std::vector<Outline> straight;
  for (const PlacedShape& part : parts) {
    const std::vector<Vec2> core = roundCore(part);
    if (!core.empty()) {
      cut.pieces.push_back(makePiece(core, roundRadius(part)));
      cut.thinnest = std::min(cut.thinnest, 2 * roundRadius(part));
      continue;
    }
    for (Outline& outline : outlinesOf(part, smoothTolerance(part, tolerance)))
      straight.push_back(std::move(outline));
  }
  if (straight.empty()) return cut;
  straight = merged(straight);
  std::vector<ConvexPiece> pieces = convexPieces(straight);
  cut.thinnest = std::min(cut.thinnest, pieces.size() == 1 ? smallestWidth(pieces[0])
                                                           : smallestDepth(straight, extentOf(straight)));
  for (ConvexPiece& piece : pieces) cut.pieces.push_back(std::move(piece));
  return cut;
}

/// With (0, 0) at `origin` if there is one, else at the centre of mass.
BodyShape makeShape(const PlacedShape& shape, double tolerance, const Vec2* origin, Vec2& offset) {
  std::vector<PlacedShape> parts;
  flatten(shape, {}, parts);
  BodyShape body;
  body.outlines = outlinesOf(shape, tolerance);
  body.mass = massOf(shape, parts, body.outlines, tolerance);
  checkInvariant(body.mass.area > 0, "a body has area");
  offset = origin ? *origin : body.mass.centre;
  const Vec2 shift = -offset;
  for (Outline& outline : body.outlines)
    for (Vec2& p : outline) p = p + shift;
  body.mass.centre = body.mass.centre + shift;
  for (PlacedShape& part : parts) part.pose.position = part.pose.position + shift;
  CutShape cut = cutShape(parts, tolerance);
  body.pieces = std::move(cut.pieces);
  body.thinnest = cut.thinnest;
  constexpr double kNotchReach = 0.25;
  for (ConvexPiece& piece : body.pieces) piece.notchReach = kNotchReach * cut.thinnest;
  for (const ConvexPiece& piece : body.pieces)
    for (Vec2 p : piece.points) body.reach = std::max(body.reach, length(p) + piece.radius);
  body.tree = PieceTree(body.pieces);
  return body;
}

}  // namespace

BodyShape makeBodyShape(const PlacedShape& shape, double tolerance, Vec2& offset) {
  return makeShape(shape, tolerance, nullptr, offset);
}

BodyShape makeSolidShape(const PlacedShape& shape, double tolerance) {
  const Vec2 own;
  Vec2 offset;
  return makeShape(shape, tolerance, &own, offset);
}

}  // namespace smokebox
