#include <algorithm>
#include <cmath>
#include <cstdio>

#include "render/layers.h"
#include "render/ticks.h"

namespace smokebox {

ColorBarLayer::ColorBarLayer(Palette& palette)
    : palette_(palette), program_(palette.gl, "smoke.vert", "colorbar.frag"), quad_(palette.gl, {4, 4}) {}

void ColorBarLayer::draw(const Snapshot& snapshot, const std::vector<const LayerSpec*>& fields,
                         const PictureFrame& frame) {
  const int size = fontSize(frame, 17);
  const int ascent = static_cast<int>(std::lround(0.76 * size));
  const int margin = std::max(2, static_cast<int>(std::lround(22 * frame.unit)));
  const int pad = std::max(2, static_cast<int>(std::lround(0.75 * size)));
  const int strip = std::max(4, static_cast<int>(std::lround(16 * frame.unit)));
  const int tickLength = std::max(2, static_cast<int>(std::lround(6 * frame.unit)));
  const double thin = frame.line(1);
  const Color ink = frame.darkGround ? Color{0.94f, 0.95f, 0.97f} : Color{0.08f, 0.09f, 0.11f};
  const Color plate = frame.darkGround ? Color{0.02f, 0.025f, 0.03f} : Color{1, 1, 1};
  // Half of the picture, but no longer than a bar of this width looks well, and never too short for its
  // numbers.
  const int panelHeight = std::max(6 * size, std::min(frame.height / 2, 22 * size));
  const int top = (frame.height - panelHeight) / 2, bottom = top + panelHeight;

  int right = frame.width - margin;
  for (auto field = fields.rbegin(); field != fields.rend(); ++field) {
    const FieldStyle style = fieldStyle(snapshot, **field, frame);
    const Ticks ticks = ticksFor(style.range[0], style.range[1], std::clamp(panelHeight / (2 * size), 2, 10));
    int widest = 0;
    for (const double value : ticks.values)
      widest = std::max(widest, palette_.text.advance(ticks.label(value), size));
    const int title = palette_.text.advance(style.label, size);
    const int inner = std::max(title, strip + tickLength + size / 3 + widest);
    const int left = right - inner - 2 * pad;
    // Opaque: bright arrows below would shine through, and cross the numbers.
    palette_.panels.add(left, top, right, bottom, linear(plate), linear(ink, 0.12), 0.5 * size, thin);

    const int barTop = top + 2 * pad + size, barBottom = bottom - pad;
    const int barLeft = left + pad, barRight = barLeft + strip;
    palette_.panels.add(barLeft - thin, barTop - thin, barRight + thin, barBottom + thin, linear(ink, 0.75));
    const double low = style.range[0], high = style.range[1];
    auto rowOf = [&](double value) {
      return barBottom - (value - low) / (high - low) * (barBottom - barTop);
    };
    for (const double value : ticks.values) {
      const double y = rowOf(value);
      palette_.panels.add(barRight, y - thin / 2, barRight + tickLength, y + thin / 2, linear(ink));
      palette_.sprites.add(
          haloedText(palette_.text, ticks.label(value), size, FontWeight::regular,
                     barRight + tickLength + size / 3, static_cast<int>(std::lround(y + 0.36 * size)), 1,
                     frame.width, frame.height),
          linear(plate, 0.3), linear(ink));
    }
    palette_.sprites.add(haloedText(palette_.text, style.label, size, FontWeight::regular, barLeft,
                                    top + pad + ascent, 1, frame.width, frame.height),
                         linear(plate, 0.3), linear(ink));
    palette_.panels.flush();
    program_.use();
    program_.set("pictureSize", float(frame.width), float(frame.height));
    program_.set("valueRange", float(low), float(high));
    setColorMap(program_, style.map, style.range);
    quad_.draw({float(barLeft), float(barTop), float(barRight), float(barBottom), 0, 1, 1, 0});
    right = left - margin / 2;
  }
  palette_.sprites.flush();
}

}  // namespace smokebox
