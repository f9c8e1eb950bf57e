#include "coupling/solids_on_grid.h"

#include <algorithm>
#include <cmath>

#include "coupling/cut_links.h"
#include "coupling/wall_velocity.h"

namespace smokebox {
namespace {

constexpr int kMostCopies = 100;  // along x or y: of a solid far wider than a periodic domain only the middle

/// Whole numbers, which may be too large for an int.
struct Range {
  double first, last;
};

void closeSide(const Boundary& boundary, Side side, Field& open) {
  const WallKind kind = boundary.side(side).kind;
  if (kind == WallKind::open || kind == WallKind::periodic) return;
  const Grid& grid = boundary.grid;
  if (side == Side::bottom || side == Side::top)
    std::fill_n(open.row(side == Side::bottom ? 0 : grid.ny), grid.nx, 0.0f);
  else
    for (int j = 0; j < grid.ny; ++j) open(side == Side::left ? 0 : grid.nx, j) = 0;
}

void setShares(GridCover& cover, Boundary& boundary) {
  boundary.openX.swap(cover.openX);
  boundary.openY.swap(cover.openY);
  boundary.volume.swap(cover.volume);
  std::swap(boundary.regions, cover.regions);
  closeSide(boundary, Side::left, boundary.openX);
  closeSide(boundary, Side::right, boundary.openX);
  closeSide(boundary, Side::bottom, boundary.openY);
  closeSide(boundary, Side::top, boundary.openY);
  wrapFaces(boundary, true, boundary.openX);
  wrapFaces(boundary, false, boundary.openY);
  wrapCells(boundary, boundary.volume);
  ++boundary.version;
}

bool shaped(const Field& field, const Grid& grid) { return field.nx() == grid.nx && field.ny() == grid.ny; }

/// By j, then i, then direction.
void sortLinks(int rows, std::vector<CutLink>& links, std::vector<CutLink>& sorted,
               std::vector<int>& rowStart) {
  rowStart.assign(rows + 2, 0);
  for (const CutLink& link : links) ++rowStart[link.j + 1];
  for (int j = 0; j <= rows; ++j) rowStart[j + 1] += rowStart[j];
  sorted.resize(links.size());
  for (const CutLink& link : links) sorted[rowStart[link.j]++] = link;
  auto earlier = [](const CutLink& a, const CutLink& b) {
    if (a.j != b.j) return a.j < b.j;
    if (a.i != b.i) return a.i < b.i;
    // Along x first, then along y: mirror images are added up in one order.
    if (a.dj * a.dj != b.dj * b.dj) return a.dj == 0;
    return a.dj != b.dj ? a.dj < b.dj : a.di < b.di;
  };
  for (int j = 0, begin = 0; j <= rows; begin = rowStart[j++]) {
    const auto first = sorted.begin() + begin, last = sorted.begin() + rowStart[j];
    if (!std::is_sorted(first, last, earlier)) std::sort(first, last, earlier);
  }
  links.swap(sorted);
}

}  // namespace

std::vector<Vec2> SolidsOnGrid::imagesOf(const MovingSolid& solid, const Boundary& boundary) {
  const Grid& grid = boundary.grid;
  std::vector<Vec2> shifts;
  Vec2 lo{1e300, 1e300}, hi{-1e300, -1e300};
  for (const Outline& outline : solid.outlines)
    for (Vec2 p : outline) {
      lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
      hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
  if (lo.x > hi.x) return shifts;
  // Images that reach the domain, or a cell beyond it: links look that far.
  auto images = [&](bool periodic, double from, double to, double size) {
    Range range{std::ceil((-grid.h - to) / size), std::floor((size + grid.h - from) / size)};
    if (!periodic) return Range{std::max(range.first, 0.0), std::min(range.last, 0.0)};
    if (range.last - range.first < kMostCopies) return range;
    const double middle = std::floor(0.5 * (range.first + range.last));
    return Range{middle - kMostCopies / 2, middle + kMostCopies / 2};
  };
  // None for a solid far away, however far: then no rounding of its outline can do harm.
  const Range alongX = images(boundary.periodicX(), lo.x, hi.x, grid.width()),
              alongY = images(boundary.periodicY(), lo.y, hi.y, grid.height());
  for (int y = 0; alongY.first + y <= alongY.last && y <= kMostCopies; ++y)
    for (int x = 0; alongX.first + x <= alongX.last && x <= kMostCopies; ++x)
      shifts.push_back({(alongX.first + x) * grid.width(), (alongY.first + y) * grid.height()});
  return shifts;
}

void SolidsOnGrid::placeCopies(const std::vector<MovingSolid>& solids, const Boundary& boundary) {
  copies_.clear();
  for (std::size_t k = 0; k < solids.size(); ++k)
    for (const Vec2 shift : imagesOf(solids[k], boundary)) copies_.push_back({static_cast<int>(k), shift});
  outlines_.resize(copies_.size());
  for (std::size_t c = 0; c < copies_.size(); ++c) {
    outlines_[c].outlines = solids[copies_[c].solid].outlines;
    if (copies_[c].shift == Vec2{}) continue;
    for (Outline& outline : outlines_[c].outlines)
      for (Vec2& p : outline) p = p + copies_[c].shift;
  }
}

void SolidsOnGrid::cover(const std::vector<MovingSolid>& solids, bool shapesMoved, Boundary& boundary) {
  const Grid& grid = boundary.grid;
  if (!shaped(boundary.wallU, grid)) {
    boundary.wallU = Field(grid.nx, grid.ny);
    boundary.wallV = Field(grid.nx, grid.ny);
  }
  if (shapesMoved || !shaped(boundary.openX, grid)) {
    placeCopies(solids, boundary);
    coverGrid(grid, outlines_, cover_, {boundary.periodicX(), boundary.periodicY()});
    setShares(cover_, boundary);
  }
  mixed_.find(grid, cover_.work, static_cast<int>(copies_.size()), [&](int a, int b) {
    const MovingSolid &p = solids[copies_[a].solid], &q = solids[copies_[b].solid];
    return p.velocity == q.velocity && p.spin == 0 && q.spin == 0 && p.drag == q.drag;
  });
  const CoveredBy by{solids, copies_, cover_, mixed_, grid};
  setWallVelocities(by, boundary, weightsU_, weightsV_);
  findCutLinks(by, true, boundary, boundary.linksU);
  findCutLinks(by, false, boundary, boundary.linksV);
  sortLinks(grid.ny + 1, boundary.linksU, sorted_, rowStart_);
  sortLinks(grid.ny + 1, boundary.linksV, sorted_, rowStart_);
}

}  // namespace smokebox
