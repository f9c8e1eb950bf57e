#include "fluid/pressure_flux.h"

#include <algorithm>
#include <cmath>

#include "fluid/multigrid_kernels.h"

// Vectors wider than the machine's stay inside inlined functions. The warning comes at the end of the file.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace smokebox {

using multigrid::kEmpty;
using multigrid::kLeftSide;
using multigrid::kRegular;
using multigrid::kRightSide;
using multigrid::Level;

namespace {

/// The larger one; a NaN stays.
double largerOf(double a, double b) { return a > b || std::isnan(a) ? a : b; }

// A quarter of a chunk, in float64.
constexpr int kQuarter = 4;
typedef float QuarterChunk __attribute__((vector_size(4 * kQuarter), aligned(4), may_alias));
typedef double Doubles __attribute__((vector_size(8 * kQuarter)));

SMOKEBOX_INLINE Doubles doublesAt(const float* p) {
  return __builtin_convertvector(*reinterpret_cast<const QuarterChunk*>(p), Doubles);
}

/// Through faces that may be open in part.
SMOKEBOX_INLINE Doubles sideFlux(const float* open, const float* velocity, const float* wall) {
  const Doubles share = doublesAt(open);
  return share * doublesAt(velocity) + (1.0 - share) * doublesAt(wall);
}

/// The cells whose faces are all either open or closed.
SMOKEBOX_INLINE LaneMask wholeFaces(const float* ax, const float* ay, const float* ayAbove) {
  const auto whole = [](const Lanes& open) __attribute__((always_inline)) {
    return (open == 0.0f) | (open == 1.0f);
  };
  return (whole(load(ax)) & whole(load(ax + 1))) & (whole(load(ay)) & whole(load(ayAbove)));
}

}  // namespace

PressureFlux::PressureFlux(const Boundary& boundary, ThreadPool& pool)
    : pool_(pool), rows_(boundary.grid.ny) {}

void PressureFlux::closeFaces(const Boundary& boundary, const multigrid::Level& links, Field& u, Field& v) {
  const int nx = links.nx, ny = links.ny;
  const auto close =
      [](float* velocity, const float* open, const float* wall, int inside) __attribute__((always_inline)) {
    const Lanes old = load(velocity);
    store(velocity, select((load(open) > 0.0f) | (laneNumbers() >= inside), old, load(wall)));
  };
  forRows(pool_, boundary.grid.cells(), 0, ny, [&](int j) {
    const float *open = links.row(links.ax, j), *openBelow = links.row(links.ay, j);
    const float *wall = boundary.wallU.row(j), *wallBelow = boundary.wallV.row(j);
    float *velocity = u.row(j), *below = v.row(j);
    const std::uint8_t* kind = links.chunkRow(j);
    for (int c = 0; c < links.chunks; ++c) {
      if (kind[c] & (kRegular | kRightSide)) continue;
      if (kind[c] & kLeftSide) {
        if (!(links.sideCells[2 * j].link > 0)) velocity[0] = wall[0];
        continue;
      }
      const int first = c * kLanes;
      close(velocity + first, open + first, wall + first, nx - first);
      close(below + first, openBelow + first, wallBelow + first, nx - first);
    }
    if (links.periodicX)
      velocity[nx] = velocity[0];
    else if (!(links.sideCells[2 * j + 1].link > 0))
      velocity[nx] = wall[nx];
  });
  if (links.periodicY) {
    std::copy_n(v.row(0), nx, v.row(ny));
    return;
  }
  for (int c = 0; c < links.chunks; ++c) {
    const int first = c * kLanes;
    close(v.row(ny) + first, links.row(links.ay, ny) + first, boundary.wallV.row(ny) + first, nx - first);
  }
}

PressureFlux::Largest PressureFlux::measure(const Boundary& boundary, const multigrid::Level& links,
                                            const Field& u, const Field& v, multigrid::Floats& b) {
  forRows(pool_, boundary.grid.cells(), 0, links.ny, [&](int j) { measureRow(boundary, links, u, v, b, j); });
  return largest();
}

PressureFlux::Largest PressureFlux::largest() const {
  Largest largest;
  for (const Largest& row : rows_) {
    if (std::isnan(row.flux) || std::isnan(row.speed)) return {row.flux + row.speed, row.flux + row.speed};
    largest.flux = std::max(largest.flux, row.flux);
    largest.speed = std::max(largest.speed, row.speed);
  }
  return largest;
}

void PressureFlux::measureRow(const Boundary& boundary, const multigrid::Level& links, const Field& u,
                              const Field& v, multigrid::Floats& b, int j) {
  const int nx = links.nx, ny = links.ny;
  const float *ax = links.row(links.ax, j), *ay = links.row(links.ay, j), *ayAbove = ay + links.stride;
  const float* id = links.row(links.id, j);
  const float *ur = u.row(j), *vr = v.row(j), *va = v.row(j + 1);
  const float* wallU = boundary.wallU.row(j);
  const float* wallV = boundary.wallV.row(j);
  const float* wallVAbove = boundary.wallV.row(links.periodicY && j == ny - 1 ? 0 : j + 1);
  const std::uint8_t* kind = links.chunkRow(j);
  const Level::SideCell* side = links.sideCells.data() + 2 * j;
  float* out = links.row(b, j);
  const Lanes zero = {};
  Lanes flux = {}, speed = {};
  const auto found = [&](int first, const Lanes& net, const Lanes& left, const Lanes& below)
      __attribute__((always_inline)) {
    store(out + first, net);
    flux = multigrid::larger(magnitude(net), flux);
    speed = multigrid::larger(magnitude(left), speed);
    speed = multigrid::larger(magnitude(below), speed);
  };
  for (int c = 0, chunks = links.chunks; c < chunks; ++c) {
    const int first = c * kLanes;
    if (kind[c] & kEmpty) continue;
    Lanes left = load(ur + first), below = load(vr + first);
    // Neighbouring velocities are close: their differences are as good as exact in float32. Closed faces hold
    // the wall's.
    Lanes net = (left - load(ur + first + 1)) + (below - load(va + first));
    if (kind[c] & kRegular) {
      found(first, net, left, below);
      continue;
    }
    if (kind[c] & (kLeftSide | kRightSide) && side[kind[c] & kLeftSide ? 0 : 1].link == 0) {
      if (kind[c] & kLeftSide) left = select(laneNumbers() == 0, zero, left);
      found(first, net, left, below);
      continue;
    }
    const LaneMask whole = wholeFaces(ax + first, ay + first, ayAbove + first);
    if (!multigrid::allLanes(whole)) {
      // The row may end within these 16 cells: what lies beyond has no links, and counts as 0.
      alignas(64) float sums[kLanes], right[kLanes];
      for (int k = 0; k < kLanes; ++k) right[k] = wallU[first + k + 1];
      if (links.periodicX && first + kLanes >= nx) right[nx - 1 - first] = wallU[0];
      for (int k = 0; k < kLanes; k += kQuarter) {
        const int i = first + k;
        const Doubles sum =
            (sideFlux(ax + i, ur + i, wallU + i) - sideFlux(ax + i + 1, ur + i + 1, right + k)) +
            (sideFlux(ay + i, vr + i, wallV + i) - sideFlux(ayAbove + i, va + i, wallVAbove + i));
        *reinterpret_cast<QuarterChunk*>(sums + k) = __builtin_convertvector(sum, QuarterChunk);
      }
      // Cell by cell only where the chunks of mirror images are no mirror images.
      const Lanes exact = load(sums);
      net = nx % kLanes == 0 ? exact : select(whole, net, exact);
    }
    found(first, select(load(id + first) > zero, net, zero), select(load(ax + first) > zero, left, zero),
          select(load(ay + first) > zero, below, zero));
  }
  double sideSpeed = 0;
  if (side[1].link > 0) sideSpeed = largerOf(std::fabs(static_cast<double>(ur[nx])), sideSpeed);
  if (j == ny - 1)
    for (int i = 0; i < nx; ++i)
      if (ayAbove[i] > 0) sideSpeed = largerOf(std::fabs(static_cast<double>(va[i])), sideSpeed);
  rows_[j] = {multigrid::largestLane(flux), largerOf(multigrid::largestLane(speed), sideSpeed)};
}

void PressureFlux::subtractFromRow(const multigrid::Level& links, const multigrid::Floats& phi, Field& u,
                                   Field& v, int j) {
  const int nx = links.nx, ny = links.ny;
  const auto subtract = [](float* velocity, const float* open, const float* here, std::ptrdiff_t back,
                           const LaneMask& inside) __attribute__((always_inline)) {
    const Lanes old = load(velocity), zero = {};
    store(velocity, select((load(open) > zero) & inside, old - (load(here) - load(here - back)), old));
  };
  const float* open = links.row(links.ax, j);
  const float* openBelow = links.row(links.ay, j);
  const float* here = links.row(phi, j);
  float *ur = u.row(j), *vr = v.row(j);
  const std::uint8_t* kind = links.chunkRow(j);
  const Level::SideCell* side = links.sideCells.data() + 2 * j;
  const std::ptrdiff_t stride = links.stride;
  for (int c = 0, chunks = links.chunks; c < chunks; ++c) {
    const int first = c * kLanes;
    if (kind[c] & kEmpty) continue;
    if (kind[c] & (kRegular | kLeftSide | kRightSide)) {
      const Lanes value = load(here + first), old = load(ur + first);
      const Lanes along = old - (value - load(here + first - 1));
      const bool closed = kind[c] & kLeftSide && !(side[0].link > 0);
      store(ur + first, closed ? select(laneNumbers() == 0, old, along) : along);
      store(vr + first, load(vr + first) - (value - load(here + first - stride)));
      continue;
    }
    const LaneMask inside = laneNumbers() < nx - first;
    subtract(ur + first, open + first, here + first, 1, inside);
    subtract(vr + first, openBelow + first, here + first, stride, inside);
  }
  if (links.periodicX)
    ur[nx] = ur[0];
  else if (side[1].link > 0)
    ur[nx] -= here[nx] - here[nx - 1];
  if (links.periodicY) {
    if (j == 0) std::copy_n(vr, nx, v.row(ny));
  } else if (j == ny - 1) {
    float* top = v.row(ny);
    const float *openTop = links.row(links.ay, ny), *beyond = links.row(phi, ny);
    for (int i = 0; i < nx; ++i) top[i] = openTop[i] > 0 ? top[i] - (beyond[i] - here[i]) : top[i];
  }
}

}  // namespace smokebox
