#include "fluid/pressure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fluid/multigrid.h"
#include "fluid/multigrid_kernels.h"
#include "fluid/pressure_flux.h"
#include "fluid/regions.h"

namespace smokebox {

using multigrid::Floats;
using multigrid::kEmpty;
using multigrid::kLanes;
using multigrid::kRegular;
using multigrid::Lanes;
using multigrid::Level;
using multigrid::load;
using multigrid::store;

namespace {

// The solve aims this much below the tolerance, since the velocity is rounded after it.
constexpr double kSafety = 0.7;
// In float32 the running residual parts from the true one by about this share of the solution's largest
// value.
constexpr double kRounding = 2.5e-7;
// From a start this far above the target a W-cycle saves iterations. A step of a flow starts nearer: there it
// saves none.
constexpr double kFar = 3e4;

double largerOf(double a, double b) { return a > b || std::isnan(a) ? a : b; }

}  // namespace

struct PressureSolver::Impl {
  Impl(const Boundary& boundary, ThreadPool& threads)
      : pool(threads), multigrid(boundary, threads), flux(boundary, threads) {
    solution = direction = increment = multigrid.finest().x;
    rows.resize(boundary.grid.ny);
    advances.resize(boundary.grid.ny);
    overlaps.resize(boundary.grid.ny);
    regions.rebuild(boundary, multigrid.finest());
  }

  void rebuild(const Boundary& boundary) {
    multigrid.rebuild(boundary);
    regions.rebuild(boundary, multigrid.finest());
    const std::size_t size = static_cast<std::size_t>(multigrid.finest().extrasBegin);
    rows.resize(boundary.grid.ny);
    advances.resize(boundary.grid.ny);
    overlaps.resize(boundary.grid.ny);
    for (Floats* f : {&solution, &direction, &increment}) f->assign(size, 0);
    predictable = false;
  }

  /// The net flux that was measured into b, spread over sealed regions where it does not cancel. m/s.
  struct Source {
    double flux = 0, speed = 0, compression = 0;
  };
  Source source(const Boundary& boundary, const PressureFlux::Largest& measured);

  /// Conjugate gradients for the right-hand side in b, until the largest residual is at most `target`; the
  /// solution is left in `solution`. Returns the number of iterations. `onward`: b is what the last solve has
  /// left, computed anew; goes on in conjugate directions instead of starting over, which would cost an
  /// iteration or two (residual replacement, van der Vorst and Ye 2000).
  int solve(double start, double target, int maxIterations, bool onward = false);
  /// Products of the last direction with A correction and with the residual.
  struct Overlap {
    double withCorrection = 0, withResidual = 0;
  };
  Overlap overlapOfDirection();
  /// direction = x + beta direction; returns its product with A direction.
  double advanceDirection(float beta);
  /// solution += alpha direction (from 0 if it is the first), b -= alpha A direction (computed again: cheaper
  /// than to keep it). b is left alone if this is the last step.
  struct Advance {
    double residual = 0, solution = 0;  // largest |b|, and largest |solution| if it is the first
  };
  Advance advanceSolution(float alpha, bool first, bool last);
  /// Takes the mean off a solution in sealed regions, and copies it beyond the sides.
  void centre(Floats& values);
  /// phi += gain x, in row j.
  void addToRow(const Floats& x, Field& phi, float gain, int j) const;
  /// increment += solution in row j, copies beyond the sides too.
  void rememberRow(int j);

  ThreadPool& pool;
  Multigrid multigrid;
  Regions regions;
  PressureFlux flux;
  Floats solution, direction;  // on the finest level's grid
  double curvature = 0;        // product of the last direction with A direction
  bool far = false;            // the solve started far from its target
  // What the last projection of a step has found in all: the start of the next one, unless the links change.
  Floats increment;
  bool predictable = false;
  std::vector<double> rows, sums;
  std::vector<Advance> advances;
  std::vector<Overlap> overlaps;
};

PressureSolver::Impl::Source PressureSolver::Impl::source(const Boundary& boundary,
                                                          const PressureFlux::Largest& measured) {
  Level& level = multigrid.finest();
  Source result{measured.flux, measured.speed, 0};
  if (!regions.anySealed() || !std::isfinite(measured.flux)) return result;

  const auto& all = regions.regions();
  sums.assign(all.size(), 0);
  for (const Regions::Run& run : regions.runs())
    if (all[run.region].sealed) sums[run.region] += sumOfRow(level.row(level.b, run.j), run.begin, run.end);
  for (std::size_t r = 0; r < all.size(); ++r) {
    if (!all[r].sealed) continue;
    sums[r] /= all[r].volume;
    result.compression = std::max(result.compression, std::fabs(sums[r]));
  }
  // What is left after each cell has taken its share.
  result.flux = 0;
  for (const Regions::Run& run : regions.runs()) {
    float* b = level.row(level.b, run.j);
    const float* volume = boundary.volume.row(run.j);
    const Regions::Region& region = all[run.region];
    const float share = region.sealed ? static_cast<float>(sums[run.region]) : 0.0f;
    float m = 0;
    if (region.unweighted || !region.sealed) {
#pragma omp simd reduction(max : m)
      for (int i = run.begin; i < run.end; ++i) {
        b[i] -= share;
        m = std::max(m, std::fabs(b[i]));
      }
    } else {
#pragma omp simd reduction(max : m)
      for (int i = run.begin; i < run.end; ++i) {
        b[i] -= share * volume[i];
        m = std::max(m, std::fabs(b[i]));
      }
    }
    result.flux = std::max(result.flux, static_cast<double>(m));
  }
  return result;
}

double PressureSolver::Impl::advanceDirection(float beta) {
  Level& level = multigrid.finest();
  const int ny = level.ny;
  const int width = level.chunks * kLanes;
  const auto combine = [&](int j) {
    float* p = level.row(direction, j);
    const float* z = level.row(level.x, j);
    for (int i = 0; i < width; i += kLanes) store(p + i, load(z + i) + beta * load(p + i));
    level.wrapRow(p);
  };
  const auto apply = [&](int j) {
    Lanes sum = {};
    const std::uint8_t* kind = level.chunkRow(j);
    for (int c = 0; c < level.chunks; ++c) {
      if (kind[c] & kEmpty) continue;
      const std::ptrdiff_t offset = level.at(c * kLanes, j);
      const Lanes value = applyChunk(level, kind[c], direction.data(), offset);
      sum += value * load(direction.data() + offset);
    }
    rows[j] = multigrid::sumOfLanes(sum);
  };
  if (pool.threads() == 1 && !level.periodicY) {
    for (int j = 0; j <= ny; ++j) {
      if (j < ny) combine(j);
      if (j > 0) apply(j - 1);
    }
  } else {
    forRows(pool, static_cast<long>(level.nx) * ny, 0, ny, combine);
    level.wrapRows(direction);
    forRows(pool, static_cast<long>(level.nx) * ny, 0, ny, apply);
  }
  double total = 0;
  for (double r : rows) total += r;
  return total;
}

PressureSolver::Impl::Advance PressureSolver::Impl::advanceSolution(float alpha, bool first, bool last) {
  Level& level = multigrid.finest();
  forRows(pool, static_cast<long>(level.nx) * level.ny, 0, level.ny, [&](int j) {
    float *x = solution.data(), *r = level.b.data();
    const float* p = direction.data();
    const std::uint8_t* kind = level.chunkRow(j);
    Lanes residual = {}, size = {};
    for (int c = 0; c < level.chunks; ++c) {
      if (kind[c] & kEmpty) continue;
      const std::ptrdiff_t i = level.at(c * kLanes, j);
      const Lanes step = alpha * load(p + i);
      if (first) {
        store(x + i, step);
        size = multigrid::larger(multigrid::magnitude(step), size);
      } else {
        store(x + i, load(x + i) + step);
      }
      if (last) continue;
      const Lanes value = load(r + i) - alpha * applyChunk(level, kind[c], p, i);
      store(r + i, value);
      residual = multigrid::larger(multigrid::magnitude(value), residual);
    }
    advances[j] = {multigrid::largestLane(residual), multigrid::largestLane(size)};
  });
  Advance most;
  for (const Advance& row : advances) {
    most.residual = largerOf(row.residual, most.residual);
    most.solution = largerOf(row.solution, most.solution);
  }
  return most;
}

void PressureSolver::Impl::centre(Floats& values) {
  Level& level = multigrid.finest();
  if (regions.anySealed()) {
    const auto& all = regions.regions();
    sums.assign(all.size(), 0);
    for (const Regions::Run& run : regions.runs())
      if (all[run.region].sealed) sums[run.region] += sumOfRow(level.row(values, run.j), run.begin, run.end);
    for (std::size_t r = 0; r < all.size(); ++r) sums[r] /= static_cast<double>(all[r].cells);
    for (const Regions::Run& run : regions.runs()) {
      if (!all[run.region].sealed) continue;
      float* x = level.row(values, run.j);
      const float mean = static_cast<float>(sums[run.region]);
      for (int i = run.begin; i < run.end; ++i) x[i] -= mean;
    }
  }
  for (int j = 0; j < level.ny; ++j) level.wrapRow(level.row(values, j));
  level.wrapRows(values);
}

void PressureSolver::Impl::rememberRow(int j) {
  const Level& level = multigrid.finest();
  const auto add = [&](int row) {
    float* sum = level.row(increment, row) - 1;
    const float* x = level.row(solution, row) - 1;
#pragma omp simd
    for (int i = 0; i < level.nx + 2; ++i) sum[i] += x[i];
  };
  add(j);
  if (level.periodicY && j == 0) add(-1);
  if (level.periodicY && j == level.ny - 1) add(level.ny);
}

void PressureSolver::Impl::addToRow(const Floats& values, Field& phi, float gain, int j) const {
  const Level& level = multigrid.finest();
  float* target = phi.row(j);
  const float* x = level.row(values, j);
#pragma omp simd
  for (int i = 0; i < level.nx; ++i) target[i] += gain * x[i];
}

PressureSolver::Impl::Overlap PressureSolver::Impl::overlapOfDirection() {
  Level& level = multigrid.finest();
  forRows(pool, static_cast<long>(level.nx) * level.ny, 0, level.ny, [&](int j) {
    Lanes link = {}, slope = {};
    const std::uint8_t* kind = level.chunkRow(j);
    for (int c = 0; c < level.chunks; ++c) {
      if (kind[c] & kEmpty) continue;
      const std::ptrdiff_t offset = level.at(c * kLanes, j);
      link += applyChunk(level, kind[c], direction.data(), offset) * load(level.x.data() + offset);
      slope += load(level.b.data() + offset) * load(direction.data() + offset);
    }
    overlaps[j] = {multigrid::sumOfLanes(link), multigrid::sumOfLanes(slope)};
  });
  Overlap total;
  for (const Overlap& row : overlaps) {
    total.withCorrection += row.withCorrection;
    total.withResidual += row.withResidual;
  }
  return total;
}

int PressureSolver::Impl::solve(double start, double target, int maxIterations, bool onward) {
  double product = 0, enough = target;
  if (!onward) far = start > kFar * target && target > 0;
  int iteration = 0;
  while (iteration < maxIterations) {
    const double next = multigrid.cycle(far);
    if (!(next > 0)) break;  // nothing left to correct, or not a number
    double beta = iteration == 0 ? 0 : next / product, slope = next;
    if (iteration == 0 && onward && curvature > 0) {
      const Overlap overlap = overlapOfDirection();
      beta = -overlap.withCorrection / curvature;
      slope += beta * overlap.withResidual;
    }
    curvature = advanceDirection(static_cast<float>(beta));
    if (!(curvature > 0)) break;
    product = next;
    ++iteration;
    const Advance done = advanceSolution(static_cast<float>(slope / curvature), iteration == 1,
                                         target == 0 && iteration == maxIterations);
    // Where rounding would reach the target, the residual is computed anew before.
    if (iteration == 1 && kRounding * done.solution > 0.3 * target)
      enough = std::max(target, 4 * kRounding * done.solution);
    if (!(done.residual > enough)) break;
  }
  if (iteration == 0) std::fill(solution.begin(), solution.end(), 0.0f);
  centre(solution);
  return iteration;
}

PressureSolver::PressureSolver(const Boundary& boundary, ThreadPool& pool)
    : impl_(std::make_unique<Impl>(boundary, pool)) {}

PressureSolver::~PressureSolver() = default;

void PressureSolver::rebuild(const Boundary& boundary) { impl_->rebuild(boundary); }

PressureSolver::Result PressureSolver::project(const Boundary& boundary, Field& u, Field& v, Field& phi,
                                               double smallestSpeed, double tolerance, int maxIterations) {
  Impl& s = *impl_;
  Level& level = s.multigrid.finest();
  s.flux.closeFaces(boundary, level, u, v);
  PressureFlux::Largest measured;
  if (s.predictable) {
    measured = s.flux.subtractAndMeasure(boundary, level, s.increment, u, v, level.b, [](int) {});
  } else {
    std::fill(s.increment.begin(), s.increment.end(), 0.0f);
    measured = s.flux.measure(boundary, level, u, v, level.b);
  }
  s.predictable = true;
  Result result;
  double before = std::numeric_limits<double>::infinity();
  while (true) {
    const Impl::Source source = s.source(boundary, measured);
    const double speed = largerOf(source.speed, smallestSpeed);
    result.divergence = source.flux > 0 ? source.flux / speed : source.flux;
    result.compression = source.compression / boundary.grid.h;
    if (!std::isfinite(result.divergence) || !std::isfinite(result.compression)) {
      result.divergence = std::numeric_limits<double>::quiet_NaN();
      break;
    }
    result.converged = result.divergence <= tolerance;
    // Below the rounding of the velocities nothing more is to be gained.
    const bool stalled = source.flux > 0.5 * before;
    if (result.converged || stalled || result.iterations >= maxIterations) break;
    before = source.flux;
    const int done = s.solve(source.flux, kSafety * tolerance * speed, maxIterations - result.iterations,
                             result.iterations > 0);
    if (done == 0) break;
    result.iterations += done;
    measured = s.flux.subtractAndMeasure(boundary, level, s.solution, u, v, level.b,
                                         [&](int j) { s.rememberRow(j); });
  }
  forRows(s.pool, boundary.grid.cells(), 0, level.ny, [&](int j) { s.addToRow(s.increment, phi, 1, j); });
  return result;
}

void PressureSolver::forget() { impl_->predictable = false; }

void PressureSolver::projectRoughly(const Boundary& boundary, Field& u, Field& v, int cycles, Field* phi,
                                    double gain) {
  Impl& s = *impl_;
  Level& level = s.multigrid.finest();
  s.flux.closeFaces(boundary, level, u, v);
  const Impl::Source source = s.source(boundary, s.flux.measure(boundary, level, u, v, level.b));
  if (!(source.flux > 0) || !std::isfinite(source.flux)) return;
  Floats& increment = cycles > 0 ? s.solution : s.multigrid.finest().x;
  if (cycles > 0) {
    s.solve(source.flux, 0, cycles);
  } else {
    s.multigrid.cycle();
    s.centre(increment);
  }
  s.flux.subtractGradient(level, increment, u, v, [&](int j) {
    if (phi) s.addToRow(increment, *phi, static_cast<float>(gain), j);
  });
}

std::size_t PressureSolver::bytes() const {
  const Impl& s = *impl_;
  return s.multigrid.bytes() + s.regions.bytes() + 3 * s.solution.capacity() * sizeof(float) +
         2 * (s.rows.capacity() + s.advances.capacity() + s.overlaps.capacity()) * sizeof(double);
}

}  // namespace smokebox
