#include "geometry/snap_outlines.h"

#include <algorithm>
#include <cmath>

namespace smokebox {
namespace {

constexpr double kCorner = 1, kEdge = 2;  // spacings: how near a corner, an edge of the polygons has to be
constexpr double kParallel = 1e-12;       // square of the sine of the angle between two edges

class Snapper {
 public:
  Snapper(const std::vector<Outline>& originals, double spacing) : originals_(originals), spacing_(spacing) {
    for (const Outline& outline : originals) {
      corners_.insert(corners_.end(), outline.begin(), outline.end());
      Box box{{1e300, 1e300}, {-1e300, -1e300}};
      for (Vec2 p : outline) {
        box.lo = {std::min(box.lo.x, p.x), std::min(box.lo.y, p.y)};
        box.hi = {std::max(box.hi.x, p.x), std::max(box.hi.y, p.y)};
      }
      boxes_.push_back(box);
    }
    std::sort(corners_.begin(), corners_.end(),
              [](Vec2 a, Vec2 b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  }

  Vec2 snapped(Vec2 p) const {
    const double near = kCorner * spacing_;
    Vec2 sum;  // of the corners there, from p
    int count = 0;
    for (auto c = std::lower_bound(corners_.begin(), corners_.end(), p.x - near,
                                   [](Vec2 a, double x) { return a.x < x; });
         c != corners_.end() && c->x <= p.x + near; ++c)
      if (std::fabs(c->y - p.y) <= near) {
        if (count++ == 0)
          sum = *c;
        else
          sum = sum + *c;
      }
    if (count > 0) return (1.0 / count) * sum;
    return p + toEdges(p);
  }

 private:
  struct Box {
    Vec2 lo, hi;
  };

  /// From p to the point nearest to the lines of the edges there.
  Vec2 toEdges(Vec2 p) const {
    const double near = kEdge * spacing_;
    double xx = 0, xy = 0, yy = 0;  // sum of n n', n the normals
    Vec2 right;                     // sum of n (distance of the line along n)
    for (std::size_t o = 0; o < originals_.size(); ++o) {
      const Box& box = boxes_[o];
      if (p.x < box.lo.x - near || p.x > box.hi.x + near || p.y < box.lo.y - near || p.y > box.hi.y + near)
        continue;
      const Outline& points = originals_[o];
      for (std::size_t k = 0; k < points.size(); ++k) {
        const Vec2 a = points[k], b = points[k + 1 < points.size() ? k + 1 : 0];
        if (p.x < std::min(a.x, b.x) - near || p.x > std::max(a.x, b.x) + near ||
            p.y < std::min(a.y, b.y) - near || p.y > std::max(a.y, b.y) + near)
          continue;
        const Vec2 along = b - a;
        const double size = length(along);
        if (size == 0) continue;
        const Vec2 normal = (1 / size) * perpendicular(along);
        const double distance = dot(a - p, normal);
        if (std::fabs(distance) > near) continue;
        xx += normal.x * normal.x;
        xy += normal.x * normal.y;
        yy += normal.y * normal.y;
        right = right + distance * normal;
      }
    }
    const double trace = xx + yy, determinant = xx * yy - xy * xy;
    if (trace == 0) return {};
    if (determinant < kParallel) return (1 / trace) * right;
    return (1 / determinant) * Vec2{yy * right.x - xy * right.y, xx * right.y - xy * right.x};
  }

  const std::vector<Outline>& originals_;
  double spacing_;
  std::vector<Vec2> corners_;  // by x, then y
  std::vector<Box> boxes_;
};

/// Does the way from a over b to c come back on itself, or not move on?
bool needless(Vec2 a, Vec2 b, Vec2 c, double near) {
  const Vec2 before = b - a, after = c - b;
  const double sizeBefore = length(before), sizeAfter = length(after);
  if (sizeBefore <= near || sizeAfter <= near) return true;
  return dot(before, after) < 0 && std::fabs(cross(before, after)) <= near * std::max(sizeBefore, sizeAfter);
}

/// Drops corners that coincide with the one before and ways that lead there and back.
void clean(double near, Outline& outline) {
  for (bool dropped = true; dropped && outline.size() >= 3;) {
    dropped = false;
    Outline kept;
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Vec2 before = kept.empty() ? outline.back() : kept.back();
      const Vec2 after = outline[k + 1 < outline.size() ? k + 1 : 0];
      if (needless(before, outline[k], after, near))
        dropped = true;
      else
        kept.push_back(outline[k]);
    }
    outline.swap(kept);
  }
}

}  // namespace

void snapOutlines(const std::vector<Outline>& originals, double spacing, std::vector<Outline>& outlines) {
  const Snapper snapper(originals, spacing);
  for (Outline& outline : outlines) {
    for (Vec2& p : outline) p = snapper.snapped(p);
    clean(0.5 * spacing, outline);
  }
  std::erase_if(outlines, [](const Outline& outline) { return outline.size() < 3; });
}

}  // namespace smokebox
