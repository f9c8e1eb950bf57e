#include "rigid/convex.h"

#include <algorithm>
#include <utility>

namespace smokebox {

ConvexPiece makePiece(std::vector<Vec2> points, double radius) {
  ConvexPiece piece;
  piece.points = std::move(points);
  piece.radius = radius;
  finishPiece(piece);
  return piece;
}

void finishPiece(ConvexPiece& piece) {
  const std::size_t n = piece.points.size(), edges = n > 1 ? n : 0;
  piece.normals.resize(edges);
  piece.inner.resize(edges, 0);
  Vec2 lo = piece.points[0], hi = lo;
  for (std::size_t k = 0; k < edges; ++k) {
    const Vec2 p = piece.points[k], along = piece.points[k + 1 < n ? k + 1 : 0] - p;
    const double size = length(along);
    piece.normals[k] = size > 0 ? Vec2{along.y / size, -along.x / size} : Vec2{};
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
  }
  piece.centre = 0.5 * (lo + hi);
  piece.reach = 0;
  for (Vec2 p : piece.points) piece.reach = std::max(piece.reach, length(p - piece.centre));
  piece.reach += piece.radius;
  const auto inside = std::count_if(piece.inner.begin(), piece.inner.end(), [](auto is) { return is != 0; });
  piece.whole = inside == 0;
  piece.buried = edges > 0 && inside == static_cast<std::ptrdiff_t>(edges);
}

}  // namespace smokebox
