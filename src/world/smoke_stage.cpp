#include "world/smoke_stage.h"

#include <algorithm>

namespace smokebox {

SmokeStage::SmokeStage(const SceneSpec& spec, const Boundary& boundary, double tolerance, ThreadPool& pool)
    : grid_(spec.domain.grid),
      tolerance_(tolerance),
      pool_(pool),
      colors_(spec.smokeColors()),
      smoke_(boundary, pool, static_cast<int>(colors_.size())) {
  placeSources(spec, boundary);
}

void SmokeStage::placeSources(const SceneSpec& spec, const Boundary& boundary) {
  sources_.clear();
  for (const SourceSpec& source : spec.smoke.sources) {
    Source made{source, channelOf(source.color), Field(grid_.nx, grid_.ny)};
    coverShare(grid_, outlinesOf(source.shape, tolerance_), made.share);
    fillRim(boundary, made.share);
    sources_.push_back(std::move(made));
  }
}

int SmokeStage::channelOf(const Color& color) const {
  const auto found = std::find(colors_.begin(), colors_.end(), color);
  checkInvariant(found != colors_.end(), "every colour of smoke has a channel");
  return static_cast<int>(found - colors_.begin());
}

void SmokeStage::emit(const Boundary& boundary, double time, double dt) {
  for (const Source& source : sources_) {
    // The part of the step in which the source is on.
    const double on = std::min(time + dt, source.spec.until) - std::max(time, source.spec.from);
    if (on > 0 && source.spec.rate != 0)
      smoke_.add(boundary, source.channel, source.share, source.spec.rate * std::min(on, dt));
  }
}

void SmokeStage::burst(const Boundary& boundary, const BurstAction& burst) {
  Field share(grid_.nx, grid_.ny);
  coverShare(grid_, outlinesOf(burst.shape, tolerance_), share);
  smoke_.add(boundary, channelOf(burst.color), share, burst.smoke);
}

void SmokeStage::addBuoyancy(const Boundary& boundary, double buoyancy, Vec2 gravity, Field& accelerationU,
                             Field& accelerationV) const {
  const double g = length(gravity);
  const Vec2 up = g > 0 ? (-1 / g) * gravity : Vec2{0, 1};
  const auto halfX = static_cast<float>(0.5 * buoyancy * up.x),
             halfY = static_cast<float>(0.5 * buoyancy * up.y);
  const int nx = grid_.nx, ny = grid_.ny;
  const bool wrapX = boundary.periodicX(), wrapY = boundary.periodicY();
  constexpr int kRows = 16;
  pool_.blocks(0, ny + 1, kRows, [&](int begin, int end) {
    for (int channel = 0; channel < smoke_.channels(); ++channel) {
      const Field& value = smoke_.value(channel);
      for (int j = begin; j < end; ++j) {
        // On the rim the cell beyond is the other side's, or the same as the one inside.
        const float* here = value.row(j < ny ? j : wrapY ? 0 : ny - 1);
        const float* below = value.row(j > 0 ? j - 1 : wrapY ? ny - 1 : 0);
        // Most of the rows of a scene hold no smoke, and most columns of the others.
        constexpr int kBlock = 64;
        const auto holds = [&](int first) {
          std::int32_t any = 0;
          const int last = std::min(nx, first + kBlock);
#pragma omp simd reduction(| : any)
          for (int i = first; i < last; ++i) any |= (below[i] != 0) | (here[i] != 0);
          return any != 0;
        };
        int left = 0, right = nx;
        while (left < nx && !holds(left)) left += kBlock;
        if (left >= nx) continue;
        while (!holds((right - 1) / kBlock * kBlock)) right = (right - 1) / kBlock * kBlock;
        const float *openX = boundary.openX.row(j), *openY = boundary.openY.row(j);
        if (halfX != 0 && j < ny) {
          float* au = accelerationU.row(j);
#pragma omp simd
          for (int i = std::max(1, left); i < std::min(nx, right + 1); ++i)
            au[i] += openX[i] > 0 ? halfX * (here[i - 1] + here[i]) : 0.f;
          if (openX[0] > 0) au[0] += halfX * (here[wrapX ? nx - 1 : 0] + here[0]);
          if (openX[nx] > 0) au[nx] += halfX * (here[nx - 1] + here[wrapX ? 0 : nx - 1]);
        }
        if (halfY != 0) {
          float* av = accelerationV.row(j);
#pragma omp simd
          for (int i = left; i < right; ++i) av[i] += openY[i] > 0 ? halfY * (below[i] + here[i]) : 0.f;
        }
      }
    }
  });
}

void SmokeStage::driveFluid(const Boundary& boundary, double time, Fluid& fluid) const {
  for (const Source& source : sources_)
    if (source.spec.velocity && time >= source.spec.from && time < source.spec.until)
      fluid.drive(boundary, source.share, source.spec.velocity->x, source.spec.velocity->y);
}

std::size_t SmokeStage::bytes() const {
  std::size_t bytes = smoke_.bytes();
  for (const Source& source : sources_) bytes += source.share.bytes();
  return bytes;
}

}  // namespace smokebox
