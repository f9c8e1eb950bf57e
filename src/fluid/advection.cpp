#include "fluid/advection.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "fluid/advection_kernel.h"
#include "fluid/advection_near.h"
#include "fluid/extend.h"
#include "fluid/semi_lagrangian.h"

namespace smokebox {

namespace {

constexpr int kRowGrain = 32;
constexpr double kLargestCourant = 1.4;
constexpr int kMostSubSteps = 4;
constexpr double kTooFast = 8;  // in the middle of a sub-step: the rest would grow beyond all bounds
// Iterations of the rough projections. Between sub-steps a bare cycle does as well as an iteration or two;
// inside them, or inside a single step, the error is five times as large with it, and without any they are
// unstable. Across periodic sides, where neighbours of one colour are smoothed less, drifting vortices of 128
// cells are three times as exact with 2 inside a single step; in a box, a jet's energy is off by 0.5% and
// 0.01% with 1 and 2.
constexpr int kCyclesInside = 1, kCyclesInPeriodicStep = 2, kCyclesBetween = 0;

}  // namespace

struct Advection::Impl {
  Impl(const Boundary& boundary, ThreadPool& threads)
      : pool(threads),
        extension(boundary, threads),
        near(boundary),
        semiLagrangian(threads),
        u1(boundary.grid.nx, boundary.grid.ny),
        v1(boundary.grid.nx, boundary.grid.ny),
        u2(boundary.grid.nx, boundary.grid.ny),
        v2(boundary.grid.nx, boundary.grid.ny),
        beyond(boundary.grid.nx, 0.0f) {
    near.rebuild(boundary, extension, pool);
  }

  void stage(const Boundary& boundary, const AdvectionStage& s) {
    const int ny = boundary.grid.ny;
    pool.blocks(0, ny, kRowGrain, [&](int begin, int end) {
      advanceRowsOfU(s, begin, end);
      advanceRowsOfV(s, begin, end);
      // The last row of y-faces, on the upper side, goes with the block below it.
      near.advanceRows(boundary, s, begin, end == ny && !s.periodicY ? ny + 1 : end);
    });
  }

  void extendForStencils(const Boundary& boundary, Field& u, Field& v) const {
    extension.hideCovered(boundary, u, v);
    extension.apply(boundary, u, v);
  }

  /// One Wicker-Skamarock step of dt, `phiShare` of the whole; u, v extended in, not yet out. False, and u, v
  /// as they were, if solids that have moved make the fluid too fast for it: as they close a gap.
  bool rungeKutta(const Boundary& boundary, Field& u, Field& v, const Field& phi, const Field* accelerationU,
                  const Field* accelerationV, double dt, double phiShare,
                  const RoughProjection& projectRoughly) {
    AdvectionStage s;
    s.baseU = &u, s.baseV = &v;
    s.phi = &phi;
    s.accelerationU = accelerationU, s.accelerationV = accelerationV;
    s.periodicX = boundary.periodicX(), s.periodicY = boundary.periodicY();
    auto run = [&](const Field& inU, const Field& inV, Field& outU, Field& outV, double share) {
      s.u = &inU, s.v = &inV, s.outU = &outU, s.outV = &outV;
      s.rateScale = static_cast<float>(share * dt / boundary.grid.h);
      s.phiScale = static_cast<float>(share * phiShare);
      s.accelerationScale = static_cast<float>(share * dt);
      stage(boundary, s);
    };
    extension.hideCovered(boundary, u, v, &hidden);
    fillMargins(boundary, u, v);
    run(u, v, u1, v1, 1.0 / 3);
    extendForStencils(boundary, u1, v1);
    run(u1, v1, u2, v2, 1.0 / 2);
    extension.reveal(hidden, u2, v2);
    const bool more = phiShare == 1 && (s.periodicX || s.periodicY);
    // The increment is that of half this step.
    projectRoughly(u2, v2, more ? kCyclesInPeriodicStep : kCyclesInside, 2 / phiShare);
    if (solidsMoved &&
        largestSpeed(boundary, u2, v2, phi, nullptr, nullptr, dt) * dt > kTooFast * boundary.grid.h) {
      extension.reveal(hidden, u, v);
      return false;
    }
    extendForStencils(boundary, u2, v2);
    run(u2, v2, u1, v1, 1);
    extension.reveal(hidden, u1, v1);
    u.swap(u1);
    v.swap(v1);
    return true;
  }

  /// One step of dt, `phiShare` of the whole, of any size; closed faces and margins come out extended.
  void leap(const Boundary& boundary, Field& u, Field& v, const Field& phi, const Field* accelerationU,
            const Field* accelerationV, double dt, double phiShare) {
    extension.apply(boundary, u, v, true);
    const auto push = [&](int begin, int end) {
      addImpulse(boundary, u1, v1, phi, accelerationU, accelerationV, dt, phiShare, begin, end);
    };
    semiLagrangian.carry(boundary, u, v, dt, extension.anySolid(), u1, v1, std::ref(push));
    extension.apply(boundary, u1, v1);
    u.swap(u1);
    v.swap(v1);
  }

  /// u += dt acceleration - phiShare grad phi, on open faces of rows [first, last).
  void addImpulse(const Boundary& boundary, Field& u, Field& v, const Field& phi, const Field* accelerationU,
                  const Field* accelerationV, double dt, double phiShare, int first, int last) const {
    const int nx = boundary.grid.nx, ny = boundary.grid.ny;
    const bool wrapX = boundary.periodicX(), wrapY = boundary.periodicY();
    const auto seconds = static_cast<float>(dt), share = static_cast<float>(phiShare);
    auto push = [&](float* q, const float* open, const float* acceleration, const float* ahead,
                    const float* behind, int begin, int end) {
      if (acceleration) {
#pragma omp simd
        for (int i = begin; i < end; ++i)
          q[i] += open[i] > 0 ? seconds * acceleration[i] - share * (ahead[i] - behind[i]) : 0.0f;
      } else {
#pragma omp simd
        for (int i = begin; i < end; ++i) q[i] += open[i] > 0 ? share * (behind[i] - ahead[i]) : 0.0f;
      }
    };
    for (int j = first; j < last; ++j) {
      const float *rowU = accelerationU ? accelerationU->row(j) : nullptr,
                  *rowV = accelerationV ? accelerationV->row(j) : nullptr;
      const float *at = j < ny ? phi.row(j) : beyond.data(), *below = j > 0   ? phi.row(j - 1)
                                                                      : wrapY ? phi.row(ny - 1)
                                                                              : beyond.data();
      push(v.row(j), boundary.openY.row(j), rowV, at, below, 0, nx);
      if (j == ny) continue;
      push(u.row(j), boundary.openX.row(j), rowU, at, at - 1, 1, nx);
      auto edge = [&](int i, float ahead, float behind) {
        if (boundary.openX(i, j) > 0) u(i, j) += (rowU ? seconds * rowU[i] : 0.0f) - share * (ahead - behind);
      };
      edge(0, at[0], wrapX ? at[nx - 1] : 0.0f);
      if (!wrapX) edge(nx, 0.0f, at[nx - 1]);
    }
  }

  /// Largest |u|+|v| over the cells, each component from the faster of the cell's two faces. If the fluid is
  /// pushed, also of what forces and the lagged pressure make of it within half the step, which is what the
  /// last stage is carried by: a step that starts at rest may be a huge one.
  double largestSpeed(const Boundary& boundary, const Field& u, const Field& v, const Field& phi,
                      const Field* accelerationU, const Field* accelerationV, double dt) {
    const int nx = boundary.grid.nx;
    return pool.max(0, boundary.grid.ny, kRowGrain, 0, [&](int begin, int end) {
      float largest = 0;
      for (int j = begin; j < end; ++j) {
        const float *a = u.row(j), *b = v.row(j), *c = v.row(j + 1);
#pragma omp simd reduction(max : largest)
        for (int i = 0; i < nx; ++i) {
          const float x = std::max(std::fabs(a[i]), std::fabs(a[i + 1]));
          const float y = std::max(std::fabs(b[i]), std::fabs(c[i]));
          largest = std::max(largest, x + y);
        }
        if ((!accelerationU && !accelerationV) || j == 0) continue;
        const float *pushU = accelerationU ? accelerationU->row(j) : beyond.data(),
                    *pushV = accelerationV ? accelerationV->row(j) : beyond.data();
        const float *openX = boundary.openX.row(j), *openY = boundary.openY.row(j);
        const float *here = phi.row(j), *below = phi.row(j - 1);
        const auto half = static_cast<float>(0.5 * dt);
#pragma omp simd reduction(max : largest)
        for (int i = 1; i < nx; ++i) {
          const float x = a[i] + (half * pushU[i] - 0.5f * (here[i] - here[i - 1]));
          const float y = b[i] + (half * pushV[i] - 0.5f * (here[i] - below[i]));
          const float fast = (openX[i] > 0 ? std::fabs(x) : 0.0f) + (openY[i] > 0 ? std::fabs(y) : 0.0f);
          largest = std::max(largest, fast);
        }
      }
      return static_cast<double>(largest);
    });
  }

  ThreadPool& pool;
  bool solidsMoved = false;  // since the last step
  VelocityExtension extension;
  VelocityExtension::Hidden hidden;
  NearFaces near;
  SemiLagrangian semiLagrangian;
  Field u1, v1, u2, v2;       // after the first and the second stage
  std::vector<float> beyond;  // a row of zeros: phi outside
};

Advection::Advection(const Boundary& boundary, ThreadPool& pool)
    : impl_(std::make_unique<Impl>(boundary, pool)) {}

Advection::~Advection() = default;

void Advection::rebuild(const Boundary& boundary) {
  impl_->extension.rebuild(boundary);
  impl_->near.rebuild(boundary, impl_->extension, impl_->pool);
  impl_->semiLagrangian.rebuild();
  impl_->solidsMoved = true;
}

Advection::Result Advection::advance(const Boundary& boundary, Field& u, Field& v, const Field& phi,
                                     const Field* accelerationU, const Field* accelerationV, double dt,
                                     const RoughProjection& projectRoughly) {
  Impl& m = *impl_;
  m.extension.setWalls(boundary, u, v);  // a surface that starts to move fast counts
  Result result;
  result.courant =
      m.largestSpeed(boundary, u, v, phi, accelerationU, accelerationV, dt) * dt / boundary.grid.h;
  if (result.courant <= kMostSubSteps * kLargestCourant) {
    result.subSteps = std::max(1, static_cast<int>(std::ceil(result.courant / kLargestCourant)));
    const double share = 1.0 / result.subSteps;
    m.extension.apply(boundary, u, v);
    for (int k = 0; k < result.subSteps; ++k) {
      if (!m.rungeKutta(boundary, u, v, phi, accelerationU, accelerationV, share * dt, share,
                        projectRoughly)) {
        const double left = 1 - k * share;
        m.leap(boundary, u, v, phi, accelerationU, accelerationV, left * dt, left);
        result.subSteps = 0;
        break;
      }
      if (k + 1 < result.subSteps) projectRoughly(u, v, kCyclesBetween, result.subSteps);
      m.extension.apply(boundary, u, v);
    }
  } else {
    m.leap(boundary, u, v, phi, accelerationU, accelerationV, dt, 1);
  }
  m.solidsMoved = false;
  return result;
}

void Advection::extend(const Boundary& boundary, Field& u, Field& v) const {
  impl_->extension.apply(boundary, u, v);
}

void Advection::holdCovered(const Boundary& boundary, Field& u, Field& v, double coefficient) const {
  impl_->extension.holdCovered(boundary, u, v, coefficient);
}

std::size_t Advection::bytes() const {
  return impl_->extension.bytes() + impl_->near.bytes() + impl_->semiLagrangian.bytes() + impl_->u1.bytes() +
         impl_->v1.bytes() + impl_->u2.bytes() + impl_->v2.bytes();
}

void extendVelocity(const Boundary& boundary, Field& u, Field& v) {
  ThreadPool pool(1);
  VelocityExtension(boundary, pool).apply(boundary, u, v);
}

}  // namespace smokebox
