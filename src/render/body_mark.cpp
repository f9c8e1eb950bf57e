#include "render/body_mark.h"

#include <algorithm>
#include <cmath>

#include "base/maths.h"

namespace smokebox {

namespace {
constexpr int kLevels = 15;             // lines across the body that are tried
constexpr double kShortestSpoke = 0.3;  // share of the body's extent along the spoke
constexpr double kBegins = 0.2;         // share of a line across the body that is left out at its start

struct Span {
  double from = 0, to = 0;
  double length() const { return to - from; }
};

/// What of the line at the height `level` is inside, from left to right.
std::vector<Span> insideAt(const std::vector<Outline>& outlines, double level) {
  std::vector<double> cuts;
  for (const Outline& outline : outlines)
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vec2 a = outline[k], b = outline[(k + 1) % outline.size()];
      if ((a.y <= level) != (b.y <= level)) cuts.push_back(a.x + (level - a.y) / (b.y - a.y) * (b.x - a.x));
    }
  std::sort(cuts.begin(), cuts.end());
  std::vector<Span> spans;
  for (std::size_t k = 0; k + 1 < cuts.size(); k += 2) spans.push_back({cuts[k], cuts[k + 1]});
  return spans;
}
}  // namespace

std::optional<BodyMark> markOf(const std::vector<Outline>& outlines, const Pose& pose) {
  // In the body's own coordinates, where the spoke is level.
  const double c = std::cos(pose.angleRad), s = std::sin(pose.angleRad);
  std::vector<Outline> own = outlines;
  Vec2 low{1e300, 1e300}, high{-1e300, -1e300};
  for (Outline& outline : own)
    for (Vec2& p : outline) {
      const Vec2 d = p - pose.position;
      p = {c * d.x + s * d.y, c * d.y - s * d.x};
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  const auto mark = [&](double from, double to, double level) {
    return BodyMark{transformed({from, level}, pose), transformed({to, level}, pose)};
  };
  for (const Span& span : insideAt(own, 0))
    if (span.from < 0 && span.to > kShortestSpoke * (high.x - low.x)) return mark(0, span.to, 0);
  Span longest;
  double at = 0;
  for (int k = 0; k < kLevels; ++k) {
    const double level = low.y + (k + 0.5) / kLevels * (high.y - low.y);
    for (const Span& span : insideAt(own, level))
      // Rounding must not choose anew at every step between lines of one length.
      if (span.length() > (1 + 1e-6) * longest.length()) {
        longest = span;
        at = level;
      }
  }
  if (!(longest.length() > 0)) return {};
  return mark(longest.from + kBegins * longest.length(), longest.to, at);
}

}  // namespace smokebox
