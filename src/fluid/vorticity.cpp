#include "fluid/vorticity.h"

#include <algorithm>
#include <cmath>

namespace smokebox {

namespace {

constexpr int kRowGrain = 32;
constexpr int kTile = 512;      // columns that are worked on at a time
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
    : pool_(pool), omega_(boundary.grid.nx, boundary.grid.ny) {}

double Confinement::steepestSquare() {
  const int nx = omega_.nx(), ny = omega_.ny();
  const float perTwoMetres = perTwoMetres_;
  return pool_.max(0, ny + 1, kRowGrain, 0, [&](int begin, int end) {
    float largest = 0;
    for (int j = begin; j < end; ++j) {
      const float *w = omega_.row(j), *above = omega_.row(j + 1), *below = omega_.row(j - 1);
#pragma omp simd reduction(max : largest)
      for (int i = 0; i <= nx; ++i) {
        const float gx = perTwoMetres * (std::fabs(w[i + 1]) - std::fabs(w[i - 1]));
        const float gy = perTwoMetres * (std::fabs(above[i]) - std::fabs(below[i]));
        largest = std::max(largest, gx * gx + gy * gy);
      }
    }
    return static_cast<double>(largest);
  });
}

void Confinement::forceAtNodes(const Boundary& boundary, int j, int first, int count, float scale,
                               float fadeSquare, float* fx, float* fy) const {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  const float *w = omega_.row(j) + first, *above = omega_.row(j + 1) + first,
              *below = omega_.row(j - 1) + first;
  const float perTwoMetres = perTwoMetres_;
#pragma omp simd
  for (int i = 0; i < count; ++i) {
    const float gx = perTwoMetres * (std::fabs(w[i + 1]) - std::fabs(w[i - 1]));
    const float gy = perTwoMetres * (std::fabs(above[i]) - std::fabs(below[i]));
    const float perSlope = scale * w[i] / std::sqrt(gx * gx + gy * gy + fadeSquare);
    fx[i] = perSlope * gy;
    fy[i] = -(perSlope * gx);
  }
  // Beside the domain's sides the map of open faces may not go on: look twice there.
  const auto onRim = [&](int i) {
    if (touchesShutFace(boundary, i, j)) fx[i - first] = fy[i - first] = 0;
  };
  const bool rimRow = j == 0 || j == ny;
  if (rimRow || first == 0) onRim(first);
  if (rimRow)
    for (int i = first + 1; i < first + count; ++i) onRim(i);
  else if (first + count == nx + 1)
    onRim(nx);
  if (rimRow) return;
  const float *openX = boundary.openX.row(j) + first, *openY = boundary.openY.row(j) + first,
              *openBelow = boundary.openX.row(j - 1) + first;
  const int begin = first == 0 ? 1 : 0, end = first + count == nx + 1 ? count - 1 : count;
#pragma omp simd
  for (int i = begin; i < end; ++i) {
    const bool open = (openX[i] > 0) & (openBelow[i] > 0) & (openY[i] > 0) & (openY[i - 1] > 0);
    fx[i] = open ? fx[i] : 0.0f;
    fy[i] = open ? fy[i] : 0.0f;
  }
}

void Confinement::addForce(const Boundary& boundary, const Field& u, const Field& v, double strength,
                           double length, Field& accelerationU, Field& accelerationV, bool fromNothing) {
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

  perTwoMetres_ = static_cast<float>(0.5 / boundary.grid.h);
  const double steepest = steepestSquare();
  if (!(steepest > 0)) {
    for (int j = 0; j <= ny && fromNothing; ++j)
      for (Field* acceleration : {&accelerationU, &accelerationV})
        std::fill_n(acceleration->row(j), nx + 1, 0.0f);
    return;
  }
  const float fadeSquare = std::max(static_cast<float>(steepest) * (kFade * kFade), 1e-37f);
  const auto scale = static_cast<float>(strength * length);
  // Forces at the nodes of two rows at a time, and only of some columns, so that they stay in the cache.
  pool_.blocks(0, ny + 1, kRowGrain, [&](int begin, int end) {
    alignas(64) float lines[2][2][kTile + 1];  // of even and odd rows, along x and y
    for (int first = 0; first <= nx; first += kTile) {
      const int faces = std::min(kTile, nx + 1 - first);      // x-faces
      const int nodes = std::min(kTile + 1, nx + 1 - first);  // of both sides of the y-faces
      const int across = std::min(kTile, nx - first);         // y-faces
      const auto find = [&](int j) {
        forceAtNodes(boundary, j, first, nodes, scale, fadeSquare, lines[j & 1][0], lines[j & 1][1]);
      };
      find(begin);
      for (int j = begin; j < end; ++j) {
        float *au = accelerationU.row(j) + first, *av = accelerationV.row(j) + first;
        if (fromNothing) {
          std::fill_n(au, faces, 0.0f);
          std::fill_n(av, faces, 0.0f);
        }
        if (j < ny) {
          find(j + 1);
          const float *fx = lines[j & 1][0], *fxAbove = lines[(j + 1) & 1][0];
          const float* openX = boundary.openX.row(j) + first;
#pragma omp simd
          for (int i = 0; i < faces; ++i) au[i] += openX[i] > 0 ? 0.5f * (fx[i] + fxAbove[i]) : 0.0f;
        }
        const float *fy = lines[j & 1][1], *openY = boundary.openY.row(j) + first;
#pragma omp simd
        for (int i = 0; i < across; ++i) av[i] += openY[i] > 0 ? 0.5f * (fy[i] + fy[i + 1]) : 0.0f;
      }
    }
  });
}

std::size_t Confinement::bytes() const { return omega_.bytes(); }

}  // namespace smokebox
