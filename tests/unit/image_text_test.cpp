#include "image/text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace smokebox {
namespace {

long ink(const TextMask& mask) { return std::accumulate(mask.coverage.begin(), mask.coverage.end(), 0L); }

TEST(ImageText, LettersHaveInkAndLongerTextIsWider) {
  // Each letter adds to the width, and each but a space to the ink.
  TextPainter painter;
  const TextMask one = painter.line("a", 24), two = painter.line("ab", 24), spaced = painter.line("a b", 24);
  EXPECT_GT(ink(one), 255 * 20);
  EXPECT_GT(two.width, one.width);
  EXPECT_GT(spaced.width, two.width);
  EXPECT_EQ(ink(spaced), ink(two));
}

TEST(ImageText, SizeScalesTheLetters) {
  // A capital letter of DejaVu Sans is 0.729 em tall.
  TextPainter painter;
  for (const int size : {10, 20, 40, 100})
    EXPECT_NEAR(painter.line("H", size).baseline, 0.729 * size, 1.0) << size;
}

TEST(ImageText, KerningBringsPairsTogether) {
  // "AV" is narrower than the sum of its letters.
  TextPainter painter;
  EXPECT_LT(painter.advance("AV", 100), painter.advance("A", 100) + painter.advance("V", 100));
}

TEST(ImageText, Utf8IsOneLetterACharacter) {
  // A letter of two bytes is drawn once; bytes that are no UTF-8 and letters that the font lacks become
  // boxes.
  TextPainter painter;
  EXPECT_NEAR(painter.advance("\u00f6", 100), painter.advance("o", 100), 1);
  EXPECT_GT(ink(painter.line("\xff", 24)), 0);
  EXPECT_GT(ink(painter.line("\u6f22", 24)), 0);
  EXPECT_GT(ink(painter.line("\xe6\xbc", 24)), 0);  // cut off
}

TEST(ImageText, EmptyTextIsAnEmptyMask) {
  // Nothing is drawn, and nothing fails.
  TextPainter painter;
  EXPECT_EQ(painter.line("", 24).width, 0);
  EXPECT_TRUE(painter.wrapped("", 24, FontWeight::regular, 100).empty());
}

TEST(ImageText, WrappedLinesFitAndLoseNoWord) {
  // No line is wider than asked, and joined with spaces they are the text.
  TextPainter painter;
  const std::string text = "a cylinder sheds vortices in coloured smoke at a Reynolds number of 150";
  const std::vector<std::string> lines = painter.wrapped(text, 20, FontWeight::regular, 200);
  EXPECT_GT(lines.size(), 2u);
  std::string joined;
  for (const std::string& line : lines) {
    EXPECT_LE(painter.advance(line, 20), 200) << line;
    joined += (joined.empty() ? "" : " ") + line;
  }
  EXPECT_EQ(joined, text);
  EXPECT_EQ(painter.wrapped("one\ntwo", 20, FontWeight::regular, 1000).size(), 2u);
}

}  // namespace
}  // namespace smokebox
