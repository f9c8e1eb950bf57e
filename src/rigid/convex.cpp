#include "rigid/convex.h"

#include <algorithm>
#include <utility>

#include "geometry/shape.h"

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
  Vec2 mean;
  for (std::size_t k = 0; k < n; ++k) {
    mean = mean + (1.0 / static_cast<double>(n)) * piece.points[k];
    if (edges == 0) break;
    const Vec2 along = piece.points[k + 1 < n ? k + 1 : 0] - piece.points[k];
    const double size = length(along);
    piece.normals[k] = size > 0 ? Vec2{along.y / size, -along.x / size} : Vec2{};
  }
  constexpr std::size_t kFour = 4;
  piece.fours.assign((edges + kFour - 1) / kFour,
                     {ConvexPiece::Lanes{} + piece.points[0].x, ConvexPiece::Lanes{} + piece.points[0].y,
                      ConvexPiece::Lanes{}, ConvexPiece::Lanes{}, ConvexPiece::Lanes{} + 1e300});
  for (std::size_t k = 0; k < edges; ++k) {
    ConvexPiece::Four& four = piece.fours[k / kFour];
    four.cornerX[k % kFour] = piece.points[k].x;
    four.cornerY[k % kFour] = piece.points[k].y;
    four.normalX[k % kFour] = piece.normals[k].x;
    four.normalY[k % kFour] = piece.normals[k].y;
    four.out[k % kFour] = dot(piece.normals[k], piece.points[k]);
  }
  const MassProperties mass = n > 2 ? massProperties({piece.points}) : MassProperties{};
  piece.centre = mass.area > 0 ? mass.centre : mean;
  piece.reach = 0;
  piece.within = edges > 0 ? 1e300 : 0;
  for (std::size_t k = 0; k < n; ++k) {
    piece.reach = std::max(piece.reach, length(piece.points[k] - piece.centre));
    if (edges > 0)
      piece.within = std::min(piece.within, dot(piece.normals[k], piece.points[k] - piece.centre));
  }
  piece.within = std::max(piece.within, 0.0);
  piece.reach += piece.radius;
  const auto inside = std::count_if(piece.inner.begin(), piece.inner.end(), [](auto is) { return is != 0; });
  piece.whole = inside == 0;
  piece.buried = edges > 0 && inside == static_cast<std::ptrdiff_t>(edges);
}

}  // namespace smokebox
