#include "image/colormap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace smokebox {
namespace {

float spread(const Color& c) { return std::max({c.r, c.g, c.b}) - std::min({c.r, c.g, c.b}); }
float difference(const Color& a, const Color& b) {
  return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b);
}
float luminance(const Color& c) {
  auto linear = [](float v) { return std::pow(v, 2.2f); };
  return 0.2126f * linear(c.r) + 0.7152f * linear(c.g) + 0.0722f * linear(c.b);
}

TEST(ImageColorMap, MiddleIsNeutralAndEndsDiffer) {
  // A diverging map is grey at zero and has two ends that nobody takes for each other.
  for (const ColorMapKind kind : {ColorMapKind::pressure, ColorMapKind::vorticity})
    for (const bool dark : {true, false}) {
      const ColorMap& map = colorMap(kind, dark);
      EXPECT_TRUE(map.diverging);
      EXPECT_LT(spread(map.at(0)), 1e-6f);
      EXPECT_GT(difference(map.at(-0.6), map.at(0.6)), 0.5f);
      EXPECT_GT(difference(map.at(-1), map.at(1)), 0.2f);
    }
}

TEST(ImageColorMap, ColorsAreContinuousAndInRange) {
  // No step along a map is visible, and no component leaves 0 to 1.
  for (const ColorMapKind kind : {ColorMapKind::pressure, ColorMapKind::vorticity, ColorMapKind::speed})
    for (const bool dark : {true, false}) {
      const ColorMap& map = colorMap(kind, dark);
      const double first = map.diverging ? -1 : 0;
      for (double u = first; u < 1; u += 0.01) {
        EXPECT_LT(difference(map.at(u), map.at(u + 0.01)), 0.1f) << u;
        EXPECT_GE(std::min({map.at(u).r, map.at(u).g, map.at(u).b}), 0.0f);
        EXPECT_LE(std::max({map.at(u).r, map.at(u).g, map.at(u).b}), 1.0f);
      }
    }
}

TEST(ImageColorMap, SequentialLightnessOnlyRisesOrOnlyFalls) {
  // Speed reads as an order: lighter on a dark ground, darker on a light one.
  for (double u = 0; u < 0.995; u += 0.05) {
    const ColorMap &dark = colorMap(ColorMapKind::speed, true), &light = colorMap(ColorMapKind::speed, false);
    EXPECT_LT(luminance(dark.at(u)), luminance(dark.at(u + 0.05))) << u;
    EXPECT_GT(luminance(light.at(u)), luminance(light.at(u + 0.05))) << u;
  }
}

TEST(ImageColorMap, ZeroIsTheMiddleOfAnyRangeThatHoldsIt) {
  // Asymmetric ranges give each arm its own scale; ranges without zero use one arm alone.
  EXPECT_DOUBLE_EQ(colorMapPosition(0, {-1, 5}, true), 0);
  EXPECT_DOUBLE_EQ(colorMapPosition(5, {-1, 5}, true), 1);
  EXPECT_DOUBLE_EQ(colorMapPosition(-1, {-1, 5}, true), -1);
  EXPECT_DOUBLE_EQ(colorMapPosition(2.5, {-1, 5}, true), 0.5);
  EXPECT_DOUBLE_EQ(colorMapPosition(99, {-1, 5}, true), 1);
  EXPECT_DOUBLE_EQ(colorMapPosition(3, {2, 4}, true), 0.5);
  EXPECT_DOUBLE_EQ(colorMapPosition(-3, {-4, -2}, true), -0.5);
  EXPECT_DOUBLE_EQ(colorMapPosition(1, {0, 4}, false), 0.25);
  EXPECT_DOUBLE_EQ(colorMapPosition(-1, {0, 4}, false), 0);
  EXPECT_DOUBLE_EQ(colorMapPosition(1, {1, 1}, true), 0);
}

}  // namespace
}  // namespace smokebox
