#include "fluid/surface_ghosts.h"

#include <algorithm>

namespace smokebox {

namespace {

constexpr std::uint8_t kStarts = 1, kCovered = 2;
constexpr double kNear = 0.5;  // in cells: a surface nearer than this is no base for a slope
constexpr double kOnSurface = 1e-3;
constexpr float kThinnest = 1e-2f;  // open share that friction is found for

}  // namespace

class SurfaceGhosts::Finder {
 public:
  Finder(SurfaceGhosts& ghosts, const Boundary& boundary, bool alongX, int columns, int rows)
      : ghosts_(ghosts),
        alongX_(alongX),
        wrapX_(boundary.periodicX()),
        wrapY_(boundary.periodicY()),
        columns_(columns),
        rows_(rows),
        open_(alongX ? boundary.openX : boundary.openY),
        links_(alongX ? boundary.linksU : boundary.linksV) {}

  void sortArrivals() {
    auto& arrivals = ghosts_.arrivals_;
    arrivals.clear();
    for (std::size_t k = 0; k < links_.size(); ++k) {
      const CutLink& link = links_[k];
      if (link.i >= columns_ || link.j >= rows_ || !(open_(link.i, link.j) > 0)) continue;
      ghosts_.kind_(link.i, link.j) |= kStarts;
      Vec2i at{link.i + link.di, link.j + link.dj};
      if (link.solid >= 0 && inside(at)) arrivals.push_back({indexOf(at), static_cast<int>(k)});
    }
    // Those along x first, so that mirror images add up in the same order.
    std::sort(arrivals.begin(), arrivals.end(), [&](const Arrival& a, const Arrival& b) {
      if (a.target != b.target) return a.target < b.target;
      const bool acrossA = links_[a.link].di == 0, acrossB = links_[b.link].di == 0;
      return acrossA != acrossB ? acrossB : a.link < b.link;
    });
  }

  void findCovered() {
    const auto& arrivals = ghosts_.arrivals_;
    for (std::size_t begin = 0, end; begin < arrivals.size(); begin = end) {
      end = begin + 1;
      while (end < arrivals.size() && arrivals[end].target == arrivals[begin].target) ++end;
      const CutLink& first = links_[arrivals[begin].link];
      Vec2i at{first.i + first.di, first.j + first.dj};
      inside(at);
      const float open = open_(at.i, at.j);
      if (!(open > 0) || open >= 1 || (ghosts_.kind_(at.i, at.j) & kStarts)) continue;
      const float drag = dragOf(begin, end);
      if (drag == 0) continue;
      GhostRecipe recipe;
      recipe.target = arrivals[begin].target;
      recipe.own = 1 - drag;
      addSurface(begin, end, drag, recipe);
      ghosts_.covered.push_back(recipe);
      ghosts_.kind_(at.i, at.j) |= kCovered;
      hold(begin, end, open);
    }
  }

  void findClosed(const std::vector<Vec2i>& front) {
    const auto& arrivals = ghosts_.arrivals_;
    for (const Vec2i at : front) {
      const int target = indexOf(at);
      const auto from = std::lower_bound(arrivals.begin(), arrivals.end(), target,
                                         [](const Arrival& a, int wanted) { return a.target < wanted; });
      const auto begin = static_cast<std::size_t>(from - arrivals.begin());
      std::size_t end = begin;
      while (end < arrivals.size() && arrivals[end].target == target) ++end;
      const float drag = dragOf(begin, end);
      GhostRecipe recipe;
      recipe.target = target;
      if (drag > 0) addSurface(begin, end, drag, recipe);
      if ((drag < 1 && !addFluid(at, 1 - drag, recipe)) || recipe.count + recipe.linkCount == 0)
        ghosts_.deeper.push_back(at);
      else
        ghosts_.closed.push_back(recipe);
    }
  }

  void clear() {
    for (const CutLink& link : links_) {
      ghosts_.kind_(link.i, link.j) = 0;
      Vec2i at{link.i + link.di, link.j + link.dj};
      if (inside(at)) ghosts_.kind_(at.i, at.j) = 0;
    }
  }

 private:
  /// Where a neighbour lies; false beyond a side that does not wrap.
  bool inside(Vec2i& at) const {
    if (wrapX_) at.i = at.i < 0 ? at.i + columns_ : at.i >= columns_ ? at.i - columns_ : at.i;
    if (wrapY_) at.j = at.j < 0 ? at.j + rows_ : at.j >= rows_ ? at.j - rows_ : at.j;
    return at.i >= 0 && at.i < columns_ && at.j >= 0 && at.j < rows_;
  }
  int indexOf(Vec2i at) const { return static_cast<int>(at.j * open_.stride() + at.i); }

  float dragOf(std::size_t begin, std::size_t end) const {
    float drag = 0;
    for (std::size_t k = begin; k < end; ++k) drag = std::max(drag, links_[ghosts_.arrivals_[k].link].drag);
    return std::clamp(drag, 0.0f, 1.0f);
  }

  /// Whether a surface lies between a face and its neighbour.
  bool isCut(Vec2i from, int di, int dj) const {
    if (!(ghosts_.kind_(from.i, from.j) & kStarts)) return false;
    auto link = std::lower_bound(links_.begin(), links_.end(), from, [](const CutLink& a, Vec2i at) {
      return a.j != at.j ? a.j < at.j : a.i < at.i;
    });
    for (; link != links_.end() && link->i == from.i && link->j == from.j; ++link)
      if (link->di == di && link->dj == dj) return true;
    return false;
  }

  /// The face behind `from`, seen against (di, dj), if the fluid joins them.
  bool before(Vec2i from, int di, int dj, Vec2i& behind) const {
    behind = {from.i - di, from.j - dj};
    return inside(behind) && open_(behind.i, behind.j) > 0 &&
           !(ghosts_.kind_(behind.i, behind.j) & kCovered) && !isCut(from, -di, -dj);
  }

  /// Adds `share` of what the links make of it: 0 at the surface, and on in a straight line.
  void addSurface(std::size_t begin, std::size_t end, double share, GhostRecipe& recipe) const {
    auto weightOf = [&](std::size_t k) {
      const double behind = std::max(1.0 - links_[ghosts_.arrivals_[k].link].theta, kOnSurface);
      return 1 / (behind * behind);
    };
    end = std::min(end, begin + GhostRecipe::kMostLinks);
    double sum = 0;
    for (std::size_t k = begin; k < end; ++k) sum += weightOf(k);
    for (std::size_t k = begin; k < end; ++k) {
      const int index = ghosts_.arrivals_[k].link;
      const CutLink& link = links_[index];
      const Vec2i from{link.i, link.j};
      Vec2i base = from, behind;
      double distance = link.theta;
      if (distance < kNear && before(from, link.di, link.dj, behind)) base = behind, distance += 1;
      const double slope = (1 - link.theta) / std::max(distance, kNear);
      const double weight = share * weightOf(k) / sum;
      recipe.addLink(index, link.di == 0, weight * (1 + slope));
      recipe.add(indexOf(base), link.di == 0, -weight * slope);
    }
  }

  /// Adds `share` of the mean of the neighbours in the fluid; false if there is none.
  bool addFluid(Vec2i at, double share, GhostRecipe& recipe) const {
    static constexpr int kStep[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    int count = 0;
    Vec2i from[4];
    for (int k = 0; k < 4; ++k) {
      Vec2i next{at.i + kStep[k][0], at.j + kStep[k][1]};
      if (!inside(next) || !(open_(next.i, next.j) > 0) || (ghosts_.kind_(next.i, next.j) & kCovered))
        continue;
      from[count++] = next;
    }
    if (count == 0) return false;
    const double weight = share / count;
    for (int n = 0; n < count && recipe.count + 2 <= GhostRecipe::kMostSources; ++n) {
      recipe.add(indexOf(from[n]), from[n].i == at.i, weight);
    }
    return true;
  }

  /// Friction on the open part, by the link along the face.
  void hold(std::size_t begin, std::size_t end, float open) {
    for (std::size_t k = begin; k < end; ++k) {
      const int index = ghosts_.arrivals_[k].link;
      const CutLink& link = links_[index];
      if ((link.di != 0) == alongX_) continue;
      const float fromSurface = 0.5f * std::max(open, kThinnest);
      const float beyond = std::max(link.theta - fromSurface, 0.5f);
      CoveredFace face;
      face.target = ghosts_.arrivals_[k].target;
      face.source = indexOf({link.i, link.j});
      face.link = index;
      face.share = fromSurface / (fromSurface + beyond);
      face.stiffness = link.drag * (1 / fromSurface + 1 / beyond);
      ghosts_.held.push_back(face);
    }
  }

  SurfaceGhosts& ghosts_;
  bool alongX_, wrapX_, wrapY_;
  int columns_, rows_;
  const Field& open_;
  const std::vector<CutLink>& links_;
};

void SurfaceGhosts::find(const Boundary& boundary, bool alongX, int columns, int rows,
                         const std::vector<Vec2i>& front) {
  if (kind_.bytes() == 0) kind_ = FaceMap(boundary.grid.nx, boundary.grid.ny);
  covered.clear();
  closed.clear();
  held.clear();
  deeper.clear();
  Finder finder(*this, boundary, alongX, columns, rows);
  finder.sortArrivals();
  finder.findCovered();
  finder.findClosed(front);
  finder.clear();
}

std::size_t SurfaceGhosts::bytes() const {
  return (covered.capacity() + closed.capacity()) * sizeof(GhostRecipe) +
         held.capacity() * sizeof(CoveredFace) + deeper.capacity() * sizeof(Vec2i) +
         arrivals_.capacity() * sizeof(Arrival) + kind_.bytes();
}

}  // namespace smokebox
