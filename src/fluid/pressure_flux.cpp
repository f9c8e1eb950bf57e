#include "fluid/pressure_flux.h"

#include <algorithm>
#include <cmath>

#include "fluid/multigrid.h"
#include "fluid/multigrid_kernels.h"

namespace smokebox {

using multigrid::kEmpty;
using multigrid::kLanes;
using multigrid::kRegular;
using multigrid::Lanes;
using multigrid::load;
using multigrid::store;

namespace {

/// The larger one; a NaN stays.
double largerOf(double a, double b) { return a > b || std::isnan(a) ? a : b; }

double sideFlux(float open, float velocity, float wall) {
  return static_cast<double>(open) * static_cast<double>(velocity) +
         (1.0 - static_cast<double>(open)) * static_cast<double>(wall);
}

}  // namespace

PressureFlux::PressureFlux(const Boundary& boundary, ThreadPool& pool)
    : pool_(pool), rows_(boundary.grid.ny) {}

void PressureFlux::closeFaces(const Boundary& boundary, const multigrid::Level& links, Field& u, Field& v) {
  const int nx = links.nx, ny = links.ny;
  const auto closeV = [&](int j, int first, int last) {
    const float* open = links.row(links.ay, j);
    const float* wall = boundary.wallV.row(j);
    float* velocity = v.row(j);
    for (int i = first; i < last; ++i) velocity[i] = open[i] > 0 ? velocity[i] : wall[i];
  };
  forRows(pool_, boundary.grid.cells(), 0, ny, [&](int j) {
    const float* open = links.row(links.ax, j);
    const float* wall = boundary.wallU.row(j);
    float* velocity = u.row(j);
    const std::uint8_t* kind = links.chunkRow(j);
    for (int c = 0; c < links.chunks; ++c) {
      if (kind[c] & kRegular) continue;
      const int first = c * kLanes, last = std::min(first + kLanes, nx);
      for (int i = first; i < last; ++i) velocity[i] = open[i] > 0 ? velocity[i] : wall[i];
      closeV(j, first, last);
    }
    if (links.periodicX)
      velocity[nx] = velocity[0];
    else if (!(open[nx] > 0))
      velocity[nx] = wall[nx];
  });
  if (links.periodicY)
    std::copy_n(v.row(0), nx, v.row(ny));
  else
    closeV(ny, 0, nx);
}

PressureFlux::Largest PressureFlux::measure(const Boundary& boundary, const multigrid::Level& links,
                                            const Field& u, const Field& v, multigrid::Floats& b) {
  const int nx = links.nx, ny = links.ny;
  forRows(pool_, boundary.grid.cells(), 0, ny, [&](int j) {
    const float *ax = links.row(links.ax, j), *ay = links.row(links.ay, j), *ayAbove = ay + links.stride;
    const float* id = links.row(links.id, j);
    const float *ur = u.row(j), *vr = v.row(j), *va = v.row(j + 1);
    const float* wallU = boundary.wallU.row(j);
    const float* wallV = boundary.wallV.row(j);
    const float* wallVAbove = boundary.wallV.row(links.periodicY && j == ny - 1 ? 0 : j + 1);
    const std::uint8_t* kind = links.chunkRow(j);
    float* out = links.row(b, j);
    Lanes flux = {}, speed = {};
    double generalFlux = 0, generalSpeed = 0;
    for (int c = 0; c < links.chunks; ++c) {
      const int first = c * kLanes;
      if (kind[c] & kRegular) {
        // Neighbouring velocities are close: their differences are as good as exact in float32.
        const Lanes left = load(ur + first), below = load(vr + first);
        const Lanes net = (left - load(ur + first + 1)) + (below - load(va + first));
        store(out + first, net);
        flux = multigrid::larger(multigrid::magnitude(net), flux);
        speed = multigrid::larger(multigrid::magnitude(left), speed);
        speed = multigrid::larger(multigrid::magnitude(below), speed);
        continue;
      }
      if (kind[c] & kEmpty) continue;
      double net[kLanes] = {}, fastest[kLanes] = {};
      const int count = std::min(kLanes, nx - first);
      for (int k = 0; k < count; ++k) {
        const int i = first + k;
        const float wallRight = links.periodicX && i + 1 == nx ? wallU[0] : wallU[i + 1];
        const double sum = (sideFlux(ax[i], ur[i], wallU[i]) - sideFlux(ax[i + 1], ur[i + 1], wallRight)) +
                           (sideFlux(ay[i], vr[i], wallV[i]) - sideFlux(ayAbove[i], va[i], wallVAbove[i]));
        net[k] = id[i] > 0 ? sum : 0.0;
        const double su = ax[i] > 0 ? std::fabs(static_cast<double>(ur[i])) : 0.0;
        const double sv = ay[i] > 0 ? std::fabs(static_cast<double>(vr[i])) : 0.0;
        fastest[k] = largerOf(su, sv);
        out[i] = static_cast<float>(net[k]);
      }
      for (int k = 0; k < count; ++k) {
        generalFlux = largerOf(std::fabs(net[k]), generalFlux);
        generalSpeed = largerOf(fastest[k], generalSpeed);
      }
    }
    if (ax[nx] > 0) generalSpeed = largerOf(std::fabs(static_cast<double>(ur[nx])), generalSpeed);
    if (j == ny - 1)
      for (int i = 0; i < nx; ++i)
        if (ayAbove[i] > 0) generalSpeed = largerOf(std::fabs(static_cast<double>(va[i])), generalSpeed);
    rows_[j] = {largerOf(multigrid::largestLane(flux), generalFlux),
                largerOf(multigrid::largestLane(speed), generalSpeed)};
  });
  Largest largest;
  for (const Largest& row : rows_) {
    if (std::isnan(row.flux) || std::isnan(row.speed)) return {row.flux + row.speed, row.flux + row.speed};
    largest.flux = std::max(largest.flux, row.flux);
    largest.speed = std::max(largest.speed, row.speed);
  }
  return largest;
}

void PressureFlux::subtractGradient(const multigrid::Level& links, const multigrid::Floats& phi, Field& u,
                                    Field& v) {
  const int nx = links.nx, ny = links.ny;
  const auto below = [&](int j, int first, int last) {
    const float* open = links.row(links.ay, j);
    const float *here = links.row(phi, j), *there = links.row(phi, j - 1);
    float* velocity = v.row(j);
    for (int i = first; i < last; ++i)
      velocity[i] = open[i] > 0 ? velocity[i] - (here[i] - there[i]) : velocity[i];
  };
  forRows(pool_, static_cast<long>(nx) * ny, 0, ny, [&](int j) {
    const float* open = links.row(links.ax, j);
    const float* here = links.row(phi, j);
    const std::ptrdiff_t down = links.stride;
    float *ur = u.row(j), *vr = v.row(j);
    const std::uint8_t* kind = links.chunkRow(j);
    for (int c = 0; c < links.chunks; ++c) {
      const int first = c * kLanes, last = std::min(first + kLanes, nx);
      if (kind[c] & kEmpty) continue;
      if (kind[c] & kRegular) {
        const Lanes value = load(here + first);
        store(ur + first, load(ur + first) - (value - load(here + first - 1)));
        store(vr + first, load(vr + first) - (value - load(here + first - down)));
        continue;
      }
      for (int i = first; i < last; ++i) ur[i] = open[i] > 0 ? ur[i] - (here[i] - here[i - 1]) : ur[i];
      below(j, first, last);
    }
    if (open[nx] > 0) ur[nx] -= here[nx] - here[nx - 1];
  });
  if (links.periodicX)
    for (int j = 0; j < ny; ++j) u(nx, j) = u(0, j);
  if (links.periodicY)
    std::copy_n(v.row(0), nx, v.row(ny));
  else
    below(ny, 0, nx);
}

}  // namespace smokebox
