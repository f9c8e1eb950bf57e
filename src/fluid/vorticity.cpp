#include "fluid/vorticity.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

namespace {

constexpr int kRowGrain = 32;
constexpr float kFade = 1e-3f;  // of the largest gradient

/// Whether a node of the grid touches a shut face; beyond a side that does not wrap there are none.
bool touchesShutFace(const Boundary& b, int i, int j) {
  const int nx = b.grid.nx, ny = b.grid.ny;
  auto shutX = [&](int jj) {
    if (b.periodicY()) jj = (jj + ny) % ny;
    return jj >= 0 && jj < ny && !(b.openX(b.periodicX() && i == nx ? 0 : i, jj) > 0);
  };
  auto shutY = [&](int ii) {
    if (b.periodicX()) ii = (ii + nx) % nx;
    return ii >= 0 && ii < nx && !(b.openY(ii, b.periodicY() && j == ny ? 0 : j) > 0);
  };
  return shutX(j) || shutX(j - 1) || shutY(i) || shutY(i - 1);
}

}  // namespace

void vorticityAtNodes(const Boundary& boundary, const Field& u, const Field& v, ThreadPool& pool,
                      Field& omega) {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  const auto perMetre = static_cast<float>(1 / boundary.grid.h);
  pool.blocks(0, ny + 1, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const float *above = u.row(j), *below = u.row(j - 1), *q = v.row(j);
      float* out = omega.row(j);
#pragma omp simd
      for (int i = 0; i <= nx; ++i) out[i] = perMetre * ((q[i] - q[i - 1]) - (above[i] - below[i]));
    }
  });
}

Confinement::Confinement(const Boundary& boundary, ThreadPool& pool)
    : pool_(pool),
      omega_(boundary.grid.nx, boundary.grid.ny),
      forceX_(boundary.grid.nx, boundary.grid.ny),
      forceY_(boundary.grid.nx, boundary.grid.ny) {}

void Confinement::addForce(const Boundary& boundary, const Field& u, const Field& v, double strength,
                           double length, Field& accelerationU, Field& accelerationV) {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  vorticityAtNodes(boundary, u, v, pool_, omega_);

  // |omega| goes on beyond the sides as it is on them, or by its period.
  const bool wrapX = boundary.periodicX(), wrapY = boundary.periodicY();
  for (int j = 0; j <= ny; ++j) {
    float* row = omega_.row(j);
    row[-1] = wrapX ? row[nx - 1] : row[0];
    row[nx + 1] = wrapX ? row[1] : row[nx];
  }
  std::copy_n(omega_.row(wrapY ? ny - 1 : 0), nx + 1, omega_.row(-1));
  std::copy_n(omega_.row(wrapY ? 1 : ny), nx + 1, omega_.row(ny + 1));

  const auto perTwoMetres = static_cast<float>(0.5 / boundary.grid.h);
  const double steepestSquare = pool_.max(0, ny + 1, kRowGrain, 0, [&](int begin, int end) {
    float largest = 0;
    for (int j = begin; j < end; ++j) {
      const float *w = omega_.row(j), *above = omega_.row(j + 1), *below = omega_.row(j - 1);
      float *gx = forceX_.row(j), *gy = forceY_.row(j);
#pragma omp simd reduction(max : largest)
      for (int i = 0; i <= nx; ++i) {
        gx[i] = perTwoMetres * (std::fabs(w[i + 1]) - std::fabs(w[i - 1]));
        gy[i] = perTwoMetres * (std::fabs(above[i]) - std::fabs(below[i]));
        largest = std::max(largest, gx[i] * gx[i] + gy[i] * gy[i]);
      }
    }
    return static_cast<double>(largest);
  });
  if (!(steepestSquare > 0)) return;

  const float fadeSquare = std::max(static_cast<float>(steepestSquare) * (kFade * kFade), 1e-37f);
  const auto scale = static_cast<float>(strength * length);
  pool_.blocks(0, ny + 1, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const float* w = omega_.row(j);
      float *fx = forceX_.row(j), *fy = forceY_.row(j);
#pragma omp simd
      for (int i = 0; i <= nx; ++i) {
        const float gx = fx[i], gy = fy[i];
        const float perSlope = scale * w[i] / std::sqrt(gx * gx + gy * gy + fadeSquare);
        fx[i] = perSlope * gy;
        fy[i] = -(perSlope * gx);
      }
      const float *openX = boundary.openX.row(j), *openY = boundary.openY.row(j);
      const float* openBelow = boundary.openX.row(j - 1);
      for (int i = 0; i <= nx; ++i) {
        // Beside the domain's sides the map of open faces may not go on: look twice there.
        const bool inside = i > 0 && i < nx && j > 0 && j < ny;
        const bool open = inside && openX[i] > 0 && openBelow[i] > 0 && openY[i] > 0 && openY[i - 1] > 0;
        if (open || (!inside && !touchesShutFace(boundary, i, j))) continue;
        fx[i] = fy[i] = 0;
      }
    }
  });

  pool_.blocks(0, ny + 1, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const float *fx = forceX_.row(j), *fxAbove = forceX_.row(j + 1), *fy = forceY_.row(j);
      const float *openX = boundary.openX.row(j), *openY = boundary.openY.row(j);
      float *au = accelerationU.row(j), *av = accelerationV.row(j);
      if (j < ny) {
#pragma omp simd
        for (int i = 0; i <= nx; ++i) au[i] += openX[i] > 0 ? 0.5f * (fx[i] + fxAbove[i]) : 0.0f;
      }
#pragma omp simd
      for (int i = 0; i < nx; ++i) av[i] += openY[i] > 0 ? 0.5f * (fy[i] + fy[i + 1]) : 0.0f;
    }
  });
}

std::size_t Confinement::bytes() const { return omega_.bytes() + forceX_.bytes() + forceY_.bytes(); }

}  // namespace smokebox
