#include "fluid/paths_beside_solids.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

namespace {

double intoPeriod(double x, int n) {
  const double y = x - n * std::floor(x / n);
  return y >= 0 && y < n ? y : 0;  // what is not finite goes to 0
}

/// What is not a number goes to 0.
double clamped(double x, int n) { return x > 0 ? (x < n ? x : n) : 0; }

/// Interpolation between the four nearest samples; (x, y) in samples, from -1/2 to n + 1/2.
float bilinear(const Field& f, double x, double y) {
  const double fx = std::floor(x), fy = std::floor(y);
  const auto a = static_cast<float>(x - fx), b = static_cast<float>(y - fy);
  const float* p = f.row(static_cast<int>(fy)) + static_cast<int>(fx);
  const float* q = p + f.stride();
  return (1 - b) * ((1 - a) * p[0] + a * p[1]) + b * ((1 - a) * q[0] + a * q[1]);
}

int cellOf(double x, double direction) {
  const double cell = std::floor(x);
  return static_cast<int>(cell) - (cell == x && direction < 0 ? 1 : 0);
}

}  // namespace

PathsBesideSolids::Point PathsBesideSolids::wrapped(Point p) const {
  if (boundary_.periodicX()) p.x = intoPeriod(p.x, nx_);
  if (boundary_.periodicY()) p.y = intoPeriod(p.y, ny_);
  return p;
}

float PathsBesideSolids::uAt(Point p) const { return bilinear(u_, p.x, p.y - 0.5); }
float PathsBesideSolids::vAt(Point p) const { return bilinear(v_, p.x - 0.5, p.y); }

PathsBesideSolids::Point PathsBesideSolids::footOf(Point start) const {
  const float half = -0.5f * scale_;
  const Point middle = lastFluid(start, inWholeParts(half * uAt(start)), inWholeParts(half * vAt(start)));
  return lastFluid(start, inWholeParts(-scale_ * uAt(middle)), inWholeParts(-scale_ * vAt(middle)));
}

/// The end of a straight path, or where it first meets a shut face on its way from cell to cell (Amanatides
/// and Woo 1987). What would lie beyond a side is put on it.
PathsBesideSolids::Point PathsBesideSolids::lastFluid(Point from, float byX, float byY) const {
  Point to{from.x + byX, from.y + byY};
  if (!boundary_.periodicX()) to.x = clamped(to.x, nx_);
  if (!boundary_.periodicY()) to.y = clamped(to.y, ny_);
  const double dx = to.x - from.x, dy = to.y - from.y;
  // A start on a face belongs to the cell that the path leads into.
  int i = cellOf(from.x, dx), j = cellOf(from.y, dy);
  const int stepX = dx > 0 ? 1 : -1, stepY = dy > 0 ? 1 : -1;
  // Path parameter at the next crossing of a column's or a row's border; a path longer than the domain
  // tells no more.
  double t = 0;
  for (int crossings = 0; crossings < 2 * (nx_ + ny_); ++crossings) {
    const double tx = dx != 0 ? ((dx > 0 ? i + 1 : i) - from.x) / dx : 2;
    const double ty = dy != 0 ? ((dy > 0 ? j + 1 : j) - from.y) / dy : 2;
    if (!(std::min(tx, ty) < 1)) return wrapped(to);
    t = std::min(tx, ty);
    if (tx < ty) {
      if (!passesColumn(from.y, j, dy, dx > 0 ? i + 1 : i)) break;
      i += stepX;
    } else {
      if (!passesRow(from.x, i, dx, dy > 0 ? j + 1 : j)) break;
      j += stepY;
    }
  }
  return wrapped(
      {from.x + inWholeParts(static_cast<float>(t * dx)), from.y + inWholeParts(static_cast<float>(t * dy))});
}

/// Whether a path may cross the border of row j in column i, or, where it runs up a grid line, on either side
/// of that.
bool PathsBesideSolids::passesRow(double x, int i, double dx, int j) const {
  if (dx != 0 || std::floor(x) != x) return passes(boundary_.openY, i, j, false);
  const bool low = boundary_.periodicX() || i > 0, high = boundary_.periodicX() || i < nx_;
  return (!low || passes(boundary_.openY, i - 1, j, false)) &&
         (!high || passes(boundary_.openY, i, j, false));
}

bool PathsBesideSolids::passesColumn(double y, int j, double dy, int i) const {
  if (dy != 0 || std::floor(y) != y) return passes(boundary_.openX, i, j, true);
  const bool low = boundary_.periodicY() || j > 0, high = boundary_.periodicY() || j < ny_;
  return (!low || passes(boundary_.openX, i, j - 1, true)) && (!high || passes(boundary_.openX, i, j, true));
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
