#include "geometry/merge.h"

#include <algorithm>
#include <cmath>
#include <polyclipping/clipper.hpp>

#include "base/errors.h"
#include "geometry/snap_outlines.h"

namespace smokebox {

void growOutline(const Outline& outline, double distance, Outline& grown) {
  grown.clear();
  const std::size_t n = outline.size();
  auto normal = [&](std::size_t k) {  // outwards, of the edge from corner k
    const Vec2 along = outline[k + 1 < n ? k + 1 : 0] - outline[k];
    const double size = length(along);
    return size > 0 ? Vec2{along.y / size, -along.x / size} : Vec2{};
  };
  if (n == 0) return;
  Vec2 before = normal(n - 1);
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 after = normal(k);
    const double stretch = std::max(1 + dot(before, after), 0.05);  // a needle's tip does not run away
    grown.push_back(outline[k] + (distance / stretch) * (before + after));
    before = after;
  }
}

namespace {

enum class Corners { cleaned, all };

/// On a grid of integers, about the middle of all.
std::vector<Outline> unionOnGrid(const std::vector<Outline>& outlines, double quantum, Corners corners) {
  Vec2 lo{1e300, 1e300}, hi{-1e300, -1e300};
  for (const Outline& outline : outlines)
    for (Vec2 p : outline) {
      lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
      hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
  if (!(hi.x > lo.x || hi.y > lo.y)) return {};
  const Vec2 centre = 0.5 * (lo + hi);  // rounding is symmetric about it

  ClipperLib::Clipper clipper;
  for (const Outline& outline : outlines) {
    ClipperLib::Path path;
    path.reserve(outline.size());
    for (Vec2 p : outline)
      path.emplace_back(std::llround((p.x - centre.x) / quantum), std::llround((p.y - centre.y) / quantum));
    clipper.AddPath(path, ClipperLib::ptSubject, true);
  }
  ClipperLib::Paths paths;
  const bool done =
      clipper.Execute(ClipperLib::ctUnion, paths, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
  checkInvariant(done, "the union of polygons can be found");
  if (corners == Corners::cleaned) ClipperLib::CleanPolygons(paths);

  std::vector<Outline> result;
  for (const ClipperLib::Path& path : paths) {
    if (path.size() < 3) continue;
    Outline outline;
    outline.reserve(path.size());
    for (const ClipperLib::IntPoint& p : path)
      outline.push_back(
          {centre.x + quantum * static_cast<double>(p.X), centre.y + quantum * static_cast<double>(p.Y)});
    result.push_back(std::move(outline));
  }
  return result;
}

double extentOf(const std::vector<Outline>& outlines) {
  Vec2 lo{1e300, 1e300}, hi{-1e300, -1e300};
  for (const Outline& outline : outlines)
    for (Vec2 p : outline) {
      lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
      hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
  return std::max({hi.x - lo.x, hi.y - lo.y, 0.0});
}

}  // namespace

std::vector<Outline> unionOfOutlines(const std::vector<Outline>& outlines, double near) {
  const double quantum = std::max(near, extentOf(outlines) * 0x1p-40);
  std::vector<Outline> result = unionOnGrid(outlines, quantum, Corners::all);
  snapOutlines(outlines, quantum, result);
  return result;
}

std::vector<Outline> merged(const std::vector<Outline>& outlines) {
  if (outlines.size() < 2) return outlines;
  // Parts that are meant to touch may miss each other by a rounding: grown by two quanta they overlap, and
  // the seam is gone when the result is shrunk again.
  const double quantum = extentOf(outlines) * 0x1p-30;
  std::vector<Outline> grown(outlines.size());
  for (std::size_t k = 0; k < outlines.size(); ++k) growOutline(outlines[k], 2 * quantum, grown[k]);
  std::vector<Outline> result = unionOnGrid(grown, quantum, Corners::cleaned);
  for (Outline& outline : result) {
    const Outline wide = outline;
    growOutline(wide, -2 * quantum, outline);
  }
  return result;
}

}  // namespace smokebox
