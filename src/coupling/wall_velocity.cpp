#include "coupling/wall_velocity.h"

#include <algorithm>
#include <cmath>

namespace smokebox {
namespace {

constexpr double kAlike = 1e-9;  // of h

/// One kind of faces at a time; coordinates are swapped so that "along" is the direction of the face's line.
class FaceVelocities {
 public:
  FaceVelocities(const CoveredBy& by, bool xFaces, const Grid& grid, Field& wall, FaceWeights& weights)
      : by_(by),
        xFaces_(xFaces),
        h_(grid.h),
        lines_(xFaces ? grid.nx + 1 : grid.ny + 1),
        faces_(xFaces ? grid.ny : grid.nx),
        wall_(wall),
        covered_(weights.covered),
        touched_(weights.touched) {}

  void run(bool joined) {
    const std::vector<LineCover>& covers = xFaces_ ? by_.geometry.alongY : by_.geometry.alongX;
    for (int line = 0; line < lines_; ++line)
      for (const CoveredInterval& interval : covers[2 * line]) addInterval(line, interval);
    for (const ShutPart& part : by_.geometry.shut) {
      if (part.xFace != xFaces_) continue;
      const int line = xFaces_ ? part.i : part.j, face = xFaces_ ? part.j : part.i;
      const Vec2 velocity = by_.at(part).velocity;
      addPart(line, face, part.lo, part.hi, velocity, part.weight);
      if (joined && line == 0) addPart(lines_ - 1, face, part.lo, part.hi, velocity, part.weight);
    }
  }

 private:
  float& at(Field& field, int line, int face) const {
    return xFaces_ ? field(line, face) : field(face, line);
  }

  void addInterval(int line, const CoveredInterval& interval) {
    const int begin = std::max(0, static_cast<int>(std::floor(std::max(interval.lo, -h_) / h_)));
    for (int face = begin; face < faces_ && face * h_ < interval.hi; ++face) {
      const double lo = std::max(interval.lo, face * h_), hi = std::min(interval.hi, (face + 1) * h_);
      if (!(hi > lo)) continue;
      const double beyond = (lo + hi) - (interval.lo + interval.hi);  // of the interval's middle, twice
      const int first = beyond < kAlike * h_ ? interval.solidLo : interval.solidHi,
                second = beyond > -kAlike * h_ ? interval.solidHi : interval.solidLo;
      const double middle = 0.5 * (lo + hi), across = line * h_;
      const Vec2 place = xFaces_ ? Vec2{across, middle} : Vec2{middle, across};
      addPart(line, face, lo, hi, by_.at(first, second, place).velocity);
    }
  }

  void addPart(int line, int face, double lo, double hi, Vec2 velocity, double weight = 1) {
    const double normal = xFaces_ ? velocity.x : velocity.y;
    float& wall = at(wall_, line, face);
    const double share = weight * (hi - lo) / h_;
    if (share > 1 - 1e-9 && line > 0 && line < lines_ - 1) {  // nothing else closes this face
      wall = static_cast<float>(normal);
      return;
    }
    float& slot = at(covered_, line, face);
    if (slot == 0) {
      touched_.push_back(xFaces_ ? FaceSum{line, face} : FaceSum{face, line});
      slot = static_cast<float>(touched_.size());
    }
    FaceSum& sum = touched_[static_cast<std::size_t>(slot) - 1];
    sum.share += share;
    sum.flux += share * normal;
    sum.fastest = std::max(sum.fastest, std::fabs(normal));
  }

  const CoveredBy& by_;
  bool xFaces_;
  double h_;
  int lines_, faces_;
  Field &wall_, &covered_;
  std::vector<FaceSum>& touched_;
};

/// The mean over what covers each face; then `covered` is which share of it that is.
void average(Field& wall, FaceWeights& weights) {
  for (const FaceSum& face : weights.touched) {
    wall(face.i, face.j) = static_cast<float>(rounded(face.flux / face.share, face.fastest));
    weights.covered(face.i, face.j) = static_cast<float>(face.share);
  }
}

/// Adds the wall's or inflow's own velocity on the part of its faces that no solid covers.
void addSide(const Boundary& boundary, Side side, Field& wall, const Field& weight) {
  const SideFlow& flow = boundary.side(side);
  if (flow.kind == WallKind::open || flow.kind == WallKind::periodic) return;
  const bool vertical = side == Side::left || side == Side::right;
  const std::vector<float>& normal = vertical ? flow.u : flow.v;
  const Grid& grid = boundary.grid;
  const int faces = vertical ? grid.ny : grid.nx;
  for (int k = 0; k < faces; ++k) {
    const int i = vertical ? (side == Side::left ? 0 : grid.nx) : k;
    const int j = vertical ? k : (side == Side::bottom ? 0 : grid.ny);
    const float own = flow.kind == WallKind::inflow && !normal.empty() ? normal[k] : 0.0f;
    const float covered = std::min(weight(i, j), 1.0f);
    wall(i, j) = covered * wall(i, j) + (1 - covered) * own;
  }
}

/// No velocity where so little closes the face that it counts as open; the weights go back to 0.
void finish(const Field& open, Field& wall, FaceWeights& weights) {
  for (const FaceSum& face : weights.touched) {
    if (open(face.i, face.j) == 1) wall(face.i, face.j) = 0;
    weights.covered(face.i, face.j) = 0;
  }
  weights.touched.clear();
}

}  // namespace

void setWallVelocities(const CoveredBy& by, Boundary& boundary, FaceWeights& ofU, FaceWeights& ofV) {
  const Grid& grid = boundary.grid;
  for (FaceWeights* weights : {&ofU, &ofV})
    if (weights->covered.nx() != grid.nx || weights->covered.ny() != grid.ny)
      weights->covered = Field(grid.nx, grid.ny);
  boundary.wallU.fill(0);
  boundary.wallV.fill(0);
  FaceVelocities(by, true, grid, boundary.wallU, ofU).run(boundary.periodicX());
  FaceVelocities(by, false, grid, boundary.wallV, ofV).run(boundary.periodicY());
  average(boundary.wallU, ofU);
  average(boundary.wallV, ofV);
  addSide(boundary, Side::left, boundary.wallU, ofU.covered);
  addSide(boundary, Side::right, boundary.wallU, ofU.covered);
  addSide(boundary, Side::bottom, boundary.wallV, ofV.covered);
  addSide(boundary, Side::top, boundary.wallV, ofV.covered);
  finish(boundary.openX, boundary.wallU, ofU);
  finish(boundary.openY, boundary.wallV, ofV);
  wrapFaces(boundary, true, boundary.wallU);
  wrapFaces(boundary, false, boundary.wallV);
}

namespace {

int wrapped(int k, int n) { return ((k % n) + n) % n; }

/// `columns`, `rows`: how many the field has of its own, in [0, n] or [0, n).
void wrap(const Boundary& boundary, int columns, int rows, Field& field) {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  if (boundary.periodicX())
    for (int j = 0; j < rows; ++j) {
      float* row = field.row(j);
      for (int i = -Field::kMarginX; i < 0; ++i) row[i] = row[wrapped(i, nx)];
      for (int i = nx; i < nx + Field::kMarginX; ++i) row[i] = row[wrapped(i, nx)];
    }
  if (!boundary.periodicY()) return;
  const int first = boundary.periodicX() ? -Field::kMarginX : 0;
  const int count = boundary.periodicX() ? nx + 2 * Field::kMarginX : columns;
  for (int j = -Field::kMarginY; j < 0; ++j)
    std::copy_n(field.row(wrapped(j, ny)) + first, count, field.row(j) + first);
  for (int j = ny; j < ny + Field::kMarginY; ++j)
    std::copy_n(field.row(wrapped(j, ny)) + first, count, field.row(j) + first);
}

}  // namespace

void wrapFaces(const Boundary& boundary, bool xFaces, Field& field) {
  const Grid& grid = boundary.grid;
  wrap(boundary, xFaces ? grid.nx + 1 : grid.nx, xFaces ? grid.ny : grid.ny + 1, field);
}

void wrapCells(const Boundary& boundary, Field& field) {
  wrap(boundary, boundary.grid.nx, boundary.grid.ny, field);
}

}  // namespace smokebox
