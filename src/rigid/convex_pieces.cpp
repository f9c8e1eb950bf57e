// Regions as convex pieces: triangles first, then every diagonal is taken out that no corner needs.
#include <algorithm>
#include <cmath>

#include "geometry/merge.h"
#include "rigid/clean_outlines.h"
#include "rigid/pieces.h"
#include "rigid/triangulate.h"

namespace smokebox {
namespace {

/// Corners of all outlines one after the other.
struct Region {
  std::vector<Vec2> points;
  std::vector<Vec2> drawnIn;   // the same a little farther inside: outlines that touch in a corner come apart
  std::vector<int> ends;       // one past the last corner of each outline
  std::vector<int> following;  // [corner]: the next on its outline
  std::vector<Vec2> normals;   // [corner]: of the outline's edge from there
  std::vector<std::array<Vec2, 2>> cones;
  double extent = 0;
};

Region regionOf(const std::vector<Outline>& outlines) {
  Region region;
  region.extent = extentOf(outlines);
  Outline drawnIn;
  for (const Outline& outline : cleanOutlines(outlines)) {
    const int first = static_cast<int>(region.points.size()), n = static_cast<int>(outline.size());
    growOutline(outline, -1e-8 * region.extent, drawnIn);
    region.drawnIn.insert(region.drawnIn.end(), drawnIn.begin(), drawnIn.end());
    for (int k = 0; k < n; ++k) {
      const Vec2 along = outline[(k + 1) % n] - outline[k];
      const double size = length(along);
      region.points.push_back(outline[k]);
      region.following.push_back(first + (k + 1) % n);
      region.normals.push_back({along.y / size, -along.x / size});
    }
    for (int k = 0; k < n; ++k) {
      const Vec2 before = region.normals[first + (k + n - 1) % n], after = region.normals[first + k];
      region.cones.push_back(cross(before, after) > 0 ? std::array<Vec2, 2>{before, after}
                                                      : std::array<Vec2, 2>{});
    }
    region.ends.push_back(first + n);
  }
  return region;
}

/// A directed edge of a piece; `twin` is the same edge of the neighbour.
struct HalfEdge {
  int from, to, next, previous, twin = -1;
  bool removed = false, seen = false;
};

std::vector<HalfEdge> halfEdges(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<HalfEdge> edges;
  for (const auto& t : triangles) {
    const int first = static_cast<int>(edges.size());
    for (int k = 0; k < 3; ++k)
      edges.push_back({t[k], t[(k + 1) % 3], first + (k + 1) % 3, first + (k + 2) % 3});
  }
  std::vector<int> order(edges.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = static_cast<int>(k);
  auto key = [&](int k) {
    const auto [lower, upper] = std::minmax(edges[k].from, edges[k].to);
    return std::array<int, 3>{lower, upper, k};
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  for (std::size_t k = 0; k + 1 < order.size(); ++k) {
    HalfEdge &a = edges[order[k]], &b = edges[order[k + 1]];
    if (a.from != b.to || a.to != b.from || a.twin >= 0) continue;
    a.twin = order[k + 1];
    b.twin = order[k];
  }
  return edges;
}

/// Longest first: the slivers go.
void removeDiagonals(const Region& region, std::vector<HalfEdge>& edges) {
  std::vector<std::pair<double, int>> diagonals;
  for (std::size_t k = 0; k < edges.size(); ++k)
    if (edges[k].twin > static_cast<int>(k))
      diagonals.emplace_back(-length(region.points[edges[k].to] - region.points[edges[k].from]), k);
  std::sort(diagonals.begin(), diagonals.end());
  // Edges between outlines that touch have a direction only where these are drawn in.
  auto convex = [&](const HalfEdge& in, const HalfEdge& out) {
    const Vec2 corner = region.points[in.to], drawn = region.drawnIn[in.to];
    const Vec2 drawnIn = drawn - region.drawnIn[in.from], drawnOut = region.drawnIn[out.to] - drawn;
    return cross(corner - region.points[in.from], region.points[out.to] - corner) >= 0 &&
           cross(drawnIn, drawnOut) >= -1e-5 * length(drawnIn) * length(drawnOut);
  };
  for (const auto& [size, k] : diagonals) {
    HalfEdge &a = edges[k], &b = edges[a.twin];
    if (!convex(edges[a.previous], edges[b.next]) || !convex(edges[b.previous], edges[a.next])) continue;
    edges[a.previous].next = b.next;
    edges[b.next].previous = a.previous;
    edges[b.previous].next = a.next;
    edges[a.next].previous = b.previous;
    a.removed = b.removed = true;
  }
}

}  // namespace

std::vector<ConvexPiece> convexPieces(const std::vector<Outline>& outlines) {
  const Region region = regionOf(outlines);
  std::vector<ConvexPiece> pieces;
  const auto isReflex = [](const std::array<Vec2, 2>& cone) { return cone[0] == Vec2{}; };
  if (region.ends.size() == 1 && std::none_of(region.cones.begin(), region.cones.end(), isReflex)) {
    pieces.push_back(makePiece(region.points, 0));
    return pieces;
  }
  std::vector<HalfEdge> edges = halfEdges(triangulate(region.drawnIn, region.ends));
  removeDiagonals(region, edges);
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (edges[k].removed || edges[k].seen) continue;
    ConvexPiece piece;
    for (int at = static_cast<int>(k); !edges[at].seen; at = edges[at].next) {
      const int corner = edges[at].from;
      edges[at].seen = true;
      if (length(region.points[edges[at].to] - region.points[corner]) < 1e-8 * region.extent) continue;
      piece.points.push_back(region.points[corner]);
      piece.inner.push_back(region.following[corner] == edges[at].to ? 0 : 1);
      piece.cones.push_back(region.cones[corner]);
    }
    if (piece.points.size() < 3) continue;
    finishPiece(piece);
    if (piece.whole) piece.cones.clear();
    pieces.push_back(std::move(piece));
  }
  return pieces;
}

}  // namespace smokebox
