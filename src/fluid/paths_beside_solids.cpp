#include "fluid/paths_beside_solids.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

namespace {

float wrapped(float x, int n) {
  const auto size = static_cast<float>(n);
  const float y = x - size * std::floor(x / size);
  return y >= 0 && y < size ? y : 0;  // what is not finite goes to 0
}

/// What is not a number goes to 0.
float clamped(float x, int n) {
  const auto size = static_cast<float>(n);
  return x > 0 ? (x < size ? x : size) : 0;
}

/// Interpolation between the four nearest samples; (x, y) in samples, from -1/2 to n + 1/2.
float bilinear(const Field& f, float x, float y) {
  const float fx = std::floor(x), fy = std::floor(y), a = x - fx, b = y - fy;
  const float* p = f.row(static_cast<int>(fy)) + static_cast<int>(fx);
  const float* q = p + f.stride();
  return (1 - b) * ((1 - a) * p[0] + a * p[1]) + b * ((1 - a) * q[0] + a * q[1]);
}

int cellOf(float x, float direction) {
  const float cell = std::floor(x);
  return static_cast<int>(cell) - (cell == x && direction < 0 ? 1 : 0);
}

}  // namespace

PathsBesideSolids::Point PathsBesideSolids::insideDomain(Point p) const {
  p.x = boundary_.periodicX() ? wrapped(p.x, nx_) : clamped(p.x, nx_);
  p.y = boundary_.periodicY() ? wrapped(p.y, ny_) : clamped(p.y, ny_);
  return p;
}

PathsBesideSolids::Point PathsBesideSolids::velocityAt(Point p) const {
  return {bilinear(u_, p.x, p.y - 0.5f), bilinear(v_, p.x - 0.5f, p.y)};
}

PathsBesideSolids::Point PathsBesideSolids::footOf(Point start) const {
  const Point atStart = velocityAt(start);
  const Point middle =
      lastFluid(start, {start.x - 0.5f * scale_ * atStart.x, start.y - 0.5f * scale_ * atStart.y});
  const Point there = velocityAt(middle);
  return lastFluid(start, {start.x - scale_ * there.x, start.y - scale_ * there.y});
}

/// The end of a straight path, or where it first meets a shut face on its way from cell to cell (Amanatides
/// and Woo 1987); inside the domain.
PathsBesideSolids::Point PathsBesideSolids::lastFluid(Point from, Point to) const {
  const float dx = to.x - from.x, dy = to.y - from.y;
  // A start on a face belongs to the cell that the path leads into.
  int i = cellOf(from.x, dx), j = cellOf(from.y, dy);
  const int stepX = dx > 0 ? 1 : -1, stepY = dy > 0 ? 1 : -1;
  // Path parameter at the next crossing of a column's or a row's border; a path longer than the domain
  // tells no more.
  float t = 0;
  for (int crossings = 0; crossings < 2 * (nx_ + ny_); ++crossings) {
    const float tx = dx != 0 ? (static_cast<float>(dx > 0 ? i + 1 : i) - from.x) / dx : 2;
    const float ty = dy != 0 ? (static_cast<float>(dy > 0 ? j + 1 : j) - from.y) / dy : 2;
    if (!(std::min(tx, ty) < 1)) return insideDomain(to);
    t = std::min(tx, ty);
    if (tx < ty) {
      if (!passes(boundary_.openX, dx > 0 ? i + 1 : i, j, true)) break;
      i += stepX;
    } else {
      if (!passes(boundary_.openY, i, dy > 0 ? j + 1 : j, false)) break;
      j += stepY;
    }
  }
  return insideDomain({from.x + t * dx, from.y + t * dy});
}

/// Whether a path may cross a face; at the sides of the domain it ends, unless they are periodic.
bool PathsBesideSolids::passes(const Field& open, int i, int j, bool alongX) const {
  if (boundary_.periodicX()) i = ((i % nx_) + nx_) % nx_;
  if (boundary_.periodicY()) j = ((j % ny_) + ny_) % ny_;
  const bool inside = alongX ? i > 0 - boundary_.periodicX() && i < nx_ && j >= 0 && j < ny_
                             : j > 0 - boundary_.periodicY() && j < ny_ && i >= 0 && i < nx_;
  return inside && open(i, j) > 0;
}

}  // namespace smokebox
