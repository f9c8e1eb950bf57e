#include "render/link_shapes.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/maths.h"
#include "render/batches.h"

namespace smokebox {

namespace {
// Of like lightness, so that none stands out by itself; neighbours differ in hue.
constexpr Color kBodyColors[] = {{0.353f, 0.663f, 0.902f}, {0.957f, 0.635f, 0.349f}, {0.482f, 0.776f, 0.494f},
                                 {0.898f, 0.420f, 0.435f}, {0.702f, 0.533f, 0.922f}, {0.945f, 0.820f, 0.392f},
                                 {0.306f, 0.780f, 0.753f}, {0.953f, 0.561f, 0.698f}, {0.639f, 0.694f, 0.541f},
                                 {0.773f, 0.580f, 0.416f}};
constexpr Color kPressed{0.29f, 0.56f, 1.0f}, kStretched{1.0f, 0.33f, 0.27f};

constexpr double kCoilUnits = 9;    // pixels for a coil at rest, in 1/720 of the picture's height
constexpr double kWidestUnits = 7;  // of the amplitude at rest
constexpr double kFewestCoils = 4, kMostCoils = 16;
constexpr double kSmallestUnits = 26;  // at rest; shorter springs are straight lines
constexpr double kStraightShare = 0.12;
constexpr int kRopePieces = 28;
// Contrast of two colours as in the Web Content Accessibility Guidelines 2.1; lines below this one are lost.
constexpr double kGlare = 0.05, kLeastContrast = 1.35;
}  // namespace

Color bodyColor(int index) { return kBodyColors[static_cast<std::size_t>(index) % std::size(kBodyColors)]; }

Color outlineColor(const Color& fill, double share) {
  const Color darker = mixed(fill, {0, 0, 0}, share);
  const bool isSeen = luminance(fill) + kGlare > kLeastContrast * (luminance(darker) + kGlare);
  return isSeen ? darker : mixed(fill, {1, 1, 1}, share);
}

Color tensionColor(double tension, double usual, const Color& neutral) {
  const double share = std::abs(tension) / (std::abs(tension) + 0.5 * usual);
  return mixed(neutral, tension < 0 ? kPressed : kStretched, share);
}

Color tensionColor(double tension, const std::array<double, 2>& range, const Color& neutral) {
  const double zero = std::clamp(0.0, range[0], range[1]), end = tension < zero ? range[0] : range[1];
  const double share = end == zero ? 0 : std::clamp((tension - zero) / (end - zero), 0.0, 1.0);
  return mixed(neutral, tension < zero ? kPressed : kStretched, share);
}

Zigzag zigzag(double rest, double length, double unit) {
  if (!(rest >= kSmallestUnits * unit)) return {};
  const double coils =
      std::clamp(std::round((1 - 2 * kStraightShare) * rest / (kCoilUnits * unit)), kFewestCoils, kMostCoils);
  Zigzag shape;
  shape.straight = kStraightShare * std::min(rest, length);
  // A coil is four strokes, each the long side of a triangle of the amplitude and a quarter of the period.
  const double quarterAtRest = (1 - 2 * kStraightShare) * rest / (4 * coils);
  const double atRest = std::min(kWidestUnits * unit, 0.2 * rest);
  shape.period = (length - 2 * shape.straight) / coils;
  const double wire2 = quarterAtRest * quarterAtRest + atRest * atRest, quarter = 0.25 * shape.period;
  shape.amplitude = std::max(std::sqrt(std::max(0.0, wire2 - quarter * quarter)), 0.2 * atRest);
  return shape;
}

std::vector<Vec2> hangingRope(Vec2 a, Vec2 b, double ropeLength, Vec2 down) {
  const Vec2 way = b - a;
  constexpr double kTaut = 1 + 1e-4;
  if (!(ropeLength > kTaut * length(way))) return {a, b};
  const Vec2 side = perpendicular(down);
  // Upright and level parts of the way; level is kept off zero, where the two halves would hang on one line.
  const double rise = -dot(way, down);
  double level = dot(way, side);
  const double least = 1e-3 * ropeLength;
  if (std::abs(level) < least) level = level < 0 ? -least : least;
  // sinh(x)/x = sqrt(L^2 - rise^2) / |level| gives the catenary's scale: level = 2 x scale.
  const double ratio =
      std::max(std::sqrt(std::max(0.0, ropeLength * ropeLength - rise * rise)) / std::abs(level), 1 + 1e-9);
  double x = ratio < 3 ? std::sqrt(6 * (ratio - 1)) : std::log(2 * ratio) + std::log(std::log(2 * ratio));
  for (int k = 0; k < 20; ++k) {
    const double slope = (std::cosh(x) * x - std::sinh(x)) / (x * x);
    x -= (std::sinh(x) / x - ratio) / slope;
  }
  const double scale = std::abs(level) / (2 * x);
  const double middle = std::atanh(std::clamp(rise / ropeLength, -1 + 1e-12, 1 - 1e-12));
  // s: length along the catenary from its lowest point.
  const double s0 = scale * std::sinh(middle - x);
  const auto at = [&](double s) {
    return Vec2{scale * std::asinh(s / scale), std::sqrt(scale * scale + s * s)};
  };
  const Vec2 first = at(s0);
  std::vector<Vec2> points{a};
  for (int k = 1; k < kRopePieces; ++k) {
    const Vec2 p = at(s0 + ropeLength * k / kRopePieces) - first;
    points.push_back(a + (level < 0 ? -p.x : p.x) * side - p.y * down);
  }
  points.push_back(b);
  return points;
}

std::vector<Vec2> arc(Vec2 centre, double radius, double fromRad, double toRad) {
  const int pieces = std::clamp(static_cast<int>(std::abs(toRad - fromRad) * radius / 3), 8, 64);
  std::vector<Vec2> points;
  for (int k = 0; k <= pieces; ++k) {
    const double angle = fromRad + (toRad - fromRad) * k / pieces;
    points.push_back(centre + radius * Vec2{std::cos(angle), std::sin(angle)});
  }
  return points;
}

}  // namespace smokebox
