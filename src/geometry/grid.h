// A uniform grid of square cells with its lower left corner at the origin.
#pragma once
#include "geometry/vec2.h"

namespace smokebox {

struct Grid {
  int nx = 0, ny = 0;
  double h = 0;  // edge of a cell, m

  double width() const { return nx * h; }
  double height() const { return ny * h; }
  long cells() const { return static_cast<long>(nx) * ny; }
  Vec2 cellCentre(int i, int j) const { return {(i + 0.5) * h, (j + 0.5) * h}; }
  Vec2 xFaceCentre(int i, int j) const { return {i * h, (j + 0.5) * h}; }
  Vec2 yFaceCentre(int i, int j) const { return {(i + 0.5) * h, j * h}; }
  bool operator==(const Grid&) const = default;
};

}  // namespace smokebox
