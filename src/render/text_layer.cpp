#include <algorithm>
#include <cmath>
#include <cstdio>

#include "render/layers.h"

namespace smokebox {

namespace {
constexpr int kSmallestFont = 8;  // pixels; below it no letter can be told from another
constexpr double kCaptionUnits = 29, kTimeUnits = 22;
// Opacity of the plate below a caption. Light that comes through a dark plate is seen more than through a
// light one.
constexpr double kDarkPlate = 0.75, kLightPlate = 0.55;
constexpr double kMostCaptionWidth = 0.86;  // of the picture's

/// Grows a coverage by `reach` pixels and softens it: the largest value nearby, fading with the distance.
std::vector<std::uint8_t> grown(const std::vector<std::uint8_t>& in, int width, int height, int reach) {
  // Row by row, then column by column; the fall-off is linear in the larger of the two distances.
  std::vector<std::uint8_t> rows(in.size()), out(in.size());
  auto faded = [&](int value, int distance) { return value * (reach + 1 - distance) / (reach + 1); };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      int most = 0;
      for (int d = -reach; d <= reach; ++d)
        if (x + d >= 0 && x + d < width)
          most = std::max(most, faded(in[std::size_t(y) * width + x + d], std::abs(d)));
      rows[std::size_t(y) * width + x] = static_cast<std::uint8_t>(most);
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      int most = 0;
      for (int d = -reach; d <= reach; ++d)
        if (y + d >= 0 && y + d < height)
          most = std::max(most, faded(rows[std::size_t(y + d) * width + x], std::abs(d)));
      out[std::size_t(y) * width + x] = static_cast<std::uint8_t>(most);
    }
  return out;
}

struct TextColors {
  Color letters, halo;
};
TextColors textColors(const LayerSpec& layer, bool darkGround) {
  const Color letters =
      layer.color.value_or(darkGround ? Color{0.96f, 0.97f, 0.98f} : Color{0.08f, 0.09f, 0.11f});
  const bool lightLetters = 0.3f * letters.r + 0.6f * letters.g + 0.1f * letters.b > 0.5f;
  return {letters, lightLetters ? Color{0.02f, 0.025f, 0.03f} : Color{1, 1, 1}};
}
}  // namespace

int fontSize(const PictureFrame& frame, double units) {
  return std::max(kSmallestFont, static_cast<int>(std::lround(units * frame.unit)));
}

Mask haloedText(TextPainter& text, const std::string& utf8, int size, FontWeight weight, int x, int baseline,
                int halo, int pictureWidth, int pictureHeight) {
  const TextMask line = text.line(utf8, size, weight);
  const int width = line.width + 2 * halo, height = line.height + 2 * halo;
  std::vector<std::uint8_t> letters(std::size_t(width) * height, 0);
  for (int row = 0; row < line.height; ++row)
    std::copy_n(line.coverage.data() + std::size_t(row) * line.width, line.width,
                letters.data() + std::size_t(row + halo) * width + halo);
  const std::vector<std::uint8_t> around = grown(letters, width, height, halo);
  const int left = x - line.originX - halo, top = baseline - line.baseline - halo;
  Mask mask;
  mask.x = std::max(left, 0);
  mask.y = std::max(top, 0);
  mask.width = std::min(left + width, pictureWidth) - mask.x;
  mask.height = std::min(top + height, pictureHeight) - mask.y;
  if (mask.empty()) return {};
  mask.coverage.resize(std::size_t(2) * mask.width * mask.height);
  for (int row = 0; row < mask.height; ++row)
    for (int column = 0; column < mask.width; ++column) {
      const std::size_t from = std::size_t(row + mask.y - top) * width + (column + mask.x - left);
      mask.at(column, row)[0] = around[from];
      mask.at(column, row)[1] = letters[from];
    }
  return mask;
}

void TextLayer::drawCaptions(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  const int size = fontSize(frame, kCaptionUnits);
  const int padX = std::max(2, size * 6 / 10), padY = std::max(1, size * 3 / 10);
  const int edge = std::max(2, static_cast<int>(std::lround((layer.atTop ? 18 : 36) * frame.unit)));
  // Of the plate below so many lines.
  const auto bottomOf = [&](std::size_t count) {
    if (!layer.atTop) return frame.height - edge;
    return edge + 2 * padY + ascent_ + descent_ + (static_cast<int>(count) - 1) * lineHeight_;
  };
  if (keptCaptions_ != snapshot.captions || keptAtTop_ != layer.atTop) {
    keptCaptions_ = snapshot.captions;
    keptAtTop_ = layer.atTop;
    lines_.clear();
    ascent_ = static_cast<int>(std::lround(0.76 * size));
    descent_ = static_cast<int>(std::lround(0.24 * size));
    lineHeight_ = static_cast<int>(std::lround(1.3 * size));
    const int most = std::max(1, static_cast<int>(kMostCaptionWidth * frame.width) - 2 * padX);
    std::vector<std::string> texts;
    for (const std::string& caption : keptCaptions_)
      for (std::string& line : palette_.text.wrapped(caption, size, FontWeight::regular, most))
        texts.push_back(std::move(line));
    const int bottom = bottomOf(texts.size()) - padY;
    for (std::size_t k = 0; k < texts.size(); ++k) {
      const int width = palette_.text.advance(texts[k], size);
      const int baseline = bottom - descent_ - static_cast<int>(texts.size() - 1 - k) * lineHeight_;
      lines_.push_back(
          {haloedText(palette_.text, texts[k], size, FontWeight::regular, (frame.width - width) / 2, baseline,
                      std::max(1, size / 9), frame.width, frame.height),
           width});
    }
  }
  if (lines_.empty()) return;
  const TextColors colors = textColors(layer, frame.darkGround);
  int widest = 0;
  for (const CaptionLine& line : lines_) widest = std::max(widest, line.width);
  const int bottom = bottomOf(lines_.size());
  const int top = bottom - 2 * padY - ascent_ - descent_ - static_cast<int>(lines_.size() - 1) * lineHeight_;
  const double middle = frame.width / 2.0;
  palette_.panels.add(middle - widest / 2.0 - padX, top, middle + widest / 2.0 + padX, bottom,
                      linear(colors.halo, (frame.darkGround ? kDarkPlate : kLightPlate) * layer.opacity), {},
                      0.3 * size);
  palette_.panels.flush();
  for (const CaptionLine& line : lines_)
    palette_.sprites.add(line.mask, linear(colors.halo, 0.35 * layer.opacity),
                         linear(colors.letters, layer.opacity));
  palette_.sprites.flush();
}

void TextLayer::drawTime(const Snapshot& snapshot, const LayerSpec& layer, const PictureFrame& frame) {
  char text[48];
  std::snprintf(text, sizeof text, "t = %.2f s", snapshot.time);
  const int size = fontSize(frame, kTimeUnits);
  const int padX = std::max(2, size * 5 / 10), padY = std::max(1, size * 3 / 10);
  const int margin = std::max(2, static_cast<int>(std::lround(18 * frame.unit)));
  const int ascent = static_cast<int>(std::lround(0.76 * size)),
            descent = static_cast<int>(std::lround(0.24 * size));
  if (keptTime_ != text) {
    keptTime_ = text;
    timeWidth_ = palette_.text.advance(keptTime_, size);  // digits have one width: the plate does not twitch
    timeMask_ = haloedText(palette_.text, keptTime_, size, FontWeight::regular, margin + padX,
                           margin + padY + ascent, std::max(1, size / 9), frame.width, frame.height);
  }
  const TextColors colors = textColors(layer, frame.darkGround);
  palette_.panels.add(margin, margin, margin + timeWidth_ + 2 * padX, margin + ascent + descent + 2 * padY,
                      linear(colors.halo, (frame.darkGround ? kDarkPlate : kLightPlate) * layer.opacity), {},
                      0.3 * size);
  palette_.panels.flush();
  palette_.sprites.add(timeMask_, linear(colors.halo, 0.35 * layer.opacity),
                       linear(colors.letters, layer.opacity));
  palette_.sprites.flush();
}

}  // namespace smokebox
