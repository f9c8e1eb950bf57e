// Where a path that leads to a face through cells beside solids began: the careful way of
// semi_lagrangian.cpp, a face at a time. Where no solid is met, to the bit what that finds.
#pragma once
#include <cmath>

#include "fluid/boundary.h"

namespace smokebox {

/// A distance in cells as a whole multiple of 2^-17: how far a place is beyond a sample, and how far the next
/// one is from it, are then exact, and mirror images alike, for up to 64 cells.
inline float inWholeParts(float cells) {
  constexpr float kParts = 1 << 17;
  return std::nearbyint(cells * kParts) * (1 / kParts);
}

class PathsBesideSolids {
 public:
  PathsBesideSolids(const Boundary& boundary, const Field& u, const Field& v, double dt)
      : boundary_(boundary),
        u_(u),
        v_(v),
        nx_(boundary.grid.nx),
        ny_(boundary.grid.ny),
        scale_(static_cast<float>(dt / boundary.grid.h)) {}

  struct Point {  // in cells, exact
    double x = 0, y = 0;
  };
  /// The foot of the path to the x-face (i, j); inside the domain.
  Point footOfU(int i, int j) const { return footOf({static_cast<double>(i), j + 0.5}); }
  /// The same to the y-face (i, j).
  Point footOfV(int i, int j) const { return footOf({i + 0.5, static_cast<double>(j)}); }

 private:
  /// From a displacement in cells.
  Point lastFluid(Point from, float dx, float dy) const;
  Point footOf(Point start) const;
  Point wrapped(Point p) const;
  float uAt(Point p) const;
  float vAt(Point p) const;
  bool passes(const Field& open, int i, int j, bool alongX) const;
  bool passesRow(double x, int i, double dx, int j) const;
  bool passesColumn(double y, int j, double dy, int i) const;

  const Boundary& boundary_;
  const Field &u_, &v_;
  const int nx_, ny_;
  const float scale_;  // cells per m/s
};

}  // namespace smokebox
