// What the springs of a sheet ask for at the start of a sub-step, many at once: spring_row.h for each, in a
// row along its line and one across (spring_island.h), as a matrix and an impulse in x and y:
//   impulse on the second end = -(bias + matrix (vb - va)).
#pragma once
#include <vector>

#include "rigid/links.h"
#include "rigid/spring_bands.h"

namespace smokebox {

/// By slot; a hole is a spring that does nothing.
struct SpringLaws {
  std::vector<double> length;  // m: longer than that it pulls
  std::vector<float> slack;    // m: shorter by that it pushes
  // bias = perStretch stretch + perRate rate of the last sub-step; hardness, and (w h)^2.
  std::vector<float> perStretch, perRate, hardness, squared;
  bool rates = false;  // a perRate is not 0

  void assign(int slots);
  void set(int slot, const SpringDef& def, double inertia, double h);
};

/// x and y of a field at the first and at the second ends of springs, in their order.
struct SpringEnds {
  const double *ax, *ay, *bx, *by;
  double x(int k) const { return bx[k] - ax[k]; }
  double y(int k) const { return by[k] - ay[k]; }
};

/// Up to kMost springs at once, from slot `slot` on: where they are, how they moved within the last sub-step,
/// and the velocities that they start with.
struct SpringRows {
  static constexpr int kMost = 128;
  SpringEnds place, moved, velocity;
  double h, hBefore, mass;  // s; of a unit of mass in the matrices, kg
  // Out: the lines' directions; bias + matrix (vb - va).
  float x[kMost], y[kMost], pullX[kMost], pullY[kMost];

  void find(const SpringLaws& laws, int slot, int count, SpringMatrices& out);

 private:
  void addRates(const SpringLaws& laws, int slot, int count);
  void stiffenAcross(const SpringLaws& laws, int slot, int count, SpringMatrices& out);

  float inverse_[kMost], stretch_[kMost], holds_[kMost], across_[kMost];
};

}  // namespace smokebox
