#include "geometry/coverage.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "geometry/cell_parts.h"
#include "geometry/cover_outlines.h"
#include "geometry/grid_walk.h"

namespace smokebox {
namespace {

constexpr double kGrowth = 1e-6;    // of h: see the header
constexpr double kSmallest = 1e-3;  // shares of a face nearer to 0 or 1 than this are 0 or 1
constexpr double kFullCell = 4e-6;  // shares of a cell nearer to 1 than this are 1: the growth

/// Follows outlines over the grid and notes where they cross its lines and what each cell holds of them.
class OutlineTracer {
 public:
  OutlineTracer(const Grid& grid, CoverWork& work) : grid_(grid), walk_(grid), work_(work) {}

  void trace(const LabelledOutline& outline) {
    const Outline& points = outline.points;
    const int n = static_cast<int>(points.size());
    auto at = [&](int k) { return points[k < n ? k : 0]; };
    int i = walk_.column(points[0].x), j = walk_.row(points[0].y);
    int firstEdge =
        -1;  // on which the first crossing lies: the piece that is open at the end is closed there
    int entry = -1, firstCrossing = -1, firstPoint = static_cast<int>(work_.points.size());
    work_.points.push_back(points[0]);
    for (int e = 0; e < n; ++e) {
      crossHalfLines(at(e), at(e + 1), outline.edgeSolid[e]);
      walk_.edge(at(e), at(e + 1), i, j, [&](bool vertical, int line, Vec2 point, bool forward) {
        const int crossing =
            addCrossing(vertical, line, vertical ? j : i, point, forward, outline.edgeSolid[e]);
        work_.points.push_back(point);
        if (entry >= 0)
          addPiece(i, j, firstPoint, entry, crossing);
        else {
          firstEdge = e;
          firstCrossing = crossing;
        }
        entry = crossing;
        firstPoint = static_cast<int>(work_.points.size()) - 1;
      });
      if (e + 1 < n) work_.points.push_back(points[e + 1]);
    }
    if (entry < 0) {
      addPiece(i, j, firstPoint, -1, -1);
      return;
    }
    for (int k = 0; k <= firstEdge; ++k) work_.points.push_back(points[k]);
    work_.points.push_back(pointOf(firstCrossing));
    addPiece(i, j, firstPoint, entry, firstCrossing);
  }

 private:
  int addCrossing(bool vertical, int line, int cell, Vec2 point, bool forward, int solid) {
    LineCrossing crossing;
    crossing.position = vertical ? point.y : point.x;
    crossing.line = vertical ? 2 * line : 2 * grid_.nx + 1 + 2 * line;
    crossing.cell = cell;
    crossing.solid = solid;
    // The solid lies left of the outline: above it where it runs to the right, before it where it runs
    // upwards.
    crossing.enters = vertical == forward;
    work_.crossings.push_back(crossing);
    return static_cast<int>(work_.crossings.size()) - 1;
  }

  Vec2 pointOf(int index) const {
    const LineCrossing& c = work_.crossings[index];
    const int horizontal = 2 * grid_.nx + 1;
    if (c.line < horizontal) return {c.line / 2 * grid_.h, c.position};
    return {c.position, (c.line - horizontal) / 2 * grid_.h};
  }

  void addPiece(int i, int j, int firstPoint, int entry, int exit) {
    if (i < 0 || j < 0 || i >= grid_.nx || j >= grid_.ny) return;
    CellPiece piece;
    piece.cell = j * grid_.nx + i;
    piece.first = firstPoint;
    piece.last = static_cast<int>(work_.points.size()) - 1;
    piece.entry = entry;
    piece.exit = exit;
    int& head = work_.pieceOfCell[piece.cell];
    if (head < 0) work_.cells.push_back(piece.cell);
    piece.next = head;
    head = static_cast<int>(work_.pieces.size());
    work_.pieces.push_back(piece);
  }

  /// Lines at odd multiples of h/2. Half-open: a point on a line counts as beyond it.
  void crossHalfLines(Vec2 a, Vec2 b, int solid) {
    auto before = [this](double x, int n) {  // number of such lines at or below x
      return static_cast<int>(std::clamp(std::floor(x / grid_.h + 0.5), 0.0, static_cast<double>(n)));
    };
    const int ia = before(a.x, grid_.nx), ib = before(b.x, grid_.nx);
    for (int k = std::min(ia, ib); k < std::max(ia, ib); ++k)
      work_.crossings.push_back(
          {GridWalk::heightAt(a, b, (k + 0.5) * grid_.h), 2 * k + 1, 0, solid, 0, ib > ia});
    const int ja = before(a.y, grid_.ny), jb = before(b.y, grid_.ny);
    for (int k = std::min(ja, jb); k < std::max(ja, jb); ++k)
      work_.crossings.push_back(
          {GridWalk::acrossAt(a, b, (k + 0.5) * grid_.h), 2 * grid_.nx + 2 + 2 * k, 0, solid, 0, jb < ja});
  }

  Grid grid_;
  GridWalk walk_;
  CoverWork& work_;
};

/// Sorts the crossings by line and position; ranks them.
void sortCrossings(int lines, CoverWork& work) {
  std::vector<LineCrossing>& crossings = work.crossings;
  work.lineStart.assign(lines + 1, 0);
  for (const LineCrossing& c : crossings) ++work.lineStart[c.line + 1];
  for (int k = 0; k < lines; ++k) work.lineStart[k + 1] += work.lineStart[k];
  work.lineOrder.resize(crossings.size());
  for (int k = 0; k < static_cast<int>(crossings.size()); ++k) {
    LineCrossing& c = crossings[k];
    c.rank = 0;
    work.lineOrder[work.lineStart[c.line]++] = k;
  }
  for (int k = lines; k > 0; --k) work.lineStart[k] = work.lineStart[k - 1];
  work.lineStart[0] = 0;
  for (int line = 0; line < lines; ++line) {
    int* begin = work.lineOrder.data() + work.lineStart[line];
    int* end = work.lineOrder.data() + work.lineStart[line + 1];
    std::sort(begin, end, [&](int a, int b) {
      const LineCrossing &p = crossings[a], &q = crossings[b];
      return p.position != q.position ? p.position < q.position : p.cell != q.cell ? p.cell < q.cell : a < b;
    });
    // Where two coincide, the one that fits comes first: into a solid from outside, out of it from inside.
    bool inside = false;
    for (int* k = begin; k != end; ++k) {
      if (crossings[*k].enters == inside)
        for (int* m = k + 1; m != end && crossings[*m].position == crossings[*k].position &&
                             crossings[*m].cell == crossings[*k].cell;
             ++m)
          if (crossings[*m].enters != inside) {
            std::swap(*k, *m);
            break;
          }
      inside = crossings[*k].enters;
      crossings[*k].rank = static_cast<int>(k - begin);
    }
  }
}

void collectIntervals(const CoverWork& work, int line, LineCover& cover) {
  cover.clear();
  int depth = 0;
  CoveredInterval interval;
  for (int k = work.lineStart[line]; k < work.lineStart[line + 1]; ++k) {
    const LineCrossing& c = work.crossings[work.lineOrder[k]];
    if (c.enters) {
      if (depth++ == 0) {
        interval.lo = c.position;
        interval.solidLo = c.solid;
      }
    } else if (--depth == 0) {
      interval.hi = c.position;
      interval.solidHi = c.solid;
      if (interval.hi > interval.lo) cover.push_back(interval);
    }
  }
}

/// Calls part(k, lo, hi) for the cells k of 0..n-1 along a line that an interval reaches, clipped to each.
template <class Part>
void forCells(const CoveredInterval& interval, double h, int n, Part&& part) {
  const int first = std::max(0, static_cast<int>(std::floor(std::max(interval.lo, -h) / h)));
  for (int k = first; k < n && k * h < interval.hi; ++k) {
    const double lo = std::max(interval.lo, k * h), hi = std::min(interval.hi, (k + 1) * h);
    if (hi > lo) part(k, lo, hi);
  }
}

/// Takes what is closed of a face from its share: in float64, where the order of the parts, which is not the
/// mirror image's, is all one.
class ShareOfFace {
 public:
  /// The parts of one face come one after the other.
  void take(float& open, double share) {
    if (&open != open_) {
      open_ = &open;
      left_ = open;
    }
    left_ -= share;
    open = std::max(0.0f, static_cast<float>(left_));
  }

 private:
  const float* open_ = nullptr;
  double left_ = 0;
};

void closeCoveredFaces(const Grid& grid, GridCover& cover) {
  const float perMetre = static_cast<float>(1 / grid.h);
  ShareOfFace face;
  auto close = [&](float& open, double lo, double hi) {
    if (hi - lo >= grid.h * (1 - 1e-9))
      open = 0;
    else
      face.take(open, static_cast<float>(hi - lo) * perMetre);
  };
  for (int i = 0; i <= grid.nx; ++i)
    for (const CoveredInterval& interval : cover.alongY[2 * i])
      forCells(interval, grid.h, grid.ny,
               [&](int j, double lo, double hi) { close(cover.openX(i, j), lo, hi); });
  for (int j = 0; j <= grid.ny; ++j)
    for (const CoveredInterval& interval : cover.alongX[2 * j])
      forCells(interval, grid.h, grid.nx,
               [&](int i, double lo, double hi) { close(cover.openY(i, j), lo, hi); });
}

/// Cells without any outline are open or not as their centre is.
void closeCoveredCells(const Grid& grid, GridCover& cover) {
  for (int j = 0; j < grid.ny; ++j)
    for (const CoveredInterval& interval : cover.alongX[2 * j + 1]) {
      const double first = std::ceil(interval.lo / grid.h - 0.5),
                   last = std::floor(interval.hi / grid.h - 0.5);
      for (int i = static_cast<int>(std::max(first, 0.0)); i < grid.nx && i <= last; ++i)
        cover.volume(i, j) = 0;
    }
}

bool sameSolids(const ShutPart& a, const ShutPart& b) {
  const auto first = [](const ShutPart& p) { return std::pair(p.solid, p.solidAtEnd); };
  const auto second = [](const ShutPart& p) { return std::pair(p.other, p.otherAtEnd); };
  return (first(a) == first(b) && second(a) == second(b)) || (first(a) == second(b) && second(a) == first(b));
}

/// The parts of one face: of a stretch that several shut all count alike.
void settleFace(const ShutPart* begin, const ShutPart* end, double least, std::vector<double>& cuts,
                std::vector<ShutPart>& settled) {
  cuts.clear();
  for (const ShutPart* part = begin; part != end; ++part) cuts.insert(cuts.end(), {part->lo, part->hi});
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t k = 1; k < cuts.size(); ++k) {
    const double lo = cuts[k - 1], hi = cuts[k];
    if (!(hi - lo > least)) continue;
    const std::size_t first = settled.size();
    bool alike = true;
    for (const ShutPart* part = begin; part != end; ++part) {
      if (part->lo > lo || part->hi < hi) continue;
      alike = alike && (settled.size() == first || sameSolids(settled[first], *part));
      settled.push_back(*part);
      settled.back().lo = lo;
      settled.back().hi = hi;
    }
    if (alike && settled.size() > first) settled.resize(first + 1);
    for (std::size_t m = first; m < settled.size(); ++m)
      settled[m].weight = 1.0 / static_cast<double>(settled.size() - first);
  }
}

/// Both cells of a face may have shut the same part; joined sides are one face.
void settleShutParts(const Grid& grid, JoinedSides joined, GridCover& cover) {
  for (ShutPart& part : cover.shut) {
    int& line = part.xFace ? part.i : part.j;
    if (!(part.xFace ? joined.x : joined.y) || line != (part.xFace ? grid.nx : grid.ny)) continue;
    line = 0;
    part.solidAtEnd = part.otherAtEnd = true;
  }
  auto place = [](const ShutPart& p) { return std::make_tuple(!p.xFace, p.j, p.i); };
  std::sort(cover.shut.begin(), cover.shut.end(), [&](const ShutPart& a, const ShutPart& b) {
    return std::make_tuple(place(a), a.lo, a.hi, a.solid) < std::make_tuple(place(b), b.lo, b.hi, b.solid);
  });
  std::vector<ShutPart>& settled = cover.work.settled;
  settled.clear();
  for (std::size_t k = 0; k < cover.shut.size();) {
    std::size_t end = k + 1;
    while (end < cover.shut.size() && place(cover.shut[end]) == place(cover.shut[k])) ++end;
    settleFace(cover.shut.data() + k, cover.shut.data() + end, 1e-9 * grid.h, cover.work.cuts, settled);
    k = end;
  }
  cover.shut.swap(settled);
  ShareOfFace face;
  for (const ShutPart& part : cover.shut)
    face.take(part.xFace ? cover.openX(part.i, part.j) : cover.openY(part.i, part.j),
              part.weight * static_cast<float>((part.hi - part.lo) / grid.h));
}

void snapFaces(const Grid& grid, JoinedSides joined, GridCover& cover) {
  auto snap = [](float& open) { open = open < kSmallest ? 0.0f : open > 1 - kSmallest ? 1.0f : open; };
  for (const LineCrossing& c : cover.work.crossings) {
    const bool vertical = c.line <= 2 * grid.nx;
    const int line = vertical ? c.line : c.line - (2 * grid.nx + 1);
    if (line % 2 != 0 || c.cell < 0 || c.cell >= (vertical ? grid.ny : grid.nx)) continue;
    snap(vertical ? cover.openX(line / 2, c.cell) : cover.openY(c.cell, line / 2));
  }
  for (const ShutPart& part : cover.shut)
    snap(part.xFace ? cover.openX(part.i, part.j) : cover.openY(part.i, part.j));
  if (joined.x)
    for (int j = 0; j < grid.ny; ++j) cover.openX(grid.nx, j) = cover.openX(0, j);
  if (joined.y)
    for (int i = 0; i < grid.nx; ++i) cover.openY(i, grid.ny) = cover.openY(i, 0);
}

void resetFields(const Grid& grid, GridCover& cover) {
  for (Field* field : {&cover.openX, &cover.openY, &cover.volume})
    if (field->nx() != grid.nx || field->ny() != grid.ny) *field = Field(grid.nx, grid.ny);
  if (static_cast<long>(cover.work.pieceOfCell.size()) != grid.cells() ||
      static_cast<int>(cover.alongX.size()) != 2 * grid.ny + 1) {
    cover.alongX.resize(2 * grid.ny + 1);
    cover.alongY.resize(2 * grid.nx + 1);
    cover.work.pieceOfCell.assign(grid.cells(), -1);
  }
  for (int j = 0; j < grid.ny; ++j) {
    std::fill_n(cover.openX.row(j), grid.nx + 1, 1.0f);
    std::fill_n(cover.openY.row(j), grid.nx, 1.0f);
    std::fill_n(cover.volume.row(j), grid.nx, 1.0f);
  }
  std::fill_n(cover.openY.row(grid.ny), grid.nx, 1.0f);
}

}  // namespace

void coverGrid(const Grid& grid, const std::vector<SolidOutline>& solids, GridCover& cover,
               JoinedSides joined) {
  CoverWork& work = cover.work;
  resetFields(grid, cover);
  work.crossings.clear();
  work.points.clear();
  work.pieces.clear();
  work.cells.clear();
  cover.shut.clear();

  prepareOutlines(solids, kGrowth * grid.h, work);
  OutlineTracer tracer(grid, work);
  for (int k = 0; k < work.outlineCount; ++k) tracer.trace(work.outlines[k]);
  sortCrossings(2 * grid.nx + 1 + 2 * grid.ny + 1, work);
  for (int k = 0; k <= 2 * grid.nx; ++k) collectIntervals(work, k, cover.alongY[k]);
  for (int k = 0; k <= 2 * grid.ny; ++k) collectIntervals(work, 2 * grid.nx + 1 + k, cover.alongX[k]);

  closeCoveredFaces(grid, cover);
  closeCoveredCells(grid, cover);
  work.arcs.clear();
  work.arcStart.assign(1, 0);
  work.keptPart.clear();
  work.partCount = 0;
  for (std::size_t k = 0; k < work.cells.size(); ++k) {
    const int cell = work.cells[k], i = cell % grid.nx, j = cell / grid.nx;
    keepLargestPart(grid, i, j, cover.openX(i, j) > 0.5f, cover);
    float& volume = cover.volume(i, j);
    if (volume > 1 - kFullCell) volume = 1;
    work.pieceOfCell[cell] = static_cast<int>(k);
  }
  mapRegions(grid, joined, cover);
  for (int cell : work.cells) work.pieceOfCell[cell] = -1;
  settleShutParts(grid, joined, cover);
  snapFaces(grid, joined, cover);
}

}  // namespace smokebox
