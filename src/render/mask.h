// Antialiased masks of polygons, computed on the CPU: exact coverage for fills, distances for strokes.
//
// Fill: the area that a polygon covers of each pixel, by accumulating signed areas under its edges (as font
// rasterisers do); exact but for the rounding to 8 bits, for concave outlines with holes, and with any number
// of corners. Stroke: coverage from the distance of a pixel's centre to the nearest edge.
#pragma once
#include <cstdint>
#include <vector>

#include "geometry/shape.h"

namespace smokebox {

/// Two coverages for each pixel (under, over), for the sprite shader. (x, y) is the upper left pixel in the
/// picture.
struct Mask {
  int x = 0, y = 0, width = 0, height = 0;
  std::vector<std::uint8_t> coverage;  // 2 * width * height

  bool empty() const { return width <= 0 || height <= 0; }
  std::uint8_t* at(int column, int row) { return coverage.data() + 2 * (std::size_t(row) * width + column); }
};

/// Outlines in pixels (y down), kept between pictures for their memory.
using PixelOutlines = std::vector<Outline>;

/// A line with a dot at its start, in pixels.
struct Spoke {
  Vec2 from, to;
  double width = 0, hub = 0;  // hub: radius of the dot
  bool operator==(const Spoke&) const = default;
};

class MaskPainter {
 public:
  MaskPainter(int pictureWidth, int pictureHeight)
      : pictureWidth_(pictureWidth), pictureHeight_(pictureHeight) {}

  /// A solid: under is its fill, over its outline, `stroke` pixels wide, which lies inside so that the
  /// silhouette is exact and corners stay sharp. What is thinner than `thinnest` pixels on average is widened
  /// to that. A spoke is part of the outline.
  Mask solid(const PixelOutlines& outlines, double stroke, double thinnest, const Spoke* spoke = nullptr);

  /// The line along closed outlines: over is the line, under the same with `halo` pixels more on each side.
  Mask line(const PixelOutlines& outlines, double width, double halo);

 private:
  struct Box {
    int x0, y0, x1, y1;
  };
  Box visibleBox(const PixelOutlines& outlines, double margin) const;
  void accumulate(const PixelOutlines& outlines, const Box& box);
  void addEdge(Vec2 a, Vec2 b, int width, int height);
  void addSpoke(const Spoke& spoke, const Box& box);
  static float coverageOf(const Spoke& spoke, Vec2 pixel);
  void measureDistances(const PixelOutlines& outlines, const Box& box, double reach);

  int pictureWidth_, pictureHeight_;
  std::vector<float> area_;       // signed area by pixel; its running sum along a row is the coverage
  std::vector<float> distance2_;  // squared distance to the nearest edge
  std::vector<float> fill_, line_;
};

}  // namespace smokebox
