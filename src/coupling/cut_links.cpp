#include "coupling/cut_links.h"

#include <algorithm>
#include <cmath>

namespace smokebox {
namespace {

bool fixes(WallKind kind) { return kind != WallKind::open && kind != WallKind::periodic; }
bool holds(WallKind kind) { return kind == WallKind::noSlip || kind == WallKind::inflow; }

/// Links of one velocity component along one direction, line by line. On each line the velocities sit at
/// (first + k) h + offset, k = 0..count-1.
class LinkFinder {
 public:
  LinkFinder(const CoveredBy& by, bool ofU, bool alongX, const Boundary& boundary,
             std::vector<CutLink>& links)
      : by_(by), ofU_(ofU), alongX_(alongX), boundary_(boundary), h_(boundary.grid.h), links_(links) {
    const Grid& grid = boundary.grid;
    cells_ = alongX ? grid.nx : grid.ny;
    lines_ = alongX ? grid.ny : grid.nx;
    normal_ = ofU == alongX;  // the component's own direction: velocities on grid lines, else half a cell off
    offset_ = normal_ ? 0 : 0.5;
    periodic_ = alongX ? boundary.periodicX() : boundary.periodicY();
    periodicAcross_ = alongX ? boundary.periodicY() : boundary.periodicX();
    lowSide_ = alongX ? Side::left : Side::bottom;
    highSide_ = alongX ? Side::right : Side::top;
    first_ = normal_ && fixes(boundary.side(lowSide_).kind) ? 1 : 0;
    last_ = !normal_ || periodic_ || fixes(boundary.side(highSide_).kind) ? cells_ - 1 : cells_;
  }

  void run() {
    const std::vector<LineCover>& covers = alongX_ ? by_.geometry.alongX : by_.geometry.alongY;
    // Normal: the lines through the middles of cells. Else the grid lines, which carry fixed velocities at
    // closed sides and are the same at periodic ones.
    int begin = 0, end = lines_;
    if (!normal_) {
      const Side low = alongX_ ? Side::bottom : Side::left, high = alongX_ ? Side::top : Side::right;
      if (fixes(boundary_.side(low).kind)) begin = 1;
      if (!periodicAcross_ && !fixes(boundary_.side(high).kind)) end = lines_ + 1;
    }
    for (int line = begin; line < end; ++line) followLine(line, covers[normal_ ? 2 * line + 1 : 2 * line]);
    for (const ShutPart& part : by_.geometry.shut)
      if (part.xFace == ofU_) linkToShutFace(part, covers);
  }

 private:
  const Field& open() const { return ofU_ ? boundary_.openX : boundary_.openY; }
  const Field& wall() const { return ofU_ ? boundary_.wallU : boundary_.wallV; }
  double positionOf(int k) const { return (k + offset_) * h_; }
  bool openAt(int k, int line) const { return (alongX_ ? open()(k, line) : open()(line, k)) > 0; }
  float wallAt(int k, int line) const { return alongX_ ? wall()(k, line) : wall()(line, k); }

  void add(int k, int line, int step, double theta, double drag, double velocity, int solid) {
    CutLink link;
    link.i = alongX_ ? k : line;
    link.j = alongX_ ? line : k;
    link.di = alongX_ ? step : 0;
    link.dj = alongX_ ? 0 : step;
    link.theta = static_cast<float>(std::clamp(theta, 1e-3, 1.0));
    link.drag = static_cast<float>(drag);
    link.velocity = static_cast<float>(velocity);
    link.solid = solid;
    links_.push_back(link);
  }

  void addSolid(int k, int line, int step, double surface, int copy) {
    const double across = (line + (normal_ ? 0.5 : 0)) * h_;
    const CoveredBy::Surface there = by_.at(copy, alongX_ ? Vec2{surface, across} : Vec2{across, surface});
    add(k, line, step, std::fabs(surface - positionOf(k)) / h_, there.drag,
        ofU_ ? there.velocity.x : there.velocity.y, there.solid);
  }

  void followLine(int line, const LineCover& cover) {
    const double length = cells_ * h_;
    double free = -1e300;  // solids seen so far end here
    bool lowMet = false, highMet = false;
    for (std::size_t n = 0; n < cover.size(); ++n) {
      const CoveredInterval& interval = cover[n];
      const double until = n + 1 < cover.size() ? cover[n + 1].lo : 1e300;
      lowMet |= interval.lo <= positionOf(first_) && interval.hi > 0;
      highMet |= interval.hi >= positionOf(last_) && interval.lo < length;
      const int before =
          static_cast<int>(std::ceil(std::clamp(interval.lo / h_, -2.0, cells_ + 2.0) - offset_)) - 1;
      if (before >= first_ && before <= last_ && positionOf(before) >= free &&
          positionOf(before) < interval.lo && (periodic_ || interval.lo < length) && openAt(before, line))
        addSolid(before, line, 1, interval.lo, interval.solidLo);
      const int after =
          static_cast<int>(std::floor(std::clamp(interval.hi / h_, -2.0, cells_ + 2.0) - offset_)) + 1;
      if (after >= first_ && after <= last_ && positionOf(after) <= until &&
          positionOf(after) > interval.hi && (periodic_ || interval.hi > 0) && openAt(after, line))
        addSolid(after, line, -1, interval.hi, interval.solidHi);
      free = interval.hi;
    }
    if (periodic_ || last_ < first_) return;
    if (!lowMet && openAt(first_, line)) linkToSide(lowSide_, line, first_, -1);
    if (!highMet && openAt(last_, line)) linkToSide(highSide_, line, last_, 1);
  }

  /// The velocity nearest to a side of the domain, no solid between.
  void linkToSide(Side side, int line, int k, int step) {
    const SideFlow& flow = boundary_.side(side);
    if (normal_) {
      if (fixes(flow.kind)) add(k, line, step, 1, 1, wallAt(k + step, line), -1);
      return;
    }
    if (!holds(flow.kind)) return;
    const std::vector<float>& along = ofU_ ? flow.u : flow.v;
    double velocity = 0;
    if (!along.empty()) {  // at the middles of the side's faces; the velocity sits between two of them
      const int n = static_cast<int>(along.size());
      const int below = line > 0 ? line - 1 : periodicAcross_ ? n - 1 : 0;
      velocity = 0.5 * (along[below] + along[std::min(line, n - 1)]);
    }
    add(k, line, step, 0.5, 1, velocity, -1);
  }

  /// The faces before and behind one that is shut though its centre is in the fluid.
  void linkToShutFace(const ShutPart& part, const std::vector<LineCover>& covers) {
    const int k = alongX_ ? part.i : part.j, line = alongX_ ? part.j : part.i;
    if (openAt(k, line) || (&part != by_.geometry.shut.data() && sameFace(part, *(&part - 1)))) return;
    if (!normal_ && !periodicAcross_ && (line == 0 || line == lines_) &&
        fixes(boundary_.side(sideAcross(line)).kind))
      return;
    for (int step : {-1, 1}) {
      int from = k - step;
      if (periodic_) from = ((from % cells_) + cells_) % cells_;
      if (from < first_ || from > last_ || k < (normal_ ? 0 : first_) || !openAt(from, line)) continue;
      const LineCover& cover = covers[normal_ ? 2 * line + 1 : 2 * line];
      const double a = positionOf(from), b = a + step * h_;
      const double lo = std::min(a, b), hi = std::max(a, b);
      const bool met = std::any_of(cover.begin(), cover.end(),
                                   [&](const CoveredInterval& c) { return c.hi >= lo && c.lo <= hi; });
      // A wall of the domain's own face is linked already.
      const bool side =
          normal_ && !periodic_ && (k == 0 || k == cells_) && (k == 0 ? first_ == 1 : last_ < cells_);
      if (met || side) continue;
      const CoveredBy::Surface there = shutFace(&part);
      add(from, line, step, 1, there.drag, wallAt(k, line), there.solid);
    }
  }

  /// The drag is the mean of all parts of the face, of which this is the first.
  CoveredBy::Surface shutFace(const ShutPart* part) const {
    const ShutPart* const end = by_.geometry.shut.data() + by_.geometry.shut.size();
    CoveredBy::Surface mean = by_.at(*part);
    const double first = mean.drag;
    double weight = part->weight * (part->hi - part->lo), more = 0;
    for (const ShutPart* next = part + 1; next != end && sameFace(*part, *next); ++next) {
      const double own = next->weight * (next->hi - next->lo);
      weight += own;
      more += own * (by_.at(*next).drag - first);
    }
    mean.drag += more / weight;
    return mean;
  }

  Side sideAcross(int line) const {
    if (alongX_) return line == 0 ? Side::bottom : Side::top;
    return line == 0 ? Side::left : Side::right;
  }
  static bool sameFace(const ShutPart& a, const ShutPart& b) {
    return a.xFace == b.xFace && a.i == b.i && a.j == b.j;
  }

  const CoveredBy& by_;
  bool ofU_, alongX_;
  const Boundary& boundary_;
  double h_;
  std::vector<CutLink>& links_;
  int cells_ = 0, lines_ = 0, first_ = 0, last_ = 0;
  double offset_ = 0;
  bool normal_ = true, periodic_ = false, periodicAcross_ = false;
  Side lowSide_ = Side::left, highSide_ = Side::right;
};

}  // namespace

void findCutLinks(const CoveredBy& by, bool ofU, const Boundary& boundary, std::vector<CutLink>& links) {
  links.clear();
  LinkFinder(by, ofU, true, boundary, links).run();
  LinkFinder(by, ofU, false, boundary, links).run();
}

}  // namespace smokebox
