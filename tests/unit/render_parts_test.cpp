// The parts of the renderer that need no OpenGL: masks, ticks, smoothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/maths.h"
#include "render/mask.h"
#include "render/smooth_field.h"
#include "render/ticks.h"

namespace smokebox {
namespace {

double covered(const Mask& mask) {
  double sum = 0;
  for (std::size_t k = 0; k < mask.coverage.size(); k += 2) {
    const double under = mask.coverage[k] / 255.0, over = mask.coverage[k + 1] / 255.0;
    sum += over + under * (1 - over);
  }
  return sum;
}

Outline polygon(Vec2 centre, double radius, int corners, double turned = 0) {
  Outline outline;
  for (int k = 0; k < corners; ++k) {
    const double angle = turned + 2 * kPi * k / corners;
    outline.push_back(centre + Vec2{radius * std::cos(angle), radius * std::sin(angle)});
  }
  return outline;
}

TEST(RenderMask, CoverageIsTheArea) {
  // Convex, concave and holed shapes cover their exact area, wherever they lie between the pixels.
  MaskPainter painter(400, 300);
  for (const double shift : {0.0, 0.3, 0.77}) {
    for (const int corners : {3, 4, 5, 200}) {
      const Outline outline = polygon({150 + shift, 140 - shift}, 60.4, corners, 0.2);
      EXPECT_NEAR(covered(painter.solid({outline}, 2, 0)), std::abs(signedArea(outline)), 2.0) << corners;
    }
    const Outline outside = polygon({150 + shift, 140}, 90, 100);
    Outline hole = polygon({150 + shift, 140}, 50, 100);
    std::reverse(hole.begin(), hole.end());
    EXPECT_NEAR(covered(painter.solid({outside, hole}, 2, 0)), signedArea(outside) + signedArea(hole), 3.0);
    const Outline arrow{{20 + shift, 20}, {120, 100}, {20, 180}, {50, 100}};
    EXPECT_NEAR(covered(painter.solid({arrow}, 1, 0)), std::abs(signedArea(arrow)), 2.0);
  }
}

TEST(RenderMask, OnlyThePartInThePictureIsCovered) {
  // A shape that reaches beyond all sides covers the whole picture; one beyond a side covers nothing.
  MaskPainter painter(64, 48);
  EXPECT_NEAR(covered(painter.solid({polygon({32, 24}, 500, 4)}, 2, 0)), 64 * 48, 1e-9);
  EXPECT_EQ(covered(painter.solid({polygon({-200, 24}, 50, 40)}, 2, 0)), 0);
  EXPECT_EQ(covered(painter.solid({polygon({300, 24}, 50, 40)}, 2, 0)), 0);
  // The right half of the picture, from a shape whose left edge runs through its middle.
  EXPECT_NEAR(covered(painter.solid({{{32, -100}, {900, -100}, {900, 900}, {32, 900}}}, 2, 0)), 32 * 48,
              1e-9);
  EXPECT_NEAR(covered(painter.solid({{{-900, -100}, {32, -100}, {32, 900}, {-900, 900}}}, 2, 0)), 32 * 48,
              1e-9);
}

TEST(RenderMask, ThinSolidsStayVisible) {
  // A wall of a hundredth of a pixel is drawn about as wide as asked for.
  MaskPainter painter(200, 200);
  const Outline wall{{20, 50}, {180, 90}, {180, 90.01}, {20, 50.01}};
  const double length = std::hypot(160, 40);
  EXPECT_NEAR(covered(painter.solid({wall}, 2, 2)), 2 * length, 0.1 * length);
}

TEST(RenderMask, LineHasItsWidth) {
  // The line along a circle covers its length times its width.
  MaskPainter painter(200, 200);
  const Mask mask = painter.line({polygon({100, 100}, 60, 200)}, 3, 0);
  double over = 0;
  for (std::size_t k = 1; k < mask.coverage.size(); k += 2) over += mask.coverage[k] / 255.0;
  EXPECT_NEAR(over, 2 * kPi * 60 * 3, 0.01 * 2 * kPi * 60 * 3);
}

TEST(RenderTicks, AreRoundAndWithinTheRange) {
  // Steps are 1, 2 or 5 times a power of ten, and zero is among them if it is in the range.
  const Ticks ticks = ticksFor(-45, 45, 6);
  EXPECT_EQ(ticks.values, (std::vector<double>{-40, -20, 0, 20, 40}));
  EXPECT_EQ(ticks.label(-20), "\u221220");
  EXPECT_EQ(ticks.label(0), "0");
  EXPECT_EQ(ticksFor(0, 0.3, 3).label(0.1), "0.1");
  EXPECT_EQ(ticksFor(0, 1, 4).label(0.5), "0.5");
  EXPECT_EQ(ticksFor(0, 0.3, 3).values.size(), 4u);
  EXPECT_TRUE(ticksFor(1, 1, 5).values.empty());
  EXPECT_TRUE(ticksFor(0, INFINITY, 5).values.empty());
  for (double span = 1e-7; span < 1e8; span *= 1.7)
    EXPECT_LE(ticksFor(-span / 3, span, 8).values.size(), 9u) << span;
}

TEST(RenderSmoothing, KeepsConstantsAndStraightLines) {
  // A B-spline reproduces linear functions: refined samples lie on the same plane.
  Lattice lattice, scratch;
  lattice.resize(12, 10, 1);
  lattice.spacing = 0.5;
  lattice.origin = {-1, 2};
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 12; ++i)
      lattice.row(j)[i] =
          static_cast<float>(3 + 2 * (lattice.origin.x + 0.5 * i) - (lattice.origin.y + 0.5 * j));
  smoothFor(lattice, 40, scratch);  // 20 pixels a cell
  EXPECT_LE(lattice.spacing * 40, 2);
  for (int j = 0; j < lattice.ny; ++j)
    for (int i = 0; i < lattice.nx; ++i) {
      const double x = lattice.origin.x + i * lattice.spacing, y = lattice.origin.y + j * lattice.spacing;
      ASSERT_NEAR(lattice.row(j)[i], 3 + 2 * x - y, 1e-4);
    }
}

TEST(RenderSmoothing, ConvergesToTheCubicSpline) {
  // A lone value of 1 becomes the B-spline's peak, (2/3)^2 in two dimensions.
  Lattice lattice, scratch;
  lattice.resize(9, 9, 1);
  lattice.spacing = 1;
  lattice.values.assign(81, 0);
  lattice.row(4)[4] = 1;
  smoothFor(lattice, 128, scratch);
  float peak = 0;
  for (const float value : lattice.values) peak = std::max(peak, value);
  EXPECT_NEAR(peak, 4.0 / 9, 0.002);
}

TEST(RenderSmoothing, FineCellsAreAveraged) {
  // Stripes finer than a pixel become their mean.
  Lattice lattice, scratch;
  lattice.resize(256, 256, 1);
  lattice.spacing = 1;
  for (int j = 0; j < 256; ++j)
    for (int i = 0; i < 256; ++i) lattice.row(j)[i] = static_cast<float>(i % 2);
  smoothFor(lattice, 0.2, scratch);
  EXPECT_LT(lattice.nx, 256);
  for (const float value : lattice.values) ASSERT_FLOAT_EQ(value, 0.5f);
}

}  // namespace
}  // namespace smokebox
