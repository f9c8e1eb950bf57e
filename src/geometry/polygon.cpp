// Areas, moments and tests of polygons, from their corners alone.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include "geometry/shape.h"

namespace smokebox {

double signedArea(const Outline& outline) {
  if (outline.size() < 3) return 0;
  const Vec2 origin = outline[0];  // keeps the products small for outlines far from (0, 0)
  double twice = 0;
  for (std::size_t k = 1; k + 1 < outline.size(); ++k)
    twice += cross(outline[k] - origin, outline[k + 1] - origin);
  return twice / 2;
}

MassProperties massProperties(const std::vector<Outline>& outlines) {
  MassProperties mass;
  if (outlines.empty() || outlines[0].empty()) return mass;
  // Sums over the triangles (origin, a, b) of each edge; holes run clockwise and subtract by themselves.
  const Vec2 origin = outlines[0][0];
  double area = 0, polar = 0;
  Vec2 first;
  for (const Outline& outline : outlines)
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vec2 a = outline[k] - origin, b = outline[k + 1 < outline.size() ? k + 1 : 0] - origin;
      const double doubled = cross(a, b);
      area += doubled / 2;
      first = first + (doubled / 6) * (a + b);
      polar += doubled / 12 * (dot(a, a) + dot(a, b) + dot(b, b));
    }
  mass.area = area;
  if (area == 0) {
    mass.centre = origin;
    return mass;
  }
  const Vec2 centre = (1 / area) * first;
  mass.centre = origin + centre;
  mass.secondMoment = polar - area * dot(centre, centre);
  return mass;
}

bool contains(const std::vector<Outline>& outlines, Vec2 point) {
  bool inside = false;
  for (const Outline& outline : outlines)
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vec2 a = outline[k], b = outline[k + 1 < outline.size() ? k + 1 : 0];
      if ((a.y > point.y) == (b.y > point.y)) continue;
      if (point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
    }
  return inside;
}

namespace {

std::string text(Vec2 p) {
  std::ostringstream out;
  out << '(' << p.x << ',' << p.y << ')';
  return out.str();
}

std::string edgeText(const std::vector<Vec2>& points, std::size_t k) {
  return "edge " + std::to_string(k + 1) + " " + text(points[k]) + "-" +
         text(points[(k + 1) % points.size()]);
}

enum class Meeting { none, touch, cross };

/// How two segments meet. Within `slack` (an area) of a line counts as on it.
Meeting meeting(Vec2 a, Vec2 b, Vec2 c, Vec2 d, double slack) {
  auto side = [slack](Vec2 p, Vec2 q, Vec2 r) {
    const double area = cross(q - p, r - p);
    return area > slack ? 1 : area < -slack ? -1 : 0;
  };
  const int c1 = side(a, b, c), d1 = side(a, b, d), a2 = side(c, d, a), b2 = side(c, d, b);
  if (c1 * d1 < 0 && a2 * b2 < 0) return Meeting::cross;
  auto within = [](Vec2 p, Vec2 q, Vec2 r) {  // r lies on the line of p and q: between them?
    return dot(r - p, r - q) <= 0;
  };
  if ((c1 == 0 && within(a, b, c)) || (d1 == 0 && within(a, b, d)) || (a2 == 0 && within(c, d, a)) ||
      (b2 == 0 && within(c, d, b)))
    return Meeting::touch;
  return Meeting::none;
}

/// Two edges that meet where they should not; a sweep along x over the edges' boxes.
std::string crossingFault(const std::vector<Vec2>& points, double slack) {
  struct Edge {
    double xLo, xHi, yLo, yHi;
    std::size_t index;
  };
  const std::size_t n = points.size();
  std::vector<Edge> edges(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 a = points[k], b = points[(k + 1) % n];
    edges[k] = {std::min(a.x, b.x), std::max(a.x, b.x), std::min(a.y, b.y), std::max(a.y, b.y), k};
  }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.xLo != b.xLo ? a.xLo < b.xLo : a.index < b.index; });
  std::vector<Edge> active;
  for (const Edge& edge : edges) {
    std::erase_if(active, [&](const Edge& other) { return other.xHi < edge.xLo; });
    for (const Edge& other : active) {
      if (other.yHi < edge.yLo || other.yLo > edge.yHi) continue;
      const std::size_t lower = std::min(edge.index, other.index), upper = std::max(edge.index, other.index);
      if (upper - lower == 1 || (lower == 0 && upper == n - 1))
        continue;  // neighbours: looked at by themselves
      const Meeting how =
          meeting(points[lower], points[lower + 1], points[upper], points[(upper + 1) % n], slack);
      if (how == Meeting::none) continue;
      return edgeText(points, lower) + (how == Meeting::cross ? " crosses " : " touches ") +
             edgeText(points, upper);
    }
    active.push_back(edge);
  }
  return {};
}

}  // namespace

std::string polygonFault(const std::vector<Vec2>& points) {
  const std::size_t n = points.size();
  if (n < 3) return "a polygon needs at least 3 points, this one has " + std::to_string(n);
  Vec2 lo = points[0], hi = points[0];
  for (std::size_t k = 0; k < n; ++k) {
    if (!std::isfinite(points[k].x) || !std::isfinite(points[k].y))
      return "point " + std::to_string(k + 1) + " is not finite";
    lo = {std::min(lo.x, points[k].x), std::min(lo.y, points[k].y)};
    hi = {std::max(hi.x, points[k].x), std::max(hi.y, points[k].y)};
  }
  const double extent = std::max(hi.x - lo.x, hi.y - lo.y);
  const double slack = 1e-13 * extent * extent;
  for (std::size_t k = 0; k < n; ++k)
    if (length(points[(k + 1) % n] - points[k]) <= 1e-12 * extent)
      return edgeText(points, k) + " has no length";
  double widest = 0;
  for (std::size_t k = 2; k < n; ++k)
    widest = std::max(widest, std::fabs(cross(points[1] - points[0], points[k] - points[0])));
  if (widest <= slack) return "all points lie on one line: the polygon has no area";
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 before = points[(k + 1) % n] - points[k], after = points[(k + 2) % n] - points[(k + 1) % n];
    if (std::fabs(cross(before, after)) <= 1e-12 * length(before) * length(after) && dot(before, after) < 0)
      return edgeText(points, k) + " is folded back by " + edgeText(points, (k + 1) % n);
  }
  if (std::string fault = crossingFault(points, slack); !fault.empty()) return fault;
  if (std::fabs(signedArea(points)) <= slack) return "the polygon has no area";
  return {};
}

}  // namespace smokebox
