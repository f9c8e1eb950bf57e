// Where a path that leads to a face through cells beside solids began: the careful way of
// semi_lagrangian.cpp, a face at a time.
#pragma once
#include "fluid/boundary.h"

namespace smokebox {

class PathsBesideSolids {
 public:
  PathsBesideSolids(const Boundary& boundary, const Field& u, const Field& v, double dt)
      : boundary_(boundary),
        u_(u),
        v_(v),
        nx_(boundary.grid.nx),
        ny_(boundary.grid.ny),
        scale_(static_cast<float>(dt / boundary.grid.h)) {}

  struct Point {  // in cells
    float x = 0, y = 0;
  };
  /// The foot of the path to the x-face (i, j); inside the domain.
  Point footOfU(int i, int j) const { return footOf({static_cast<float>(i), static_cast<float>(j) + 0.5f}); }
  /// The same to the y-face (i, j).
  Point footOfV(int i, int j) const { return footOf({static_cast<float>(i) + 0.5f, static_cast<float>(j)}); }

 private:
  Point insideDomain(Point p) const;
  Point velocityAt(Point p) const;
  Point footOf(Point start) const;
  Point lastFluid(Point from, Point to) const;
  bool passes(const Field& open, int i, int j, bool alongX) const;

  const Boundary& boundary_;
  const Field &u_, &v_;
  const int nx_, ny_;
  const float scale_;  // cells per m/s
};

}  // namespace smokebox
