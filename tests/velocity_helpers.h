// Boundaries filled by hand and a plain projection, so that the velocity stages are tested by themselves.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "fluid/boundary.h"

namespace smokebox::test {

/// A rectangle without solids; sides: left, right, bottom, top.
inline Boundary makeBox(int nx, int ny, double h, std::array<WallKind, 4> kinds) {
  Boundary b;
  b.grid = {nx, ny, h};
  for (int s = 0; s < 4; ++s) b.sides[s].kind = kinds[s];
  b.openX = Field(nx, ny, 1);
  b.openY = Field(nx, ny, 1);
  b.volume = Field(nx, ny, 1);
  b.wallU = Field(nx, ny);
  b.wallV = Field(nx, ny);
  auto closed = [&](Side s) {
    return b.side(s).kind != WallKind::open && b.side(s).kind != WallKind::periodic;
  };
  for (int j = 0; j < ny; ++j) {
    if (closed(Side::left)) b.openX(0, j) = 0;
    if (closed(Side::right)) b.openX(nx, j) = 0;
  }
  for (int i = 0; i < nx; ++i) {
    if (closed(Side::bottom)) b.openY(i, 0) = 0;
    if (closed(Side::top)) b.openY(i, ny) = 0;
  }
  b.version = 1;
  return b;
}

/// Closes what lies inside a solid (negative distance) that moves at a velocity; fractions by the distances
/// at the ends of a face, links by bisection.
inline void addSolid(Boundary& b, const std::function<double(Vec2)>& distance,
                     const std::function<Vec2(Vec2)>& velocity, double drag) {
  const int nx = b.grid.nx, ny = b.grid.ny;
  const double h = b.grid.h;
  auto openShare = [&](Vec2 p, Vec2 q) {
    const double a = distance(p), c = distance(q);
    double share = a > 0 && c > 0 ? 1 : a <= 0 && c <= 0 ? 0 : std::max(a, c) / (std::fabs(a) + std::fabs(c));
    if (share < Boundary::kSmallestOpening) share = 0;
    return static_cast<float>(share);
  };
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      const Vec2 corner{i * h, j * h}, right{(i + 1) * h, j * h}, above{i * h, (j + 1) * h};
      if (j < ny) {
        const float share = openShare(corner, above);
        if (share < b.openX(i, j)) {
          b.openX(i, j) = share;
          b.wallU(i, j) = static_cast<float>(velocity(b.grid.xFaceCentre(i, j)).x);
        }
      }
      if (i < nx) {
        const float share = openShare(corner, right);
        if (share < b.openY(i, j)) {
          b.openY(i, j) = share;
          b.wallV(i, j) = static_cast<float>(velocity(b.grid.yFaceCentre(i, j)).y);
        }
      }
    }
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      if (b.openX(i, j) == 0 && b.openX(i + 1, j) == 0 && b.openY(i, j) == 0 && b.openY(i, j + 1) == 0)
        b.volume(i, j) = 0;
  for (int component = 0; component < 2; ++component) {
    auto& links = component ? b.linksV : b.linksU;
    const Field& open = component ? b.openY : b.openX;
    const int columns = component ? nx : nx + 1, rows = component ? ny + 1 : ny;
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        if (!(open(i, j) > 0)) continue;
        const Vec2 from = component ? b.grid.yFaceCentre(i, j) : b.grid.xFaceCentre(i, j);
        for (const auto& d : {std::array{1, 0}, std::array{-1, 0}, std::array{0, 1}, std::array{0, -1}}) {
          const Vec2 step{d[0] * h, d[1] * h};
          if (distance(from + step) > 0 && distance(from) > 0) continue;
          double low = 0, high = 1;
          for (int k = 0; k < 50; ++k) {
            const double middle = 0.5 * (low + high);
            (distance(from + middle * step) > 0 ? low : high) = middle;
          }
          if (distance(from) <= 0) low = 0;
          CutLink link;
          link.i = i, link.j = j, link.di = d[0], link.dj = d[1];
          link.theta = static_cast<float>(std::max(low, 1e-3));
          link.drag = static_cast<float>(drag);
          const Vec2 wall = velocity(from + low * step);
          link.velocity = static_cast<float>(component ? wall.y : wall.x);
          link.solid = 0;
          links.push_back(link);
        }
      }
    std::stable_sort(links.begin(), links.end(),
                     [](const CutLink& p, const CutLink& q) { return p.j != q.j ? p.j < q.j : p.i < q.i; });
  }
  ++b.version;
}

/// Projection by conjugate gradients in double, to rounding: slow, and plain enough to be trusted.
class PlainProjection {
 public:
  explicit PlainProjection(const Boundary& b) : b_(b), nx_(b.grid.nx), ny_(b.grid.ny) {}

  /// phi, if given, has the increment added.
  void project(Field& u, Field& v, Field* phi, double tolerance = 1e-10) const {
    const Field &ox = b_.openX, &oy = b_.openY;
    const int n = nx_ * ny_;
    std::vector<double> rhs(n), x(n, 0.0), r, p, ap(n);
    closeWalls(u, v);
    double largest = 0;
    for (int j = 0; j < ny_; ++j)
      for (int i = 0; i < nx_; ++i) {
        const double out = (flux(ox, b_.wallU, u, i + 1, j) - flux(ox, b_.wallU, u, i, j)) +
                           (flux(oy, b_.wallV, v, i, j + 1) - flux(oy, b_.wallV, v, i, j));
        rhs[j * nx_ + i] = -out;
        largest = std::max(largest, std::fabs(out));
      }
    r = rhs;
    p = r;
    double rho = dot(r, r);
    const double enough = tolerance * tolerance * std::max(rho, 1e-30);
    for (int k = 0; k < 20 * (nx_ + ny_) && rho > enough; ++k) {
      apply(p, ap);
      const double curvature = dot(p, ap);
      if (!(curvature > 0)) break;
      const double alpha = rho / curvature;
      for (int m = 0; m < n; ++m) x[m] += alpha * p[m], r[m] -= alpha * ap[m];
      const double last = rho;
      rho = dot(r, r);
      for (int m = 0; m < n; ++m) p[m] = r[m] + rho / last * p[m];
    }
    auto at = [&](int i, int j) { return value(x, i, j); };
    for (int j = 0; j <= ny_; ++j)
      for (int i = 0; i <= nx_; ++i) {
        if (j < ny_ && ox(i, j) > 0) u(i, j) -= static_cast<float>(at(i, j) - at(i - 1, j));
        if (i < nx_ && oy(i, j) > 0) v(i, j) -= static_cast<float>(at(i, j) - at(i, j - 1));
      }
    if (phi)
      for (int j = 0; j < ny_; ++j)
        for (int i = 0; i < nx_; ++i) (*phi)(i, j) += static_cast<float>(x[j * nx_ + i]);
  }

 private:
  static double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double s = 0;
    for (std::size_t k = 0; k < a.size(); ++k) s += a[k] * b[k];
    return s;
  }
  double flux(const Field& open, const Field& wall, const Field& f, int i, int j) const {
    if (i == nx_ && b_.periodicX()) i = 0;
    if (j == ny_ && b_.periodicY()) j = 0;
    const double a = open(i, j);
    return a * f(i, j) + (1 - a) * wall(i, j);
  }
  double value(const std::vector<double>& x, int i, int j) const {
    if (b_.periodicX()) i = (i + nx_) % nx_;
    if (b_.periodicY()) j = (j + ny_) % ny_;
    return i < 0 || j < 0 || i >= nx_ || j >= ny_ ? 0 : x[j * nx_ + i];
  }
  double share(const Field& open, int i, int j) const {
    return open(i == nx_ && b_.periodicX() ? 0 : i, j == ny_ && b_.periodicY() ? 0 : j);
  }
  void apply(const std::vector<double>& x, std::vector<double>& out) const {
    for (int j = 0; j < ny_; ++j)
      for (int i = 0; i < nx_; ++i) {
        const double here = x[j * nx_ + i];
        out[j * nx_ + i] = share(b_.openX, i, j) * (here - value(x, i - 1, j)) +
                           share(b_.openX, i + 1, j) * (here - value(x, i + 1, j)) +
                           share(b_.openY, i, j) * (here - value(x, i, j - 1)) +
                           share(b_.openY, i, j + 1) * (here - value(x, i, j + 1));
      }
  }
  void closeWalls(Field& u, Field& v) const {
    for (int j = 0; j <= ny_; ++j)
      for (int i = 0; i <= nx_; ++i) {
        if (j < ny_ && b_.openX(i, j) == 0) u(i, j) = b_.wallU(i, j);
        if (i < nx_ && b_.openY(i, j) == 0) v(i, j) = b_.wallV(i, j);
      }
  }

  const Boundary& b_;
  int nx_, ny_;
};

constexpr std::array<WallKind, 4> kPeriodic{WallKind::periodic, WallKind::periodic, WallKind::periodic,
                                            WallKind::periodic};
constexpr std::array<WallKind, 4> kSlipBox{WallKind::slip, WallKind::slip, WallKind::slip, WallKind::slip};

}  // namespace smokebox::test
