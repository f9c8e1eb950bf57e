#include "image/sheet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <set>

#include "base/errors.h"

namespace smokebox {
namespace {

constexpr Color kNight{0.055f, 0.063f, 0.078f};

Image plain(int width, int height, std::uint8_t level) {
  Image image(width, height);
  for (std::size_t k = 0; k < image.rgba.size(); ++k) image.rgba[k] = k % 4 == 3 ? 255 : level;
  return image;
}

TEST(Sheet, FitsIntoThePictureAndKeepsItsShape) {
  // Truth: no sheet is larger than what was asked for, none is odd, panels have the picture's shape to a
  // pixel, do not overlap, and lie inside.
  for (const auto& [width, height] : {std::pair{1280, 720}, {720, 1280}, {640, 640}, {1281, 401}, {321, 181}})
    for (int panels = 1; panels <= 10; ++panels) {
      const SheetLayout layout = layOut(panels, width, height);
      EXPECT_LE(layout.width, width + width % 2);
      EXPECT_LE(layout.height, height + height % 2);
      EXPECT_EQ(layout.width % 2 + layout.height % 2, 0);
      EXPECT_NEAR(layout.panelWidth, static_cast<double>(layout.panelHeight) * width / height, 1);
      std::set<std::pair<int, int>> places;
      for (int k = 0; k < panels; ++k) {
        EXPECT_TRUE(places.insert({layout.left(k), layout.top(k)}).second);
        EXPECT_GE(layout.left(k), 0);
        EXPECT_GE(layout.top(k), layout.labelHeight);
        EXPECT_LE(layout.left(k) + layout.panelWidth, layout.width);
        EXPECT_LE(layout.top(k) + layout.panelHeight, layout.height);
        if (k % layout.columns) {
          EXPECT_GE(layout.left(k), layout.left(k - 1) + layout.panelWidth + layout.gap);
        }
      }
    }
}

TEST(Sheet, TwoWidePicturesStandSideBySide) {
  // Truth: of 16:9, half the width is all that the sheet can give, and four make two rows.
  const SheetLayout two = layOut(2, 1280, 720), four = layOut(4, 1280, 720);
  EXPECT_EQ(two.columns, 2);
  EXPECT_EQ(two.rows, 1);
  EXPECT_GE(two.panelWidth, 634);
  EXPECT_LT(two.height, 400);  // cut to the panels
  EXPECT_EQ(four.columns, 2);
  EXPECT_EQ(four.rows, 2);
}

TEST(Sheet, ARowThatIsNotFullStandsInTheMiddle) {
  // Truth: of three panels in two columns the third is as far from the left as from the right.
  const SheetLayout layout = layOut(3, 1280, 720);
  ASSERT_EQ(layout.columns, 2);
  const int right = 2 * layout.panelWidth + layout.gap - layout.left(2) - layout.panelWidth;
  EXPECT_NEAR(layout.left(2), right, 1);
}

TEST(Sheet, TooSmallAPictureIsRefused) {
  // Truth: nine panels of a few pixels show nothing.
  EXPECT_THROW(layOut(9, 60, 40), UsageError);
}

TEST(Sheet, PanelsArePaintedInTheirPlaces) {
  // Truth: each panel's pixels are there to the bit, in its place.
  const SheetLayout layout = layOut(3, 320, 180);
  const SheetPainter painter(layout, {"a", "b", "c"}, kNight);
  std::vector<Image> panels;
  for (const int level : {10, 130, 250})
    panels.push_back(plain(layout.panelWidth, layout.panelHeight, static_cast<std::uint8_t>(level)));
  Image sheet;
  painter.paint(panels, sheet);
  ASSERT_EQ(sheet.width, layout.width);
  ASSERT_EQ(sheet.height, layout.height);
  for (int k = 0; k < 3; ++k)
    for (int y = 0; y < layout.panelHeight; ++y)
      for (int x = 0; x < layout.panelWidth; ++x)
        ASSERT_EQ(sheet.rgba[4 * (std::size_t(layout.top(k) + y) * sheet.width + layout.left(k) + x)],
                  panels[k].rgba[0]);
}

/// Pixels of a label's strip that are far from its paper, and the last column that has one.
struct Ink {
  int pixels = 0, last = -1;
};
Ink inkOf(const Image& sheet, const SheetLayout& layout, int panel) {
  Ink ink;
  const int paper = sheet.rgba[4 * (std::size_t(layout.top(panel) - 1) * sheet.width + layout.left(panel))];
  for (int x = 0; x < layout.panelWidth; ++x)
    for (int y = layout.top(panel) - layout.labelHeight; y < layout.top(panel); ++y) {
      const int level = sheet.rgba[4 * (std::size_t(y) * sheet.width + layout.left(panel) + x)];
      if (std::abs(level - paper) < 80) continue;
      ++ink.pixels;
      ink.last = x;
    }
  return ink;
}

TEST(Sheet, LabelsAreLegibleOnDarkAndLightAndEndBeforeTheirPanelDoes) {
  // Truth: a label leaves strong marks on either ground; one that is too long is cut within its own panel.
  const SheetLayout layout = layOut(2, 640, 360);
  const std::vector<Image> panels(2, plain(layout.panelWidth, layout.panelHeight, 128));
  for (const Color& ground : {kNight, Color{0.965f, 0.965f, 0.953f}}) {
    Image sheet;
    SheetPainter(layout, {"vorticity = 0", std::string(400, 'w')}, ground).paint(panels, sheet);
    EXPECT_GT(inkOf(sheet, layout, 0).pixels, 100);
    EXPECT_LT(inkOf(sheet, layout, 0).last, layout.panelWidth / 2);
    EXPECT_GT(inkOf(sheet, layout, 1).last, layout.panelWidth * 8 / 10);
    EXPECT_LT(inkOf(sheet, layout, 1).last, layout.panelWidth);
  }
  EXPECT_TRUE(labelsFit(layout, {"vorticity = 0", ""}));
  EXPECT_FALSE(labelsFit(layout, {"vorticity = 0", std::string(400, 'w')}));
}

}  // namespace
}  // namespace smokebox
