#include "image/sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/errors.h"
#include "image/text.h"

namespace smokebox {

namespace {

// Of a sheet that is 720 pixels high.
constexpr double kFont = 21, kLabel = 34, kGap = 6;
constexpr int kSmallestFont = 9, kSmallestPanel = 16;  // pixels

double unitOf(int width, int height) { return std::min(height / 720.0, width / 880.0); }

/// Neither ground nor ink, to be seen on any: the ground moved a little towards the other end.
Color shaded(const Color& c, double share, float towards) {
  const auto mix = [&](float a) { return static_cast<float>(a + share * (towards - a)); };
  return {mix(c.r), mix(c.g), mix(c.b)};
}

bool isDark(const Color& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b < 0.45f; }

std::array<std::uint8_t, 4> bytesOf(const Color& c) {
  const auto byte = [](float x) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0f, 1.0f)));
  };
  return {byte(c.r), byte(c.g), byte(c.b), 255};
}

int fontSize(const SheetLayout& layout) {
  return std::max(static_cast<int>(std::lround(layout.labelHeight * kFont / kLabel)), kSmallestFont);
}
int marginOf(int fontSize) { return fontSize / 2; }
int roomOf(const SheetLayout& layout) { return layout.panelWidth - 2 * marginOf(fontSize(layout)); }

/// The label, shortened until it is no wider than `most` pixels.
std::string fitted(TextPainter& text, std::string label, int size, int most) {
  if (text.advance(label, size, FontWeight::bold) <= most) return label;
  while (!label.empty() && text.advance(label + "…", size, FontWeight::bold) > most) {
    do label.pop_back();
    while (!label.empty() && (label.back() & 0xC0) == 0x80);  // a character of UTF-8 goes as a whole
  }
  return label + "…";
}

}  // namespace

SheetLayout layOut(int panels, int width, int height) {
  checkInvariant(panels > 0 && width > 0 && height > 0, "a sheet has panels and a size");
  const double unit = unitOf(width, height);
  SheetLayout best;
  for (int columns = panels; columns >= 1; --columns) {  // side by side is taken among equals
    SheetLayout layout;
    layout.panels = panels;
    layout.columns = columns;
    layout.rows = (panels + columns - 1) / columns;
    layout.labelHeight = std::max(static_cast<int>(kLabel * unit), kSmallestFont + 5);
    layout.gap = std::max(static_cast<int>(kGap * unit), 2);
    const double roomX = static_cast<double>(width - (columns - 1) * layout.gap) / columns;
    const double roomY =
        static_cast<double>(height - (layout.rows - 1) * layout.gap) / layout.rows - layout.labelHeight;
    // A panel's width follows from its height, so that it has the picture's shape to half a pixel.
    const double scale = std::min((roomX - 0.5) / width, roomY / height);
    layout.panelHeight = static_cast<int>(scale * height);
    layout.panelWidth =
        static_cast<int>(std::lround(static_cast<double>(layout.panelHeight) * width / height));
    if (layout.panelWidth > best.panelWidth) best = layout;
  }
  if (std::min(best.panelWidth, best.panelHeight) < kSmallestPanel)
    throw UsageError(std::to_string(width) + "x" + std::to_string(height) + " has no room for " +
                     std::to_string(panels) + " panels; try a larger --size");
  best.width = best.columns * best.panelWidth + (best.columns - 1) * best.gap;
  best.width += best.width % 2;
  best.height = best.rows * (best.labelHeight + best.panelHeight) + (best.rows - 1) * best.gap;
  best.height += best.height % 2;
  return best;
}

bool labelsFit(const SheetLayout& layout, const std::vector<std::string>& labels) {
  TextPainter text;
  return std::all_of(labels.begin(), labels.end(), [&](const std::string& label) {
    return text.advance(label, fontSize(layout), FontWeight::bold) <= roomOf(layout);
  });
}

SheetPainter::SheetPainter(const SheetLayout& layout, const std::vector<std::string>& labels,
                           const Color& ground)
    : layout_(layout), empty_(layout.width, layout.height) {
  const bool dark = isDark(ground);
  const std::array<std::uint8_t, 4> paper = bytesOf(shaded(ground, dark ? 0.10 : 0.08, dark ? 1.0f : 0.0f));
  for (std::size_t k = 0; k < empty_.rgba.size(); k += 4) std::copy_n(paper.data(), 4, &empty_.rgba[k]);
  for (std::size_t k = 0; k < labels.size(); ++k)
    write(labels[k], static_cast<int>(k), dark ? Color{0.95f, 0.96f, 0.97f} : Color{0.08f, 0.09f, 0.11f});
}

void SheetPainter::write(const std::string& label, int panel, const Color& ink) {
  TextPainter text;
  const int size = fontSize(layout_), margin = marginOf(size);
  const TextMask line = text.line(fitted(text, label, size, roomOf(layout_)), size, FontWeight::bold);
  // Baselines are at one height, whatever letters a label has.
  const int left = layout_.left(panel) + margin - line.originX;
  const int top =
      layout_.top(panel) - layout_.labelHeight + (layout_.labelHeight + size * 7 / 10) / 2 - line.baseline;
  const std::array<std::uint8_t, 4> color = bytesOf(ink);
  for (int y = std::max(0, -top); y < line.height && top + y < layout_.height; ++y)
    for (int x = std::max(0, -left); x < line.width && left + x < layout_.width; ++x) {
      const int share = line.coverage[std::size_t(y) * line.width + x];
      std::uint8_t* pixel = &empty_.rgba[4 * (std::size_t(top + y) * layout_.width + left + x)];
      for (int c = 0; c < 3; ++c)
        pixel[c] = static_cast<std::uint8_t>((pixel[c] * (255 - share) + color[c] * share + 127) / 255);
    }
}

void SheetPainter::paint(const std::vector<Image>& panels, Image& sheet) const {
  sheet = empty_;
  for (std::size_t k = 0; k < panels.size(); ++k) {
    const Image& panel = panels[k];
    checkInvariant(panel.width == layout_.panelWidth && panel.height == layout_.panelHeight,
                   "a panel has the size of its place");
    const int left = layout_.left(static_cast<int>(k)), top = layout_.top(static_cast<int>(k));
    for (int y = 0; y < panel.height; ++y)
      std::memcpy(&sheet.rgba[4 * (std::size_t(top + y) * sheet.width + left)],
                  &panel.rgba[4 * std::size_t(y) * panel.width], std::size_t{4} * panel.width);
  }
}

}  // namespace smokebox
