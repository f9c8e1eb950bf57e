// Round numbers along a scale: steps of 1, 2 or 5 times a power of ten.
#pragma once
#include <string>
#include <vector>

namespace smokebox {

struct Ticks {
  std::vector<double> values;  // rising, within the range; empty if it is empty or not finite
  double step = 1;

  /// With as many digits as the step needs; zero has no sign; very large and small ones with an exponent.
  std::string label(double value) const;
};

/// About `most` ticks from low to high, never more than that plus one.
Ticks ticksFor(double low, double high, int most);

}  // namespace smokebox
