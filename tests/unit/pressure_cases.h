// Boundaries and velocities for the tests and benchmarks of the pressure solver: shares of faces by sampling,
// thin walls by closing every face whose link they cross.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "fluid/boundary.h"

namespace smokebox::pressure_cases {

/// Uniform numbers in [0, 1), the same everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed * 2654435769u + 1) {}
  double operator()() {
    state_ = state_ * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<double>(state_ >> 33) / 2147483648.0;
  }

 private:
  std::uint64_t state_;
};

struct Solid {
  enum Kind { disk, box, sliver } kind;
  double x, y, a, b, cosine, sine;  // half extents a, b
};

/// `count` solids in a domain of the given size (m), a quarter disks, a quarter boxes, half thin walls.
inline std::vector<Solid> randomSolids(int count, double width, double height, double h,
                                       std::uint64_t seed = 7) {
  Random random(seed);
  std::vector<Solid> solids;
  const double scale = std::min(width, height);
  for (int k = 0; k < count; ++k) {
    Solid s{};
    s.kind = k % 4 == 0 ? Solid::disk : k % 4 == 1 ? Solid::box : Solid::sliver;
    s.x = (0.05 + 0.9 * random()) * width;
    s.y = (0.05 + 0.9 * random()) * height;
    const double angle = 6.28 * random();
    s.cosine = std::cos(angle);
    s.sine = std::sin(angle);
    const double size = 0.002 * std::pow(50.0, random()) * scale;
    s.a = size;
    s.b = size * (0.2 + random());
    if (s.kind == Solid::sliver) {
      s.a = (0.03 + 0.12 * random()) * scale;
      s.b = (k % 8 < 4 ? 0.15 * h : 0.002 * scale) * (0.3 + random());
    }
    solids.push_back(s);
  }
  return solids;
}

inline double distanceTo(const Solid& s, double x, double y) {
  const double px = x - s.x, py = y - s.y;
  if (s.kind == Solid::disk) return std::hypot(px, py) - s.a;
  const double u = std::fabs(s.cosine * px + s.sine * py) - s.a,
               v = std::fabs(-s.sine * px + s.cosine * py) - s.b;
  return std::max(u, v);
}

inline bool crosses(const Solid& s, double x0, double y0, double x1, double y1) {
  const double u0 = s.cosine * (x0 - s.x) + s.sine * (y0 - s.y),
               v0 = -s.sine * (x0 - s.x) + s.cosine * (y0 - s.y);
  const double u1 = s.cosine * (x1 - s.x) + s.sine * (y1 - s.y),
               v1 = -s.sine * (x1 - s.x) + s.cosine * (y1 - s.y);
  if ((v0 > 0) == (v1 > 0)) return false;
  const double t = v0 / (v0 - v1);
  return std::fabs(u0 + t * (u1 - u0)) <= s.a;
}

/// A box without solids; all sides of the same kind unless changed before `closeSides`.
inline Boundary emptyBox(int nx, int ny, double width = 1) {
  Boundary b;
  b.grid = {nx, ny, width / nx};
  b.openX = b.openY = b.volume = Field(nx, ny, 1);
  b.wallU = b.wallV = Field(nx, ny, 0);
  return b;
}

/// Sets the faces of the sides: open and periodic ones as they are, closed ones to 0.
inline void closeSides(Boundary& b) {
  const int nx = b.grid.nx, ny = b.grid.ny;
  const auto closed = [&](Side s) { return !b.open(s) && b.side(s).kind != WallKind::periodic; };
  for (int j = 0; j < ny; ++j) {
    if (closed(Side::left)) b.openX(0, j) = 0;
    if (closed(Side::right)) b.openX(nx, j) = 0;
    if (b.periodicX()) b.openX(nx, j) = b.openX(0, j);
  }
  for (int i = 0; i < nx; ++i) {
    if (closed(Side::bottom)) b.openY(i, 0) = 0;
    if (closed(Side::top)) b.openY(i, ny) = 0;
    if (b.periodicY()) b.openY(i, ny) = b.openY(i, 0);
  }
}

inline void putSolids(Boundary& b, const std::vector<Solid>& solids) {
  const int nx = b.grid.nx, ny = b.grid.ny, samples = 16;
  const double h = b.grid.h;
  const auto snap = [](double f) { return static_cast<float>(f < 1e-3 ? 0 : f > 1 - 1e-3 ? 1 : f); };
  const auto share = [&](const Solid& s, double x0, double y0, double x1, double y1) {
    int open = 0;
    for (int q = 0; q < samples; ++q) {
      const double t = (q + 0.5) / samples;
      open += distanceTo(s, x0 + t * (x1 - x0), y0 + t * (y1 - y0)) > 0;
    }
    return static_cast<double>(open) / samples;
  };
  for (const Solid& s : solids) {
    const double reach = std::hypot(s.a, s.kind == Solid::disk ? s.a : s.b) + 2 * h;
    const int i0 = std::max(0, static_cast<int>((s.x - reach) / h)),
              i1 = std::min(nx, static_cast<int>((s.x + reach) / h) + 1);
    const int j0 = std::max(0, static_cast<int>((s.y - reach) / h)),
              j1 = std::min(ny, static_cast<int>((s.y + reach) / h) + 1);
    for (int j = j0; j <= j1; ++j)
      for (int i = i0; i <= i1; ++i) {
        const double x = i * h, y = j * h, xc = x + h / 2, yc = y + h / 2;
        double fx = share(s, x, y, x, y + h), fy = share(s, x, y, x + h, y);
        if (s.kind == Solid::sliver) {
          if (crosses(s, x - h / 2, yc, x + h / 2, yc)) fx = 0;
          if (crosses(s, xc, y - h / 2, xc, y + h / 2)) fy = 0;
        }
        if (j < ny) b.openX(i, j) = std::min(b.openX(i, j), snap(fx));
        if (i < nx) b.openY(i, j) = std::min(b.openY(i, j), snap(fy));
        if (i < nx && j < ny)
          b.volume(i, j) = std::min(
              b.volume(i, j), static_cast<float>(std::clamp(distanceTo(s, xc, yc) / h + 0.5, 0.0, 1.0)));
      }
  }
}

/// A closed box with solids.
inline Boundary boxWithSolids(int nx, int ny, int count, std::uint64_t seed = 7) {
  Boundary b = emptyBox(nx, ny);
  putSolids(b, randomSolids(count, b.grid.width(), b.grid.height(), b.grid.h, seed));
  closeSides(b);
  return b;
}

/// Smooth waves and two jets.
inline void stir(const Boundary& b, Field& u, Field& v) {
  u = v = Field(b.grid.nx, b.grid.ny);
  const double s = 1 / b.grid.width();
  for (int j = 0; j <= b.grid.ny; ++j)
    for (int i = 0; i <= b.grid.nx; ++i) {
      double x = i * b.grid.h * s, y = (j + 0.5) * b.grid.h * s;
      u(i, j) = static_cast<float>(std::sin(7 * x) * std::cos(5 * y) + 0.5 * std::sin(31 * x + 11 * y) +
                                   (std::hypot(x - 0.3, y - 0.3) < 0.05 ? 1 : 0));
      x = (i + 0.5) * b.grid.h * s;
      y = j * b.grid.h * s;
      v(i, j) = static_cast<float>(std::cos(6 * x) * std::sin(4 * y) + 0.5 * std::cos(17 * x - 23 * y) +
                                   (std::hypot(x - 0.5, y - 0.2) < 0.06 ? 2 : 0));
    }
}

/// White noise in [-1, 1).
inline void shake(const Boundary& b, Field& u, Field& v, std::uint64_t seed) {
  u = v = Field(b.grid.nx, b.grid.ny);
  Random random(seed);
  for (int j = 0; j <= b.grid.ny; ++j)
    for (int i = 0; i <= b.grid.nx; ++i) {
      u(i, j) = static_cast<float>(2 * random() - 1);
      v(i, j) = static_cast<float>(2 * random() - 1);
    }
}

/// Net flux out of cell (i, j), straight from its definition, m/s.
inline double netFlux(const Boundary& b, const Field& u, const Field& v, int i, int j) {
  const auto face = [](const Field& open, const Field& velocity, const Field& wall, int k, int l) {
    return static_cast<double>(open(k, l)) * velocity(k, l) + (1.0 - open(k, l)) * wall(k, l);
  };
  return face(b.openX, u, b.wallU, i + 1, j) - face(b.openX, u, b.wallU, i, j) +
         face(b.openY, v, b.wallV, i, j + 1) - face(b.openY, v, b.wallV, i, j);
}

inline bool inUse(const Boundary& b, int i, int j) {
  return b.openX(i, j) > 0 || b.openX(i + 1, j) > 0 || b.openY(i, j) > 0 || b.openY(i, j + 1) > 0;
}

/// Largest |net flux| of the cells with an open face, over the largest speed on an open face.
inline double worstDivergence(const Boundary& b, const Field& u, const Field& v) {
  double worst = 0, speed = 0;
  for (int j = 0; j <= b.grid.ny; ++j)
    for (int i = 0; i <= b.grid.nx; ++i) {
      if (j < b.grid.ny && b.openX(i, j) > 0)
        speed = std::max(speed, std::fabs(static_cast<double>(u(i, j))));
      if (i < b.grid.nx && b.openY(i, j) > 0)
        speed = std::max(speed, std::fabs(static_cast<double>(v(i, j))));
      if (i < b.grid.nx && j < b.grid.ny && inUse(b, i, j))
        worst = std::max(worst, std::fabs(netFlux(b, u, v, i, j)));
    }
  return speed > 0 ? worst / speed : worst;
}

}  // namespace smokebox::pressure_cases
