#include "render/ticks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace smokebox {

Ticks ticksFor(double low, double high, int most) {
  Ticks ticks;
  const double span = high - low;
  if (!(span > 0) || !std::isfinite(span)) return ticks;
  const double rough = span / std::max(most, 1);
  const double decade = std::pow(10.0, std::floor(std::log10(rough)));
  ticks.step = 10 * decade;
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= rough * (1 - 1e-9)) {
      ticks.step = factor * decade;
      break;
    }
  const double slack = 1e-6;  // of a step: an end that is a tick but for rounding is one
  const double first = std::ceil(low / ticks.step - slack), last = std::floor(high / ticks.step + slack);
  for (double k = first; k <= last; ++k) ticks.values.push_back(k * ticks.step);
  return ticks;
}

std::string Ticks::label(double value) const {
  char text[40];
  if (std::abs(value) < 1e-9 * step) return "0";
  if (step >= 1e5 || step < 1e-4) {
    std::snprintf(text, sizeof text, "%.2g", value);
  } else {
    const int digits = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
    std::snprintf(text, sizeof text, "%.*f", digits, value);
  }
  std::string label = text;
  if (label[0] == '-') label.replace(0, 1, "\u2212");  // a true minus sign
  return label;
}

}  // namespace smokebox
