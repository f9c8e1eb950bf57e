// Colour maps of fields, as polynomials in sRGB, so that a shader evaluates them without a texture and a
// legend shows the very same colours. Each was fitted by least squares to a smooth curve through anchors of
// our own choice in Oklab (Ottosson 2020), with its two ends held.
//
// Diverging: u in [-1, 1], the middle u = 0 is a neutral grey close to the ground, both arms are equally
// strong. Sequential: u in [0, 1], lightness rises steadily.
#pragma once
#include <array>

#include "base/color.h"

namespace smokebox {

struct ColorMap {
  static constexpr int kTerms = 7;
  bool diverging = false;
  /// sRGB = sum of coefficients[k] * |u|^k. Diverging maps have one set for each arm, with the same first
  /// term.
  std::array<Color, kTerms> positive, negative;

  Color at(double u) const;
};

enum class ColorMapKind { pressure, vorticity, speed, temperature };
/// The map that suits the ground.
const ColorMap& colorMap(ColorMapKind kind, bool darkGround);

/// u = (value - zero) * above, or * below for a value under zero; to be clamped.
struct ColorMapScale {
  double zero, above, below;
};
/// Of a range {low, high}. Zero is the middle of a diverging map also if the range is
/// not symmetric (each arm has its own scale); a range without zero uses one arm alone.
ColorMapScale colorMapScale(const std::array<double, 2>& range, bool diverging);
/// Where a value lies on a map of this range, clamped.
double colorMapPosition(double value, const std::array<double, 2>& range, bool diverging);

}  // namespace smokebox
