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
    for (int o = 0; o < static_cast<int>(originals.size()); ++o) {
      boxes_.push_back(boxOf(originals[o]));
      for (int k = 0; k < static_cast<int>(originals[o].size()); ++k)
        corners_.push_back({originals[o][k], o, k});
    }
    std::sort(corners_.begin(), corners_.end(), [](const Corner& a, const Corner& b) {
      return a.at.x != b.at.x ? a.at.x < b.at.x : a.at.y < b.at.y;
    });
  }

  Vec2 snapped(Vec2 p) {
    const double near = kCorner * spacing_;
    // Mostly it is the one beside the last on the same outline.
    const Outline& last = originals_[outline_];
    const int n = static_cast<int>(last.size());
    for (const int k : {(corner_ + 1) % n, (corner_ + n - 1) % n})
      if (std::fabs(last[k].x - p.x) <= near && std::fabs(last[k].y - p.y) <= near) {
        corner_ = k;
        return last[k];
      }
    Vec2 sum;
    int count = 0;
    for (auto c = std::lower_bound(corners_.begin(), corners_.end(), p.x - near,
                                   [](const Corner&a, double x) { return a.at.x < x; });
         c != corners_.end() && c->at.x <= p.x + near; ++c) {
      if (std::fabs(c->at.y - p.y) > near) continue;
      sum = count++ == 0 ? c->at : sum + c->at;
      outline_ = c->outline;
      corner_ = c->corner;
    }
    if (count > 0) return (1.0 / count) * sum;
    return p + toEdges(p);
  }

 private:
  struct Corner {
    Vec2 at;
    int outline, corner;
  };

  /// From p to the point nearest to the lines of the edges there.
  Vec2 toEdges(Vec2 p) const {
    const double near = kEdge * spacing_;
    double xx = 0, xy = 0, yy = 0;  // sum of n n', n the normals
    Vec2 right;                     // sum of n (distance of the line along n)
    for (std::size_t o = 0; o < originals_.size(); ++o) {
      if (!boxes_[o].reaches(p, near)) continue;
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
  std::vector<Corner> corners_;  // by x, then y
  std::vector<OutlineBox> boxes_;
  int outline_ = 0, corner_ = 0;  // of the last that was found
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

OutlineBox boxOf(const Outline& outline) {
  OutlineBox box;
  for (Vec2 p : outline) {
    box.lo = {std::min(box.lo.x, p.x), std::min(box.lo.y, p.y)};
    box.hi = {std::max(box.hi.x, p.x), std::max(box.hi.y, p.y)};
  }
  return box;
}

void snapOutlines(const std::vector<Outline>& originals, double spacing, std::vector<Outline>& outlines) {
  if (outlines.empty()) return;
  Snapper snapper(originals, spacing);
  for (Outline& outline : outlines) {
    for (Vec2& p : outline) p = snapper.snapped(p);
    clean(0.5 * spacing, outline);
  }
  std::erase_if(outlines, [](const Outline& outline) { return outline.size() < 3; });
}

}  // namespace smokebox
