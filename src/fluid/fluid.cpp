#include "fluid/fluid.h"

#include <algorithm>

namespace smokebox {

Fluid::Fluid(const Boundary& boundary, const Parts& parts, ThreadPool& pool)
    : parts_(parts),
      u_(boundary.grid.nx, boundary.grid.ny),
      v_(boundary.grid.nx, boundary.grid.ny),
      phi_(boundary.grid.nx, boundary.grid.ny),
      pool_(pool),
      pressure_(boundary, pool),
      advection_(boundary, pool) {
  if (parts.forced) {
    accelerationU_ = Field(boundary.grid.nx, boundary.grid.ny);
    accelerationV_ = Field(boundary.grid.nx, boundary.grid.ny);
  }
  if (parts.viscous) {
    viscousU_ = viscousV_ = Field(boundary.grid.nx, boundary.grid.ny);
    viscosity_.emplace(boundary, pool);
  }
  if (parts.confined) confinement_.emplace(boundary, pool);
}

void Fluid::boundaryChanged(const Boundary& boundary) {
  pressure_.rebuild(boundary);
  advection_.rebuild(boundary);
  if (viscosity_) viscosity_->rebuild(boundary);
}

void Fluid::prepareUncovering(const Boundary& before) { advection_.extend(before, u_, v_); }

void Fluid::beginForces(const Boundary& boundary, double confinement, double length) {
  if (viscosity_) viscosity_->bendAtWalls(boundary, u_, v_);
  const bool confined = confinement != 0, fromNothing = confined && !parts_.viscous;
  if (!fromNothing) startForces();
  if (!confined) return;
  advection_.extend(boundary, u_, v_);  // the curl beside walls and surfaces needs what lies behind them
  confinement_->addForce(boundary, u_, v_, confinement, length, accelerationU_, accelerationV_, fromNothing);
}

void Fluid::startForces() {
  constexpr int kRows = 32;
  const int nx = u_.nx();
  pool_.blocks(0, u_.ny() + 1, kRows, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      if (parts_.viscous) {
        std::copy_n(viscousU_.row(j), nx + 1, accelerationU_.row(j));
        std::copy_n(viscousV_.row(j), nx + 1, accelerationV_.row(j));
      } else {
        std::fill_n(accelerationU_.row(j), nx + 1, 0.0f);
        std::fill_n(accelerationV_.row(j), nx + 1, 0.0f);
      }
    }
  });
}

void Fluid::advect(const Boundary& boundary, double dt) {
  constexpr int kMostSmooth =
      2;  // sub-steps up to which a step's correction of the pressure resembles the last
  carried_ = advection_.advance(boundary, u_, v_, phi_, parts_.forced ? &accelerationU_ : nullptr,
                                parts_.forced ? &accelerationV_ : nullptr, dt,
                                [&](Field& u, Field& v, int cycles, double gain) {
                                  pressure_.projectRoughly(boundary, u, v, cycles, &phi_, gain);
                                });
  if (carried_.subSteps == 0 || carried_.subSteps > kMostSmooth) pressure_.forget();
}

void Fluid::diffuse(const Boundary& boundary, double viscosity, double dt) {
  constexpr int kRows = 16;
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  const auto step = static_cast<float>(dt), perStep = static_cast<float>(1 / dt);
  auto takeOut = [&](float* q, float* acceleration) {
#pragma omp simd
    for (int i = 0; i <= nx; ++i) {
      q[i] -= step * acceleration[i];
      acceleration[i] = q[i];
    }
  };
  auto findAnew = [&](const float* q, float* acceleration) {
#pragma omp simd
    for (int i = 0; i <= nx; ++i) acceleration[i] = perStep * (q[i] - acceleration[i]);
  };
  pool_.blocks(0, ny + 1, kRows, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      takeOut(u_.row(j), viscousU_.row(j));
      takeOut(v_.row(j), viscousV_.row(j));
    }
  });
  viscosity_->diffuse(boundary, u_, v_, viscosity, dt);
  findSurfaceShear(boundary, u_, v_, shear_);
  advection_.holdCovered(boundary, u_, v_, viscosity * dt / (boundary.grid.h * boundary.grid.h));
  pool_.blocks(0, ny + 1, kRows, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      findAnew(u_.row(j), viscousU_.row(j));
      findAnew(v_.row(j), viscousV_.row(j));
    }
  });
}

void Fluid::drive(const Boundary& boundary, const Field& share, double velocityX, double velocityY) {
  const Grid& grid = boundary.grid;
  const auto du = static_cast<float>(velocityX), dv = static_cast<float>(velocityY);
  for (int j = 0; j <= grid.ny; ++j)
    for (int i = 0; i <= grid.nx; ++i) {
      if (j < grid.ny && boundary.openX(i, j) > 0)
        u_(i, j) += 0.5f * (share(i - 1, j) + share(i, j)) * (du - u_(i, j));
      if (i < grid.nx && boundary.openY(i, j) > 0)
        v_(i, j) += 0.5f * (share(i, j - 1) + share(i, j)) * (dv - v_(i, j));
    }
}

void Fluid::applySurfaceDrag(const Boundary& boundary) { smokebox::applySurfaceDrag(boundary, u_, v_); }

PressureSolver::Result Fluid::project(const Boundary& boundary, double dt, double tolerance,
                                      int maxIterations) {
  return pressure_.project(boundary, u_, v_, phi_, 1e-6 * boundary.grid.h / dt, tolerance, maxIterations);
}

Fluid::ExtendedVelocity Fluid::extended(const Boundary& boundary) const {
  ExtendedVelocity copy{u_, v_};
  advection_.extend(boundary, copy.u, copy.v);
  return copy;
}

std::size_t Fluid::bytes() const {
  std::size_t bytes = u_.bytes() + v_.bytes() + phi_.bytes() + pressure_.bytes() + advection_.bytes();
  if (parts_.forced) bytes += accelerationU_.bytes() + accelerationV_.bytes();
  if (viscosity_) bytes += viscousU_.bytes() + viscousV_.bytes() + viscosity_->bytes();
  if (confinement_) bytes += confinement_->bytes();
  return bytes;
}

}  // namespace smokebox
