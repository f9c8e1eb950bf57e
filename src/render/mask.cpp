#include "render/mask.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

namespace {
std::uint8_t toByte(float share) {
  return static_cast<std::uint8_t>(std::clamp(share, 0.0f, 1.0f) * 255 + 0.5f);
}

/// Twice the area over the perimeter: the thickness of a long thin shape.
double meanThickness(const PixelOutlines& outlines) {
  double area = 0, perimeter = 0;
  for (const Outline& outline : outlines)
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vec2 a = outline[k], b = outline[(k + 1) % outline.size()];
      area += 0.5 * cross(a, b);
      perimeter += length(b - a);
    }
  return perimeter > 0 ? 2 * std::abs(area) / perimeter : 0;
}
}  // namespace

MaskPainter::Box MaskPainter::visibleBox(const PixelOutlines& outlines, double margin) const {
  double x0 = 1e30, y0 = 1e30, x1 = -1e30, y1 = -1e30;
  for (const Outline& outline : outlines)
    for (const Vec2& p : outline) {
      x0 = std::min(x0, p.x), x1 = std::max(x1, p.x);
      y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
    }
  auto inside = [](double value, int most) { return static_cast<int>(std::clamp(value, 0.0, double(most))); };
  return {inside(std::floor(x0 - margin), pictureWidth_), inside(std::floor(y0 - margin), pictureHeight_),
          inside(std::ceil(x1 + margin), pictureWidth_), inside(std::ceil(y1 + margin), pictureHeight_)};
}

/// Adds the area to the right of the edge from a to b. Left of the box it counts in full, right of it not at
/// all.
void MaskPainter::addEdge(Vec2 a, Vec2 b, int width, int height) {
  if (a.y == b.y) return;
  const double sign = a.y < b.y ? 1 : -1;
  if (a.y > b.y) std::swap(a, b);
  const double slope = (b.x - a.x) / (b.y - a.y);
  const int firstRow = static_cast<int>(std::clamp(std::floor(a.y), 0.0, double(height)));
  const int pastRow = static_cast<int>(std::clamp(std::ceil(b.y), 0.0, double(height)));
  const int stride = width + 2;
  for (int row = firstRow; row < pastRow; ++row) {
    const double top = std::max<double>(row, a.y), bottom = std::min<double>(row + 1, b.y);
    if (bottom <= top) continue;
    float* line = area_.data() + std::size_t(row) * stride;
    double x0 = a.x + (top - a.y) * slope, x1 = a.x + (bottom - a.y) * slope;
    if (x0 > x1) std::swap(x0, x1);
    // Cut at the sides of the box: each piece keeps its own share of the height.
    const double span = x1 - x0, tall = sign * (bottom - top);
    const double left = std::clamp<double>(x0, 0, width), right = std::clamp<double>(x1, 0, width);
    if (span <= 0) {
      const int column = static_cast<int>(left);
      const double share = left - column;
      line[column] += static_cast<float>(tall * (1 - share));
      line[column + 1] += static_cast<float>(tall * share);
      continue;
    }
    const double perPixel = tall / span;
    line[0] += static_cast<float>(perPixel * std::max(0.0, std::min(x1, 0.0) - x0));
    for (int column = static_cast<int>(left); column < right; ++column) {
      const double from = std::max<double>(left, column), to = std::min<double>(right, column + 1);
      const double piece = perPixel * (to - from), share = 0.5 * (from + to) - column;
      line[column] += static_cast<float>(piece * (1 - share));
      line[column + 1] += static_cast<float>(piece * share);
    }
  }
}

void MaskPainter::accumulate(const PixelOutlines& outlines, const Box& box) {
  const int width = box.x1 - box.x0, height = box.y1 - box.y0;
  area_.assign(std::size_t(width + 2) * height, 0.0f);
  const Vec2 corner{double(box.x0), double(box.y0)};
  for (const Outline& outline : outlines)
    for (std::size_t k = 0; k < outline.size(); ++k)
      addEdge(outline[k] - corner, outline[(k + 1) % outline.size()] - corner, width, height);
}

void MaskPainter::measureDistances(const PixelOutlines& outlines, const Box& box, double reach) {
  const int width = box.x1 - box.x0, height = box.y1 - box.y0;
  distance2_.assign(std::size_t(width) * height, static_cast<float>(reach * reach));
  const Vec2 corner{box.x0 + 0.5, box.y0 + 0.5};  // distances are to pixels' centres
  for (const Outline& outline : outlines)
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vec2 a = outline[k] - corner, b = outline[(k + 1) % outline.size()] - corner;
      const Vec2 along = b - a;
      const double length2 = dot(along, along), perLength2 = length2 > 0 ? 1 / length2 : 0;
      const double perRow = along.y != 0 ? 1 / along.y : 0;
      const double low = std::min(a.y, b.y) - reach, high = std::max(a.y, b.y) + reach;
      if (high < 0 || low > height - 1) continue;
      const int pastRow = static_cast<int>(std::min(std::floor(high), height - 1.0)) + 1;
      for (int row = static_cast<int>(std::max(std::ceil(low), 0.0)); row < pastRow; ++row) {
        // The part of the edge that is within reach of this row bounds the columns that need a look.
        double s0 = 0, s1 = 1;
        if (along.y != 0) {
          const double p = (row - reach - a.y) * perRow, q = (row + reach - a.y) * perRow;
          s0 = std::clamp(std::min(p, q), 0.0, 1.0);
          s1 = std::clamp(std::max(p, q), 0.0, 1.0);
        }
        const double xa = a.x + s0 * along.x, xb = a.x + s1 * along.x;
        const double first = std::max(std::ceil(std::min(xa, xb) - reach), 0.0);
        const double last = std::min(std::floor(std::max(xa, xb) + reach), width - 1.0);
        float* line = distance2_.data() + std::size_t(row) * width;
        for (int column = static_cast<int>(first); column <= last; ++column) {
          const Vec2 d{column - a.x, row - a.y};
          const double s = std::clamp(dot(d, along) * perLength2, 0.0, 1.0);
          const Vec2 off = d - s * along;
          line[column] = std::min(line[column], static_cast<float>(dot(off, off)));
        }
      }
    }
}

/// How much of a pixel, by its centre, the spoke covers.
float MaskPainter::coverageOf(const Spoke& spoke, Vec2 pixel) {
  const Vec2 way = spoke.to - spoke.from, d = pixel - spoke.from;
  const double length2 = dot(way, way), s = length2 > 0 ? std::clamp(dot(d, way) / length2, 0.0, 1.0) : 0.0;
  const double line = 0.5 * spoke.width - length(d - s * way), hub = spoke.hub - length(d);
  // What is thinner than a pixel is fainter.
  const double most = std::min(1.0, spoke.width);
  return static_cast<float>(
      std::max(most * std::clamp(line + 0.5, 0.0, 1.0), std::clamp(hub + 0.5, 0.0, 1.0)));
}

void MaskPainter::addSpoke(const Spoke& spoke, const Box& box) {
  const double margin = std::max(0.5 * spoke.width, spoke.hub) + 0.5;
  const auto first = [&](double a, double b, int from) {
    return std::max(0, static_cast<int>(std::floor(std::min(a, b) - margin)) - from);
  };
  const auto past = [&](double a, double b, int from, int to) {
    return std::min(to - from, static_cast<int>(std::ceil(std::max(a, b) + margin)) - from);
  };
  for (int row = first(spoke.from.y, spoke.to.y, box.y0);
       row < past(spoke.from.y, spoke.to.y, box.y0, box.y1); ++row) {
    float* line = line_.data() + std::size_t(row) * (box.x1 - box.x0);
    for (int column = first(spoke.from.x, spoke.to.x, box.x0);
         column < past(spoke.from.x, spoke.to.x, box.x0, box.x1); ++column)
      line[column] = std::max(line[column], coverageOf(spoke, {box.x0 + column + 0.5, box.y0 + row + 0.5}));
  }
}

Mask MaskPainter::solid(const PixelOutlines& outlines, double stroke, double thinnest, const Spoke* spoke) {
  const double widen = std::max(0.0, 0.5 * (thinnest - meanThickness(outlines)));
  const Box box = visibleBox(outlines, widen > 0 ? widen + 1 : 0);
  Mask mask{box.x0, box.y0, box.x1 - box.x0, box.y1 - box.y0, {}};
  if (mask.empty()) return {};
  const std::size_t pixels = std::size_t(mask.width) * mask.height;
  mask.coverage.resize(2 * pixels);
  accumulate(outlines, box);
  measureDistances(outlines, box, std::max(stroke, widen) + 1);
  const float inside = static_cast<float>(stroke) + 0.5f, around = static_cast<float>(widen) + 0.5f;
  // What the silhouette and the line along it cover; plain loops, which the compiler can do many at a time.
  fill_.resize(pixels);
  line_.resize(pixels);
  for (int row = 0; row < mask.height; ++row) {
    const float* areas = area_.data() + std::size_t(row) * (mask.width + 2);
    float* fill = fill_.data() + std::size_t(row) * mask.width;
    float sum = 0;
    for (int column = 0; column < mask.width; ++column) {
      sum += areas[column];
      fill[column] = std::min(std::abs(sum), 1.0f);
    }
  }
  for (std::size_t k = 0; k < pixels; ++k)
    line_[k] = std::clamp(inside - std::sqrt(distance2_[k]), 0.0f, 1.0f);
  if (widen > 0)
    for (std::size_t k = 0; k < pixels; ++k)
      fill_[k] = std::max(fill_[k], std::clamp(around - std::sqrt(distance2_[k]), 0.0f, 1.0f));
  if (spoke) addSpoke(*spoke, box);
  for (std::size_t k = 0; k < pixels; ++k) {
    // Together they must cover what the silhouette covers: over + under (1 - over) = fill.
    const float over = fill_[k] * line_[k], under = (fill_[k] - over) / std::max(1 - over, 1e-6f);
    mask.coverage[2 * k] = toByte(under);
    mask.coverage[2 * k + 1] = toByte(over);
  }
  return mask;
}

Mask MaskPainter::line(const PixelOutlines& outlines, double width, double halo) {
  const double reach = 0.5 * width + halo + 1;
  const Box box = visibleBox(outlines, reach);
  Mask mask{box.x0, box.y0, box.x1 - box.x0, box.y1 - box.y0, {}};
  if (mask.empty()) return {};
  mask.coverage.resize(std::size_t(2) * mask.width * mask.height);
  measureDistances(outlines, box, reach);
  const float half = static_cast<float>(0.5 * width);
  for (std::size_t k = 0; k < distance2_.size(); ++k) {
    const float distance = std::sqrt(distance2_[k]);
    mask.coverage[2 * k] = toByte(half + static_cast<float>(halo) - distance + 0.5f);
    mask.coverage[2 * k + 1] = toByte(half - distance + 0.5f);
  }
  return mask;
}

}  // namespace smokebox
