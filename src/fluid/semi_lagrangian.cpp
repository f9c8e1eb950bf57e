#include "fluid/semi_lagrangian.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

namespace {

constexpr int kRowGrain = 8;

struct Point {  // in cells
  float x = 0, y = 0;
};

class Paths {
 public:
  Paths(const Boundary& boundary, const Field& u, const Field& v, double dt, bool anySolid)
      : boundary_(boundary),
        u_(u),
        v_(v),
        nx_(boundary.grid.nx),
        ny_(boundary.grid.ny),
        scale_(static_cast<float>(dt / boundary.grid.h)),
        anySolid_(anySolid) {}

  float carriedU(int i, int j) const {
    const Point foot = footOf({static_cast<float>(i), static_cast<float>(j) + 0.5f});
    return limitedCubic(u_, foot.x, foot.y - 0.5f);
  }
  float carriedV(int i, int j) const {
    const Point foot = footOf({static_cast<float>(i) + 0.5f, static_cast<float>(j)});
    return limitedCubic(v_, foot.x - 0.5f, foot.y);
  }

 private:
  static float wrapped(float x, int n) {
    const auto size = static_cast<float>(n);
    const float y = x - size * std::floor(x / size);
    return y >= 0 && y < size ? y : 0;  // what is not finite goes to 0
  }
  Point insideDomain(Point p) const {
    // fmin and fmax drop what is not a number.
    p.x =
        boundary_.periodicX() ? wrapped(p.x, nx_) : std::fmin(std::fmax(p.x, 0.0f), static_cast<float>(nx_));
    p.y =
        boundary_.periodicY() ? wrapped(p.y, ny_) : std::fmin(std::fmax(p.y, 0.0f), static_cast<float>(ny_));
    return p;
  }

  /// Interpolation between the four nearest samples; (x, y) in samples, from -1/2 to n + 1/2.
  static float bilinear(const Field& f, float x, float y) {
    const float fx = std::floor(x), fy = std::floor(y), a = x - fx, b = y - fy;
    const float* p = f.row(static_cast<int>(fy)) + static_cast<int>(fx);
    const float* q = p + f.stride();
    return (1 - b) * ((1 - a) * p[0] + a * p[1]) + b * ((1 - a) * q[0] + a * q[1]);
  }

  static float limitedCubic(const Field& f, float x, float y) {
    const float fx = std::floor(x), fy = std::floor(y);
    float wx[4], wy[4];
    weights(x - fx, wx);
    weights(y - fy, wy);
    const float* p = f.row(static_cast<int>(fy)) + static_cast<int>(fx);
    const std::ptrdiff_t stride = f.stride();
    float sum = 0;
    for (int k = 0; k < 4; ++k) {
      const float* q = p + (k - 1) * stride;
      sum += wy[k] * ((wx[0] * q[-1] + wx[3] * q[2]) + (wx[1] * q[0] + wx[2] * q[1]));
    }
    const float low = std::min(std::min(p[0], p[1]), std::min(p[stride], p[stride + 1]));
    const float high = std::max(std::max(p[0], p[1]), std::max(p[stride], p[stride + 1]));
    return std::min(std::max(sum, low), high);
  }

  /// Catmull-Rom.
  static void weights(float a, float* w) {
    const float a2 = a * a, a3 = a2 * a;
    w[0] = -0.5f * a + a2 - 0.5f * a3;
    w[1] = 1 - 2.5f * a2 + 1.5f * a3;
    w[2] = 0.5f * a + 2 * a2 - 1.5f * a3;
    w[3] = -0.5f * a2 + 0.5f * a3;
  }

  Point velocityAt(Point p) const { return {bilinear(u_, p.x, p.y - 0.5f), bilinear(v_, p.x - 0.5f, p.y)}; }

  Point footOf(Point start) const {
    const Point atStart = velocityAt(start);
    const Point middle =
        lastFluid(start, {start.x - 0.5f * scale_ * atStart.x, start.y - 0.5f * scale_ * atStart.y});
    const Point there = velocityAt(middle);
    return lastFluid(start, {start.x - scale_ * there.x, start.y - scale_ * there.y});
  }

  /// The end of a straight path, or where it first meets a shut face on its way from cell to cell (Amanatides
  /// and Woo 1987); inside the domain.
  Point lastFluid(Point from, Point to) const {
    if (!anySolid_) return insideDomain(to);
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

  static int cellOf(float x, float direction) {
    const float cell = std::floor(x);
    return static_cast<int>(cell) - (cell == x && direction < 0 ? 1 : 0);
  }

  /// Whether a path may cross a face; at the sides of the domain it ends, unless they are periodic.
  bool passes(const Field& open, int i, int j, bool alongX) const {
    if (boundary_.periodicX()) i = ((i % nx_) + nx_) % nx_;
    if (boundary_.periodicY()) j = ((j % ny_) + ny_) % ny_;
    const bool inside = alongX ? i > 0 - boundary_.periodicX() && i < nx_ && j >= 0 && j < ny_
                               : j > 0 - boundary_.periodicY() && j < ny_ && i >= 0 && i < nx_;
    return inside && open(i, j) > 0;
  }

  const Boundary& boundary_;
  const Field &u_, &v_;
  const int nx_, ny_;
  const float scale_;  // cells per m/s
  const bool anySolid_;
};

}  // namespace

void carrySemiLagrangian(const Boundary& boundary, const Field& u, const Field& v, double dt, bool anySolid,
                         ThreadPool& pool, Field& outU, Field& outV) {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  const int columns = boundary.periodicX() ? nx : nx + 1, rows = boundary.periodicY() ? ny : ny + 1;
  const Paths paths(boundary, u, v, dt, anySolid);
  pool.blocks(0, rows, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      if (j < ny)
        for (int i = 0; i < columns; ++i)
          if (boundary.openX(i, j) > 0) outU(i, j) = paths.carriedU(i, j);
      for (int i = 0; i < nx; ++i)
        if (boundary.openY(i, j) > 0) outV(i, j) = paths.carriedV(i, j);
    }
  });
}

}  // namespace smokebox
