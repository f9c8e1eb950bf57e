#include "rigid/triangulate.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace smokebox {
namespace {

double area(Vec2 a, Vec2 b, Vec2 c) { return cross(b - a, c - a); }

bool within(Vec2 a, Vec2 b, Vec2 c, Vec2 p) {
  return area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0;
}

bool inside(const std::vector<Vec2>& points, const std::vector<int>& loop, Vec2 p) {
  bool in = false;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec2 a = points[loop[k]], b = points[loop[k + 1 < loop.size() ? k + 1 : 0]];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if (p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) in = !in;
  }
  return in;
}

int rightmost(const std::vector<Vec2>& points, const std::vector<int>& loop) {
  int best = 0;
  for (int k = 1; k < static_cast<int>(loop.size()); ++k)
    if (points[loop[k]].x > points[loop[best]].x) best = k;
  return best;
}

/// Does the way from corner `k` of the loop to `p` begin inside?
bool beginsInside(const std::vector<Vec2>& points, const std::vector<int>& loop, int k, Vec2 p) {
  const int n = static_cast<int>(loop.size());
  const Vec2 at = points[loop[k]], before = points[loop[(k + n - 1) % n]], after = points[loop[(k + 1) % n]];
  const bool leftOfIn = area(before, at, p) > 0, leftOfOut = area(at, after, p) > 0;
  return area(before, at, after) > 0 ? leftOfIn && leftOfOut : leftOfIn || leftOfOut;
}

/// A corner of `loop` that is seen from `from`, a corner of a hole, looking to the right.
int visibleCorner(const std::vector<Vec2>& points, const std::vector<int>& loop, Vec2 from) {
  const int n = static_cast<int>(loop.size());
  int best = -1;
  double nearest = 1e300;
  for (int k = 0; k < n; ++k) {  // the edge that the ray hits first runs upwards
    const Vec2 a = points[loop[k]], b = points[loop[(k + 1) % n]];
    if (!(a.y <= from.y && b.y > from.y)) continue;
    const double x = a.x + (from.y - a.y) / (b.y - a.y) * (b.x - a.x);
    if (x < from.x || x >= nearest) continue;
    nearest = x;
    best = a.x > b.x ? k : (k + 1) % n;
  }
  if (best < 0) return -1;
  // Corners within the triangle of the ray may hide it: the one of the least slope is seen.
  const Vec2 hit{nearest, from.y}, seen = points[loop[best]];
  const bool above = seen.y > from.y;
  int result = best;
  double steepest = 1e300, closest = 1e300;
  for (int k = 0; k < n; ++k) {
    const Vec2 p = points[loop[k]];
    if (p == seen || p.x < from.x) continue;
    const bool hides = above ? within(from, hit, seen, p) : within(from, seen, hit, p);
    if (!hides) continue;
    const Vec2 before = points[loop[(k + n - 1) % n]], after = points[loop[(k + 1) % n]];
    if (area(before, p, after) > 0) continue;  // convex: another hides too
    const double slope = std::fabs(p.y - from.y) / std::max(p.x - from.x, 1e-300);
    if (slope < steepest || (slope == steepest && p.x < closest)) {
      steepest = slope;
      closest = p.x;
      result = k;
    }
  }
  // A corner where bridges end is there more than once: the one on whose side the hole lies.
  for (int k = 0; k < n; ++k)
    if (loop[k] == loop[result] && beginsInside(points, loop, k, from)) return k;
  return result;
}

/// Corners of one region in order, with every hole reached over a bridge and back.
void joinHole(const std::vector<Vec2>& points, std::vector<int>& loop, const std::vector<int>& hole) {
  const int start = rightmost(points, hole);
  const int at = visibleCorner(points, loop, points[hole[start]]);
  if (at < 0) return;
  std::vector<int> bridge;
  for (std::size_t k = 0; k <= hole.size(); ++k) bridge.push_back(hole[(start + k) % hole.size()]);
  bridge.push_back(loop[at]);
  loop.insert(loop.begin() + at + 1, bridge.begin(), bridge.end());
}

/// Points by the square cell of a grid that they lie in, about one to a cell.
class PointGrid {
 public:
  PointGrid(const std::vector<Vec2>& points, std::vector<int> numbers) : numbers_(std::move(numbers)) {
    if (numbers_.empty()) return;
    Vec2 hi{-1e300, -1e300};
    for (int k : numbers_) {
      lo_ = {std::min(lo_.x, points[k].x), std::min(lo_.y, points[k].y)};
      hi = {std::max(hi.x, points[k].x), std::max(hi.y, points[k].y)};
    }
    side_ = static_cast<int>(std::clamp(std::sqrt(static_cast<double>(numbers_.size())), 1.0, 512.0));
    scale_ = {side_ / std::max(hi.x - lo_.x, 1e-300), side_ / std::max(hi.y - lo_.y, 1e-300)};
    const auto cell = [&](int k) { return row(points[k].y) * side_ + column(points[k].x); };
    std::sort(numbers_.begin(), numbers_.end(), [&](int a, int b) {
      const int ca = cell(a), cb = cell(b);
      return ca != cb ? ca < cb : a < b;
    });
    starts_.assign(static_cast<std::size_t>(side_) * side_ + 1, 0);
    for (int k : numbers_) ++starts_[cell(k) + 1];
    for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
  }

  /// Is there one for which `test` holds, in the cells that the box meets?
  template <class Test>
  bool any(Vec2 lo, Vec2 hi, const Test& test) const {
    if (numbers_.empty()) return false;
    const int first = column(lo.x), last = column(hi.x), top = row(hi.y);
    for (int y = row(lo.y); y <= top; ++y)
      for (int i = starts_[y * side_ + first]; i < starts_[y * side_ + last + 1]; ++i)
        if (test(numbers_[i])) return true;
    return false;
  }

 private:
  int column(double x) const { return cellOf((x - lo_.x) * scale_.x); }
  int row(double y) const { return cellOf((y - lo_.y) * scale_.y); }
  int cellOf(double at) const { return static_cast<int>(std::clamp(at, 0.0, side_ - 1.0)); }

  std::vector<int> numbers_, starts_;
  Vec2 lo_{1e300, 1e300}, scale_;
  int side_ = 1;
};

class EarClipper {
 public:
  EarClipper(const std::vector<Vec2>& points, const std::vector<int>& loop)
      : points_(points), loop_(loop), left_(static_cast<int>(loop.size())) {
    next_.resize(left_);
    previous_.resize(left_);
    reflex_.resize(left_);
    for (int k = 0; k < left_; ++k) {
      next_[k] = k + 1 < left_ ? k + 1 : 0;
      previous_[k] = k > 0 ? k - 1 : left_ - 1;
    }
    std::vector<Vec2> corners;
    std::vector<int> reflex;
    for (int k = 0; k < left_; ++k) {
      corners.push_back(point(k));
      reflex_[k] = !(turn(k) > 0);
      if (reflex_[k]) reflex.push_back(k);
    }
    grid_ = PointGrid(corners, reflex);
  }

  void clip(std::vector<std::array<int, 3>>& triangles) {
    int at = 0, refused = 0;
    while (left_ > 3) {
      const bool ear = !reflex_[at] && isEar(at);
      if (!ear && refused < left_) {
        ++refused;
        at = next_[at];
        continue;
      }
      if (!ear)
        at = flattest();  // rounding or outlines that touch: the region cannot be cut cleanly, but it ends
      const int after = next_[at];
      cut(at, triangles);
      refused = 0;
      at = next_[after];  // every other corner: fewer slivers
    }
    if (left_ == 3) add(at, triangles);
  }

 private:
  Vec2 point(int k) const { return points_[loop_[k]]; }
  double turn(int k) const { return area(point(previous_[k]), point(k), point(next_[k])); }

  bool isEar(int k) const {
    const Vec2 a = point(previous_[k]), b = point(k), c = point(next_[k]);
    const Vec2 lo{std::min({a.x, b.x, c.x}), std::min({a.y, b.y, c.y})};
    const Vec2 hi{std::max({a.x, b.x, c.x}), std::max({a.y, b.y, c.y})};
    const auto hides = [&](int corner) {
      const Vec2 p = point(corner);
      if (!reflex_[corner] || p.x < lo.x || p.x > hi.x || p.y < lo.y || p.y > hi.y) return false;
      return p != a && p != b && p != c && within(a, b, c, p);
    };
    return !grid_.any(lo, hi, hides) && std::none_of(late_.begin(), late_.end(), hides);
  }

  int flattest() const {
    int best = -1;
    for (int k = 0; k < static_cast<int>(loop_.size()); ++k) {
      if (next_[k] < 0) continue;
      if (best < 0 || std::fabs(turn(k)) < std::fabs(turn(best))) best = k;
    }
    return best;
  }

  void add(int k, std::vector<std::array<int, 3>>& triangles) const {
    if (turn(k) > 0) triangles.push_back({loop_[previous_[k]], loop_[k], loop_[next_[k]]});
  }

  void cut(int k, std::vector<std::array<int, 3>>& triangles) {
    add(k, triangles);
    const int before = previous_[k], after = next_[k];
    next_[before] = after;
    previous_[after] = before;
    reflex_[k] = 0;
    next_[k] = -1;  // gone
    --left_;
    for (int neighbour : {before, after}) {
      const bool was = reflex_[neighbour] != 0, is = !(turn(neighbour) > 0);
      reflex_[neighbour] = is;
      if (is && !was) late_.push_back(neighbour);
    }
  }

  const std::vector<Vec2>& points_;
  const std::vector<int>& loop_;
  std::vector<int> next_, previous_;
  std::vector<char> reflex_;
  PointGrid grid_{{}, {}};  // of the corners that were reflex at first
  std::vector<int> late_;   // those that became so by rounding
  int left_;
};

}  // namespace

std::vector<std::array<int, 3>> triangulate(const std::vector<Vec2>& points, const std::vector<int>& ends) {
  std::vector<std::vector<int>> outer, holes;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    std::vector<int> loop;
    Outline outline;
    for (int i = k > 0 ? ends[k - 1] : 0; i < ends[k]; ++i) {
      loop.push_back(i);
      outline.push_back(points[i]);
    }
    if (loop.size() < 3) continue;
    (signedArea(outline) > 0 ? outer : holes).push_back(std::move(loop));
  }
  // Holes that lie farthest to the right first: the way to the right of each is then within the region.
  std::sort(holes.begin(), holes.end(), [&](const auto& a, const auto& b) {
    const double xa = points[a[rightmost(points, a)]].x, xb = points[b[rightmost(points, b)]].x;
    return xa != xb ? xa > xb : a[0] < b[0];
  });
  std::vector<std::vector<int>> surroundings = outer;
  for (const std::vector<int>& hole : holes) {
    int best = -1;
    for (std::size_t k = 0; k < outer.size(); ++k) {
      if (!inside(points, outer[k], points[hole[rightmost(points, hole)]])) continue;
      if (best < 0 || inside(points, outer[best], points[outer[k][0]])) best = static_cast<int>(k);
    }
    if (best >= 0) joinHole(points, surroundings[best], hole);
  }
  std::vector<std::array<int, 3>> triangles;
  for (const std::vector<int>& loop : surroundings) EarClipper(points, loop).clip(triangles);
  return triangles;
}

}  // namespace smokebox
