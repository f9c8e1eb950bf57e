// Boundaries filled by hand, so that the velocity stages are tested by themselves.
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

constexpr std::array<WallKind, 4> kPeriodic{WallKind::periodic, WallKind::periodic, WallKind::periodic,
                                            WallKind::periodic};
constexpr std::array<WallKind, 4> kSlipBox{WallKind::slip, WallKind::slip, WallKind::slip, WallKind::slip};

}  // namespace smokebox::test
