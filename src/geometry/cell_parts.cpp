#include "geometry/cell_parts.h"

#include <algorithm>
#include <cmath>

namespace smokebox {
namespace {

/// Parts of less than this share of a cell are rounding, not fluid (an outline along a grid line leaves such
/// slivers).
constexpr double kSliver = 4e-6;
constexpr double kAlike = 1e-9;  // areas and places nearer to each other than this, in cells, are the same
constexpr double kFine = 1 << 26;

/// Area and centre of a polygon given point by point, in units of the cell, relative to its corner.
class Shoelace {
 public:
  Shoelace(const Grid& grid, int i, int j) : corner_{i * grid.h, j * grid.h}, scale_(1 / grid.h) {}
  void add(Vec2 p) {
    const Vec2 local = scale_ * (p - corner_);
    if (empty_) {
      first_ = local;
    } else {
      const double twice = cross(last_ - first_, local - first_);
      twice_ += twice;
      moment_ = moment_ + twice * ((last_ - first_) + (local - first_));
    }
    last_ = local;
    empty_ = false;
  }
  double area() const { return twice_ / 2; }
  Vec2 centre() const { return first_ + (1 / (3 * twice_)) * moment_; }

 private:
  Vec2 corner_, first_, last_, moment_;
  double scale_, twice_ = 0;
  bool empty_ = true;
};

class CellCut {
 public:
  CellCut(const Grid& grid, int i, int j, GridCover& cover)
      : grid_(grid), i_(i), j_(j), cover_(cover), work_(cover.work) {}

  void run(bool perimeterOpen) {
    collectEnds();
    cut(perimeterOpen);
    work_.keptPart.push_back(kept_ < 0 ? -1 : work_.partCount + kept_);
    work_.partCount += parts_;
    work_.arcStart.push_back(static_cast<int>(work_.arcs.size()));
  }

 private:
  using End = CoverWork::End;

  void cut(bool perimeterOpen) {
    float& volume = cover_.volume(i_, j_);
    if (work_.ends.empty()) {
      volume = perimeterOpen ? static_cast<float>(std::clamp(1 - islandArea(-1), 0.0, 1.0)) : 0.0f;
      if (perimeterOpen) keepWhole();
      return;
    }
    if (!endsTakeTurns()) {  // outlines that cross themselves by a rounding
      keepWhole();
      volume = 0.25f * ((cover_.openX(i_, j_) + cover_.openX(i_ + 1, j_)) +
                        (cover_.openY(i_, j_) + cover_.openY(i_, j_ + 1)));
      return;
    }
    traceParts();
    // In whole parts of a cell: slivers, which are differences of larger areas, keep no rounding of those.
    volume = kept_ < 0 ? 0.0f
                       : static_cast<float>(std::nearbyint(std::clamp(keptArea_, 0.0, 1.0) * kFine) / kFine);
    if (parts_ > 1 || kept_ < 0) shutTheOthers();
  }

  /// One part, which leads to all faces.
  void keepWhole() {
    for (int side = 0; side < 4; ++side) noteArc(side, corner((side + 3) % 4), corner(side));
    kept_ = parts_++;
  }

  void noteArc(int side, Vec2 from, Vec2 to) {
    const bool xFace = side == 1 || side == 3;
    const double a = xFace ? from.y : from.x, b = xFace ? to.y : to.x;
    work_.arcs.push_back({side, std::min(a, b), std::max(a, b), work_.partCount + parts_});
  }

  End endOf(int crossing, int piece, bool entry) const {
    const LineCrossing& c = work_.crossings[crossing];
    const int horizontal = 2 * grid_.nx + 1;  // lines from here on run along x
    End end{0, piece, 0, c.position, entry};
    if (c.line >= horizontal)
      end.side = c.line - horizontal == 2 * j_ ? 0 : 2;
    else
      end.side = c.line == 2 * i_ ? 3 : 1;
    end.key = end.side < 2 ? c.rank : -c.rank;
    return end;
  }

  void collectEnds() {
    work_.ends.clear();
    for (int p = work_.pieceOfCell[j_ * grid_.nx + i_]; p >= 0; p = work_.pieces[p].next) {
      const CellPiece& piece = work_.pieces[p];
      if (piece.entry < 0) continue;
      work_.ends.push_back(endOf(piece.entry, p, true));
      work_.ends.push_back(endOf(piece.exit, p, false));
    }
    std::sort(work_.ends.begin(), work_.ends.end(), [](const End& a, const End& b) {
      return a.side != b.side ? a.side < b.side : a.key != b.key ? a.key < b.key : a.piece < b.piece;
    });
  }

  bool endsTakeTurns() const {
    const std::size_t n = work_.ends.size();
    for (std::size_t k = 0; k < n; ++k)
      if (work_.ends[k].entry == work_.ends[k + 1 < n ? k + 1 : 0].entry) return false;
    return true;
  }

  Vec2 corner(int side) const {  // at the end of a side
    const int right = side == 0 || side == 1, top = side == 1 || side == 2;
    return {(i_ + right) * grid_.h, (j_ + top) * grid_.h};
  }

  Vec2 place(const End& end) const {
    switch (end.side) {
      case 0:
        return {end.position, j_ * grid_.h};
      case 1:
        return {(i_ + 1) * grid_.h, end.position};
      case 2:
        return {end.position, (j_ + 1) * grid_.h};
      default:
        return {i_ * grid_.h, end.position};
    }
  }

  int follower(int k) const { return k + 1 < static_cast<int>(work_.ends.size()) ? k + 1 : 0; }
  int cornersTo(int from, int to) const {
    const int turn = to <= from ? 4 : 0;  // past the first corner again
    return work_.ends[to].side + turn - work_.ends[from].side;
  }

  /// Calls arc(side, from, to, last) for the part of each face between two ends.
  template <class Arc>
  void alongPerimeter(int begin, int end, Arc&& arc) const {
    const int corners = cornersTo(begin, end);
    Vec2 from = place(work_.ends[begin]);
    for (int c = 0; c <= corners; ++c) {
      const int side = (work_.ends[begin].side + c) % 4;
      const Vec2 to = c == corners ? place(work_.ends[end]) : corner(side);
      arc(side, from, to, c == corners);
      from = to;
    }
  }

  void traceParts() {
    const int n = static_cast<int>(work_.ends.size());
    work_.part.assign(n, -1);
    work_.nextEnd.assign(n, -1);  // of an exit: the entry of the same piece
    for (int k = 0; k < n; ++k)
      for (int m = 0; m < n; ++m)
        if (!work_.ends[k].entry && work_.ends[m].entry && work_.ends[m].piece == work_.ends[k].piece)
          work_.nextEnd[k] = m;
    for (int start = 0; start < n; ++start) {
      if (!work_.ends[start].entry || work_.part[start] >= 0) continue;
      Shoelace boundary(grid_, i_, j_);
      for (int k = start; work_.part[k] < 0;) {
        work_.part[k] = parts_;
        const int out = follower(k);
        boundary.add(place(work_.ends[k]));
        alongPerimeter(k, out, [&](int side, Vec2 from, Vec2 to, bool last) {
          noteArc(side, from, to);
          if (!last) boundary.add(to);
        });
        const CellPiece& piece = work_.pieces[work_.ends[out].piece];
        for (int p = piece.last; p > piece.first; --p) boundary.add(work_.points[p]);
        k = work_.nextEnd[out];
      }
      const double area = boundary.area() - islandArea(start);
      if (area > kSliver) offer(area, boundary.centre());
      ++parts_;
    }
  }

  /// Keeps the current part if it is larger than those so far. Of equal ones it is the one farther from the
  /// middle of the grid, along x, then along y, so that mirror images keep mirrored ones; of two that are
  /// each other's image none.
  void offer(double area, Vec2 centre) {
    const double x = std::fabs(i_ + centre.x - 0.5 * grid_.nx), y = std::fabs(j_ + centre.y - 0.5 * grid_.ny);
    const auto more = [](double a, double b) { return a > b + kAlike ? 1 : a < b - kAlike ? -1 : 0; };
    int better = more(area, keptArea_);
    if (better == 0) better = more(x, keptFrom_.x);
    if (better == 0) better = more(y, keptFrom_.y);
    if (better < 0) return;
    kept_ = better > 0 ? parts_ : -1;
    keptArea_ = area;
    keptFrom_ = {x, y};
  }

  /// Area of the solids that lie wholly inside the part that starts at an end (-1: inside the cell), in
  /// cells.
  double islandArea(int start) const {
    double sum = 0;
    for (int p = work_.pieceOfCell[j_ * grid_.nx + i_]; p >= 0; p = work_.pieces[p].next) {
      const CellPiece& piece = work_.pieces[p];
      if (piece.entry >= 0) continue;
      Shoelace loop(grid_, i_, j_);
      for (int k = piece.first; k <= piece.last; ++k) loop.add(work_.points[k]);
      const double area =
          loop.area();  // a hole (negative) holds fluid that nothing reaches: it counts as solid
      if (area > 0 && (start < 0 || insidePart(start, work_.points[piece.first]))) sum += area;
    }
    return sum;
  }

  bool insidePart(int start, Vec2 point) const {
    bool inside = false;
    Vec2 last = place(work_.ends[start]);
    auto to = [&](Vec2 p) {
      if ((last.y > point.y) != (p.y > point.y) &&
          point.x < last.x + (point.y - last.y) / (p.y - last.y) * (p.x - last.x))
        inside = !inside;
      last = p;
    };
    int k = start;
    do {
      const int out = follower(k);
      for (int c = 0, corners = cornersTo(k, out); c < corners; ++c) to(corner((work_.ends[k].side + c) % 4));
      const CellPiece& piece = work_.pieces[work_.ends[out].piece];
      for (int p = piece.last; p >= piece.first; --p) to(work_.points[p]);
      k = work_.nextEnd[out];
    } while (k != start);
    return inside;
  }

  void shutTheOthers() {
    for (int k = 0, n = static_cast<int>(work_.ends.size()); k < n; ++k) {
      if (!work_.ends[k].entry || work_.part[k] == kept_) continue;
      const int end = follower(k);
      const int solid = work_.crossings[work_.pieces[work_.ends[k].piece].entry].solid;
      const int other = work_.crossings[work_.pieces[work_.ends[end].piece].exit].solid;
      alongPerimeter(k, end,
                     [&](int side, Vec2 from, Vec2 to, bool) { shutFace(side, from, to, solid, other); });
    }
  }

  void shutFace(int side, Vec2 from, Vec2 to, int solid, int other) {
    ShutPart part;
    part.xFace = side == 1 || side == 3;
    part.i = i_ + (side == 1);
    part.j = j_ + (side == 2);
    const double a = part.xFace ? from.y : from.x, b = part.xFace ? to.y : to.x;
    part.lo = std::min(a, b);
    part.hi = std::max(a, b);
    part.solid = solid;
    part.other = other;
    if (part.hi > part.lo) cover_.shut.push_back(part);
  }

  const Grid& grid_;
  int i_, j_;
  GridCover& cover_;
  CoverWork& work_;
  int parts_ = 0, kept_ = -1;
  double keptArea_ = 0;
  Vec2 keptFrom_;  // where its centre lies from the middle of the grid
};

}  // namespace

void keepLargestPart(const Grid& grid, int i, int j, bool perimeterOpen, GridCover& cover) {
  CellCut(grid, i, j, cover).run(perimeterOpen);
}

}  // namespace smokebox
