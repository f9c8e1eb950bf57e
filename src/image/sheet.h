// Several pictures of one size on one sheet, in rows, each under a line of text.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "base/color.h"
#include "image/image.h"

namespace smokebox {

struct SheetLayout {
  int panels = 1, columns = 1, rows = 1;
  int panelWidth = 0, panelHeight = 0;  // pixels
  int labelHeight = 0, gap = 0;         // above each panel; between panels
  int width = 0, height = 0;            // of the sheet, even

  /// Left and top of a panel, counted row by row; a last row that is not full stands in the middle.
  int left(int panel) const {
    const int row = panel / columns, inRow = std::min(columns, panels - row * columns);
    return (columns - inRow) * (panelWidth + gap) / 2 + panel % columns * (panelWidth + gap);
  }
  int top(int panel) const { return panel / columns * (labelHeight + panelHeight + gap) + labelHeight; }
};

/// The largest panels of the shape width : height that fit with their labels into a picture of this size; the
/// sheet is cut to them. Throws UsageError if nothing can be seen on them.
SheetLayout layOut(int panels, int width, int height);

/// No label would be cut at the end of its panel. Throws IoError if there are no fonts.
bool labelsFit(const SheetLayout& layout, const std::vector<std::string>& labels);

class SheetPainter {
 public:
  /// One label for each panel, cut at its end. Throws IoError if there are no fonts.
  SheetPainter(const SheetLayout& layout, const std::vector<std::string>& labels, const Color& ground);
  /// `panels`: one picture for each label, of the layout's size.
  void paint(const std::vector<Image>& panels, Image& sheet) const;

 private:
  void write(const std::string& label, int panel, const Color& ink);

  SheetLayout layout_;
  Image empty_;  // the sheet with its labels
};

}  // namespace smokebox
