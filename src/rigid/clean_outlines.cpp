#include "rigid/clean_outlines.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace smokebox {
namespace {

Outline cleaned(Outline outline, double tiny) {
  for (bool changed = true; changed && outline.size() >= 3;) {
    changed = false;
    Outline kept;
    const std::size_t n = outline.size();
    for (std::size_t k = 0; k < n; ++k) {
      const Vec2 before = kept.empty() ? outline[n - 1] : kept.back(), p = outline[k];
      const Vec2 in = p - before, out = outline[k + 1 < n ? k + 1 : 0] - p;
      if (length(in) <= tiny || std::fabs(cross(in, out)) <= 1e-9 * length(in) * length(out))
        changed = true;
      else
        kept.push_back(p);
    }
    outline = std::move(kept);
  }
  if (outline.size() < 3) outline.clear();
  return outline;
}

/// Grows with the angle of `direction` from the x axis, 0 to 4.
double turnOf(Vec2 direction) {
  const double share = direction.y / (std::fabs(direction.x) + std::fabs(direction.y));
  return direction.x < 0 ? 2 - share : share < 0 ? 4 + share : share;
}

/// Corners of all outlines, linked along them.
struct Corners {
  std::vector<Vec2> points;
  std::vector<int> next, previous;
};

/// At one point where several corners meet: each edge out goes with the first edge in that follows it
/// counterclockwise, for the region lies between these.
void pairSectors(const std::vector<int>& meeting, const std::vector<int>& next,
                 const std::vector<int>& previous, Corners& corners) {
  struct End {
    double turn;
    int corner;  // the edge's other end
    bool out;
  };
  std::vector<End> ends;
  const Vec2 at = corners.points[meeting[0]];
  for (int k : meeting) {
    ends.push_back({turnOf(corners.points[next[k]] - at), next[k], true});
    ends.push_back({turnOf(corners.points[previous[k]] - at), previous[k], false});
  }
  std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
    return a.turn != b.turn ? a.turn < b.turn : a.corner < b.corner;
  });
  const std::size_t n = ends.size();
  for (std::size_t k = 0; k < n; ++k)
    if (ends[k].out == ends[(k + 1) % n].out) return;  // edges on top of each other: left as they are
  std::size_t visit = 0;
  for (std::size_t k = 0; k < n; ++k) {
    if (!ends[k].out) continue;
    const int corner = meeting[visit++], after = ends[k].corner, before = ends[(k + 1) % n].corner;
    corners.next[corner] = after;
    corners.previous[after] = corner;
    corners.previous[corner] = before;
    corners.next[before] = corner;
  }
}

}  // namespace

double extentOf(const std::vector<Outline>& outlines) {
  Vec2 lo{1e300, 1e300}, hi{-1e300, -1e300};
  for (const Outline& outline : outlines)
    for (Vec2 p : outline) {
      lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
      hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
  return std::max({hi.x - lo.x, hi.y - lo.y, 0.0});
}

std::vector<Outline> cleanOutlines(const std::vector<Outline>& outlines) {
  const double tiny = 1e-8 * extentOf(outlines);
  Corners corners;
  for (const Outline& given : outlines) {
    const Outline outline = cleaned(given, tiny);
    const int first = static_cast<int>(corners.points.size()), n = static_cast<int>(outline.size());
    for (int k = 0; k < n; ++k) {
      corners.points.push_back(outline[k]);
      corners.next.push_back(first + (k + 1) % n);
      corners.previous.push_back(first + (k + n - 1) % n);
    }
  }
  const int count = static_cast<int>(corners.points.size());
  std::vector<int> order(count);
  for (int k = 0; k < count; ++k) order[k] = k;
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const double xa = corners.points[a].x, xb = corners.points[b].x;
    return xa != xb ? xa < xb : a < b;
  });
  std::vector<std::vector<int>> groups;
  std::vector<char> taken(count, 0);
  for (int i = 0; i < count; ++i) {
    if (taken[order[i]]) continue;
    const Vec2 at = corners.points[order[i]];
    std::vector<int> meeting{order[i]};
    for (int j = i + 1; j < count && corners.points[order[j]].x <= at.x + tiny; ++j)
      if (!taken[order[j]] && std::fabs(corners.points[order[j]].y - at.y) <= tiny)
        meeting.push_back(order[j]);
    if (meeting.size() < 2) continue;
    for (int k : meeting) {
      taken[k] = 1;
      corners.points[k] = at;
    }
    groups.push_back(std::move(meeting));
  }
  for (const std::vector<int>& meeting : groups) {
    const std::vector<int> next = corners.next, previous = corners.previous;
    pairSectors(meeting, next, previous, corners);
  }
  std::vector<Outline> result;
  std::vector<char> seen(count, 0);
  for (int k = 0; k < count; ++k) {
    Outline outline;
    for (int at = k; !seen[at]; at = corners.next[at]) {
      seen[at] = 1;
      outline.push_back(corners.points[at]);
    }
    outline = groups.empty() ? outline : cleaned(std::move(outline), tiny);
    if (!outline.empty()) result.push_back(std::move(outline));
  }
  return result;
}

}  // namespace smokebox
