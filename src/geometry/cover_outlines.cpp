#include "geometry/cover_outlines.h"

#include <algorithm>
#include <cmath>

#include "geometry/merge.h"
#include "geometry/snap_outlines.h"

namespace smokebox {
namespace {

LabelledOutline& nextOutline(CoverWork& work) {
  if (work.outlineCount == static_cast<int>(work.outlines.size())) work.outlines.emplace_back();
  return work.outlines[work.outlineCount++];
}

void findBoxes(const std::vector<SolidOutline>& solids, double growth, CoverWork& work) {
  work.boxes.clear();
  for (const SolidOutline& solid : solids) {
    double box[4] = {1e300, 1e300, -1e300, -1e300};
    for (const Outline& outline : solid.outlines)
      for (Vec2 p : outline) {
        box[0] = std::min(box[0], p.x - 2 * growth);
        box[1] = std::min(box[1], p.y - 2 * growth);
        box[2] = std::max(box[2], p.x + 2 * growth);
        box[3] = std::max(box[3], p.y + 2 * growth);
      }
    work.boxes.insert(work.boxes.end(), box, box + 4);
  }
}

/// Numbers the groups of solids whose boxes overlap, directly or through others, by their first member.
void findGroups(int count, CoverWork& work) {
  std::vector<int>& group = work.group;
  group.resize(count);
  auto root = [&group](int k) {
    while (group[k] != k) k = group[k];
    return k;
  };
  for (int k = 0; k < count; ++k) {
    group[k] = k;
    const double* a = &work.boxes[4 * k];
    for (int m = 0; m < k; ++m) {
      const double* b = &work.boxes[4 * m];
      if (a[0] > b[2] || b[0] > a[2] || a[1] > b[3] || b[1] > a[3]) continue;
      const int p = root(k), q = root(m);
      group[std::max(p, q)] = std::min(p, q);
    }
  }
  for (int k = 0; k < count; ++k) group[k] = root(k);
}

double distanceSquared(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 along = b - a;
  const double size = dot(along, along);
  const double t = size > 0 ? std::clamp(dot(p - a, along) / size, 0.0, 1.0) : 0;
  const Vec2 away = p - a - t * along;
  return dot(away, away);
}

/// Finds whose edge a point of the merged outline lies on. Neighbours on the merged outline mostly are
/// neighbours on the original one: looked at first. Then come the outlines whose boxes reach there.
class EdgeFinder {
 public:
  EdgeFinder(const std::vector<LabelledOutline>& originals, double near)
      : originals_(originals), near_(near) {
    for (const LabelledOutline& original : originals) boxes_.push_back(boxOf(original.points));
  }

  int solidAt(Vec2 p) {
    if (originals_.empty()) return -1;
    const int edges = static_cast<int>(originals_[outline_].points.size());
    for (int step : {0, 1, -1}) {
      const int edge = (edge_ + step + edges) % edges;
      if (distanceTo(outline_, edge, p) > near_ * near_) continue;
      edge_ = edge;
      return originals_[outline_].edgeSolid[edge];
    }
    if (!findNearest(p, near_)) findNearest(p, 1e150);
    return originals_[outline_].edgeSolid[edge_];
  }

 private:
  bool findNearest(Vec2 p, double within) {
    double best = within * within;
    bool found = false;
    for (int o = 0; o < static_cast<int>(originals_.size()); ++o) {
      if (!boxes_[o].reaches(p, within)) continue;
      for (int e = 0; e < static_cast<int>(originals_[o].points.size()); ++e) {
        const double d = distanceTo(o, e, p);
        if (d >= best) continue;
        best = d;
        found = true;
        outline_ = o;
        edge_ = e;
      }
    }
    return found;
  }

  double distanceTo(int outline, int edge, Vec2 p) const {
    const Outline& points = originals_[outline].points;
    return distanceSquared(p, points[edge],
                           points[edge + 1 < static_cast<int>(points.size()) ? edge + 1 : 0]);
  }
  const std::vector<LabelledOutline>& originals_;
  std::vector<OutlineBox> boxes_;
  double near_;
  int outline_ = 0, edge_ = 0;
};

void addMerged(const std::vector<SolidOutline>& solids, int group, double growth, CoverWork& work) {
  std::vector<LabelledOutline> originals;
  std::vector<Outline> grown;
  for (int k = group; k < static_cast<int>(solids.size()); ++k) {
    if (work.group[k] != group) continue;
    for (const Outline& outline : solids[k].outlines) {
      if (outline.size() < 3) continue;
      LabelledOutline original;
      growOutline(outline, growth, original.points);
      original.edgeSolid.assign(outline.size(), k);
      grown.push_back(original.points);
      originals.push_back(std::move(original));
    }
  }
  const double quantum = growth / 4;
  EdgeFinder finder(originals, 2 * quantum);
  for (const Outline& outline : unionOfOutlines(grown, quantum)) {
    LabelledOutline& merged = nextOutline(work);
    merged.points = outline;
    merged.edgeSolid.resize(outline.size());
    for (std::size_t e = 0; e < outline.size(); ++e)
      merged.edgeSolid[e] = finder.solidAt(0.5 * (outline[e] + outline[e + 1 < outline.size() ? e + 1 : 0]));
  }
}

}  // namespace

void prepareOutlines(const std::vector<SolidOutline>& solids, double growth, CoverWork& work) {
  const int count = static_cast<int>(solids.size());
  work.outlineCount = 0;
  findBoxes(solids, growth, work);
  findGroups(count, work);
  for (int k = 0; k < count; ++k) {
    if (work.group[k] != k) continue;
    const bool alone = std::find(work.group.begin() + k + 1, work.group.end(), k) == work.group.end();
    if (!alone) {
      addMerged(solids, k, growth, work);
      continue;
    }
    for (const Outline& outline : solids[k].outlines) {
      if (outline.size() < 3) continue;
      LabelledOutline& own = nextOutline(work);
      growOutline(outline, growth, own.points);
      own.edgeSolid.assign(outline.size(), k);
    }
  }
}

}  // namespace smokebox
