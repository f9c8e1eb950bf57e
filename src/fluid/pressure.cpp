#include "fluid/pressure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fluid/multigrid.h"
#include "fluid/multigrid_apply.h"
#include "fluid/multigrid_kernels.h"
#include "fluid/pressure_flux.h"
#include "fluid/regions.h"

namespace smokebox {

using multigrid::Floats;
using multigrid::Level;

namespace {

// The solve aims this much below the tolerance, since the velocity is rounded after it.
constexpr double kSafety = 0.7;
// In float32 the running residual parts from the true one by about this share of the solution's largest
// value.
constexpr double kRounding = 2.5e-7;

double largerOf(double a, double b) { return a > b || std::isnan(a) ? a : b; }

}  // namespace

struct PressureSolver::Impl {
  Impl(const Boundary& boundary, ThreadPool& threads)
      : pool(threads), multigrid(boundary, threads), flux(boundary, threads) {
    solution = direction = increment = multigrid.finest().x;
    advances.resize(boundary.grid.ny);
    overlaps.resize(boundary.grid.ny);
    regions.rebuild(boundary, multigrid.finest());
  }

  void rebuild(const Boundary& boundary) {
    multigrid.rebuild(boundary);
    regions.rebuild(boundary, multigrid.finest());
    const std::size_t size = static_cast<std::size_t>(multigrid.finest().extrasBegin);
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

  /// Conjugate gradients for the right-hand side in b, until the largest residual is at most `target` (0: all
  /// of them, and b is not followed to the last); the solution is left in `solution` once its rows are
  /// finished. Both products of a step are found at once (Chronopoulos and Gear 1989). Returns the number of
  /// iterations. `onward`: b is what the last solve has left, computed anew; goes on in conjugate directions
  /// instead of starting over, which would cost an iteration or two (residual replacement, van der Vorst and
  /// Ye 2000).
  int solve(double target, int maxIterations, bool onward = false);
  /// Products of the last direction with A correction and with the residual.
  struct Overlap {
    double withCorrection = 0, withResidual = 0;
  };
  /// Products of the last direction with A correction and with the residual.
  Overlap overlapOfDirection();
  /// One step of alpha along the next direction, correction + beta (the last one): b -= alpha A direction.
  /// The solution follows every other step, by two directions at once.
  struct Advance {
    double residual = 0, solution = 0;  // largest |b|, and largest |solution| if it is the first step
  };
  Advance advance(float alpha, float beta, bool first);
  /// Brings what is due into row j of the solution.
  void finishRow(int j);
  /// Whether rows of the solution may be finished just before they are used.
  bool finishesByRow() const {
    return pool.threads() == 1 && !multigrid.finest().periodicY && !regions.anySealed();
  }
  /// Else all at once.
  void finish();
  /// Takes the mean off values in sealed regions, and copies them beyond the sides.
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
  // What the solution still has to get: these multiples of the last direction and of the correction.
  struct Due {
    bool any = false, toNothing = false;  // toNothing: the solution holds nothing yet
    float ofDirection = 0, ofCorrection = 0;
  };
  Due due;
  bool far = false;  // the solve started far from its target
  // What the last projection of a step has found in all: the start of the next one, unless the links change.
  Floats increment;
  bool predictable = false;
  bool incrementEmpty = false;  // whatever it holds
  std::vector<double> sums;
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

PressureSolver::Impl::Advance PressureSolver::Impl::advance(float alpha, float beta, bool first) {
  Level& level = multigrid.finest();
  const int ny = level.ny, width = level.chunks * kLanes;
  const bool alone = beta == 0 && !due.any, large = level.large();
  if (alone) direction.swap(level.x);
  const Due before = due;
  due = before.any ? Due{} : Due{true, first, alpha, 0};
  const auto combine = [&](int j) {
    float *p = level.row(direction, j), *x = level.row(solution, j);
    const float* z = level.row(level.x, j);
    for (int i = 0; i < width; i += kLanes) {
      if (large) expect(p + i + level.stride), expect(z + i + level.stride);
      if (large && before.any) expect(x + i + level.stride);
      const Lanes last = load(p + i), next = load(z + i) + beta * last;
      store(p + i, next);
      if (!before.any) continue;
      const Lanes step = before.ofDirection * last + alpha * next;
      store(x + i, before.toNothing ? step : load(x + i) + step);
    }
    level.wrapRow(p);
  };
  const auto apply = [&](int j) {
    float* r = level.b.data();
    const float* p = direction.data();
    Lanes residual = {}, size = {};
    multigrid::applyRow(
        level, direction, j, [&](std::ptrdiff_t i, const Lanes& sum) __attribute__((always_inline)) {
          if (large) expect(r + i + level.stride);
          const Lanes value = load(r + i) - alpha * sum;
          store(r + i, value);
          residual = multigrid::larger(magnitude(value), residual);
          if (first) size = multigrid::larger(magnitude(alpha * load(p + i)), size);
        });
    advances[j] = {multigrid::largestLane(residual), multigrid::largestLane(size)};
  };
  if (alone) {
    forRows(pool, static_cast<long>(level.nx) * ny, 0, ny, apply);
  } else if (pool.threads() == 1 && !level.periodicY) {
    for (int j = 0; j <= ny; ++j) {
      if (j < ny) combine(j);
      if (j > 0) apply(j - 1);
    }
  } else {
    forRows(pool, static_cast<long>(level.nx) * ny, 0, ny, combine);
    level.wrapRows(direction);
    forRows(pool, static_cast<long>(level.nx) * ny, 0, ny, apply);
  }
  Advance most;
  for (const Advance& row : advances) {
    most.residual = largerOf(row.residual, most.residual);
    most.solution = largerOf(row.solution, most.solution);
  }
  return most;
}

void PressureSolver::Impl::finishRow(int j) {
  Level& level = multigrid.finest();
  float* x = level.row(solution, j);
  const float *p = level.row(direction, j), *z = level.row(level.x, j);
  for (int i = 0; due.any && i < level.chunks * kLanes; i += kLanes) {
    Lanes step = due.ofDirection * load(p + i);
    if (due.ofCorrection != 0) step += due.ofCorrection * load(z + i);
    store(x + i, due.toNothing ? step : load(x + i) + step);
  }
  level.wrapRow(x);
}

void PressureSolver::Impl::finish() {
  Level& level = multigrid.finest();
  forRows(pool, static_cast<long>(level.nx) * level.ny, 0, level.ny, [&](int j) { finishRow(j); });
  due = {};
  centre(solution);
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
    if (incrementEmpty) {
      std::copy_n(x, level.nx + 2, sum);
      return;
    }
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
    const float *x = level.x.data(), *b = level.b.data(), *p = direction.data();
    multigrid::applyRow(
        level, direction, j, [&](std::ptrdiff_t i, const Lanes& sum) __attribute__((always_inline)) {
          link += sum * load(x + i);
          slope += load(b + i) * load(p + i);
        });
    overlaps[j] = {multigrid::sumOfLanes(link), multigrid::sumOfLanes(slope)};
  });
  Overlap total;
  for (const Overlap& row : overlaps) {
    total.withCorrection += row.withCorrection;
    total.withResidual += row.withResidual;
  }
  return total;
}

int PressureSolver::Impl::solve(double target, int maxIterations, bool onward) {
  double product = 0, alpha = 0, enough = target;
  due = {};
  int iteration = 0;
  while (iteration < maxIterations) {
    const Multigrid::Products found = multigrid.cycle();
    const double next = found.withResidual;
    if (!(next > 0)) break;  // nothing left to correct, or not a number
    // The product of the correction with A (last direction): the last step took alpha times that off b, and
    // what b was before has no product with the correction.
    double beta = 0, slope = next, overlap = 0;
    if (iteration > 0) {
      beta = next / product;
      overlap = -next / alpha;
    } else if (onward && curvature > 0) {
      const Overlap measured = overlapOfDirection();
      overlap = measured.withCorrection;
      beta = -overlap / curvature;
      slope += beta * measured.withResidual;
    }
    const double bent = found.curvature + beta * (2 * overlap + beta * curvature);
    if (!(bent > 0)) break;
    curvature = bent;
    product = next;
    alpha = slope / curvature;
    ++iteration;
    const auto step = static_cast<float>(alpha), share = static_cast<float>(beta);
    if (target == 0 && iteration == maxIterations) {
      due = {true, due.toNothing || iteration == 1, (due.any ? due.ofDirection : 0.0f) + step * share, step};
      break;
    }
    const Advance done = advance(step, share, iteration == 1);
    // Where rounding would reach the target, the residual is computed anew before.
    if (iteration == 1 && kRounding * done.solution > 0.3 * target)
      enough = std::max(target, 4 * kRounding * done.solution);
    if (!(done.residual > enough)) break;
  }
  if (iteration == 0) std::fill(solution.begin(), solution.end(), 0.0f);
  if (!finishesByRow()) finish();
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
    measured = s.flux.subtractAndMeasure(
        boundary, level, s.increment, u, v, level.b, [](int) {}, [](int) {});
  } else {
    measured = s.flux.measure(boundary, level, u, v, level.b);
  }
  s.incrementEmpty = !s.predictable;
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
    const int done =
        s.solve(kSafety * tolerance * speed, maxIterations - result.iterations, result.iterations > 0);
    if (done == 0) break;
    result.iterations += done;
    measured = s.flux.subtractAndMeasure(
        boundary, level, s.solution, u, v, level.b, [&](int j) { s.finishRow(j); },
        [&](int j) { s.rememberRow(j); });
    s.incrementEmpty = false;
  }
  if (s.incrementEmpty) std::fill(s.increment.begin(), s.increment.end(), 0.0f);
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
    s.solve(0, cycles);
  } else {
    s.multigrid.cycle(false);
    s.due = {};
    s.centre(increment);
  }
  s.flux.subtractGradient(
      level, increment, u, v, [&](int j) { s.finishRow(j); },
      [&](int j) {
        if (phi) s.addToRow(increment, *phi, static_cast<float>(gain), j);
      });
}

std::size_t PressureSolver::bytes() const {
  const Impl& s = *impl_;
  return s.multigrid.bytes() + s.regions.bytes() + 3 * s.solution.capacity() * sizeof(float) +
         2 * (s.advances.capacity() + s.overlaps.capacity()) * sizeof(double);
}

}  // namespace smokebox
