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
  std::vector<double> length, push;  // m: longer than that it pulls, shorter than that it pushes
  // bias = perStretch stretch + perRate rate of the last sub-step; hardness, and (w h)^2.
  std::vector<double> perStretch, perRate, hardness, squared;

  void assign(int slots);
  void set(int slot, const SpringDef& def, double inertia, double h);
};

/// Of up to kMost springs at once: where their second ends are from the first ones, and how much of that came
/// in the last sub-step.
struct SpringStretch {
  static constexpr int kMost = 128;
  double x[kMost], y[kMost], movedX[kMost], movedY[kMost];
  double biasX[kMost], biasY[kMost];

  /// Of `count` springs from `slot` on: their biases, and their matrices into `rows`, for a unit of
  /// mass of `mass`. x, y: the lines' directions from then on.
  void findRows(const SpringLaws& laws, int slot, int count, double h, double hBefore, double mass,
                SpringMatrices& rows);

 private:
  /// Adds the rows across.
  void stiffenAcross(int slot, int count, const SpringLaws& laws, double h, double perSecond, double perMass,
                     SpringMatrices& rows);

  double inverse_[kMost], stretch_[kMost], across_[kMost];
};

}  // namespace smokebox
