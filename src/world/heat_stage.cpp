#include "world/heat_stage.h"

#include <cmath>

namespace smokebox {

HeatStage::HeatStage(const SceneSpec& spec, const Boundary& boundary, bool diffuses, ThreadPool& pool)
    : grid_(spec.domain.grid), pool_(pool), heat_(boundary, diffuses, pool) {
  const Expression& start = spec.temperature.start;
  auto startAt = [&](int i, int j) {
    const Vec2 p = grid_.cellCentre(i, j);
    return start(p.x, p.y, 0);
  };
  if (start.isConstant()) {
    origin_ = start(0, 0, 0);
  } else {
    double sum = 0, area = 0;
    for (int j = 0; j < grid_.ny; ++j)
      for (int i = 0; i < grid_.nx; ++i) {
        const double open = boundary.volume(i, j);
        if (!(open > 0)) continue;
        sum += open * startAt(i, j);
        area += open;
      }
    origin_ = area > 0 ? sum / area : 0;
  }
  heat_.start(boundary, [&](int i, int j) { return static_cast<float>(startAt(i, j) - origin_); });
  if (!start.isConstant())
    for (int j = 0; j <= 2 * grid_.ny; ++j)
      for (int i = 0; i <= 2 * grid_.nx; ++i) {
        const double value = start(0.5 * i * grid_.h, 0.5 * j * grid_.h, 0) - origin_;
        if (std::isfinite(value)) heat_.allow(value, value);
      }
  for (int side = 0; side < 4; ++side) sides_.value[side].assign(side < 2 ? grid_.ny : grid_.nx, 0.0f);
  setSides(spec, boundary, 0);
}

void HeatStage::setSides(const SceneSpec& spec, const Boundary& boundary, double time) {
  sidesDependOnTime_ = false;
  for (int side = 0; side < 4; ++side) {
    const WallKind kind = boundary.sides[side].kind;
    const bool closed = kind == WallKind::slip || kind == WallKind::noSlip;
    const auto& wall = spec.temperature.walls[side];
    sides_.keeps[side] = closed && wall.has_value();
    // What nobody says of the fluid that comes in is as warm as the fluid was there at the start.
    const Expression& given = wall ? *wall : spec.temperature.start;
    sidesDependOnTime_ |= wall && wall->dependsOnTime();
    for (std::size_t k = 0; k < sides_.value[side].size(); ++k) {
      const double along = (static_cast<double>(k) + 0.5) * grid_.h;
      const Vec2 p =
          side < 2 ? Vec2{side == 0 ? 0 : grid_.width(), along} : Vec2{along, side == 2 ? 0 : grid_.height()};
      sides_.value[side][k] = static_cast<float>(given(p.x, p.y, time) - origin_);
    }
  }
  heat_.setSides(boundary, sides_);
}

void HeatStage::addBuoyancy(const SceneSpec& spec, const Boundary& boundary, Field& accelerationU,
                            Field& accelerationV) const {
  const double expansion = spec.temperature.expansion;
  const auto halfX = static_cast<float>(-0.5 * expansion * spec.gravity.x),
             halfY = static_cast<float>(-0.5 * expansion * spec.gravity.y);
  const auto shift = static_cast<float>(2 * (origin_ - spec.temperature.reference.value_or(origin_)));
  const int nx = grid_.nx, ny = grid_.ny;
  const bool wrapX = boundary.periodicX(), wrapY = boundary.periodicY();
  const Field& value = heat_.value();
  constexpr int kRows = 16;
  pool_.blocks(0, ny + 1, kRows, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      // On the rim the cell beyond is the other side's, or the same as the one inside.
      const float* here = value.row(j < ny ? j : wrapY ? 0 : ny - 1);
      const float* below = value.row(j > 0 ? j - 1 : wrapY ? ny - 1 : 0);
      const float *openX = boundary.openX.row(j), *openY = boundary.openY.row(j);
      if (halfX != 0 && j < ny) {
        float* au = accelerationU.row(j);
#pragma omp simd
        for (int i = 1; i < nx; ++i) au[i] += openX[i] > 0 ? halfX * ((here[i - 1] + here[i]) + shift) : 0.0f;
        if (openX[0] > 0) au[0] += halfX * ((here[wrapX ? nx - 1 : 0] + here[0]) + shift);
        if (openX[nx] > 0) au[nx] += halfX * ((here[nx - 1] + here[wrapX ? 0 : nx - 1]) + shift);
      }
      if (halfY != 0) {
        float* av = accelerationV.row(j);
#pragma omp simd
        for (int i = 0; i < nx; ++i) av[i] += openY[i] > 0 ? halfY * ((below[i] + here[i]) + shift) : 0.0f;
      }
    }
  });
}

}  // namespace smokebox
