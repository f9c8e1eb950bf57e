#include "fluid/viscosity.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace smokebox {

namespace {

constexpr int kRowGrain = 16;
constexpr int kMostIterations = 600;
constexpr double kTolerance = 1e-6;  // of the gradients: largest residual over the largest velocity
// Chebyshev's iteration leaves at most this error, over the largest velocity and over the change of this
// step.
constexpr double kOfVelocity = 1e-5, kOfChange = 1e-4;
constexpr double kRounding = 1e-7;  // of the largest velocity: no use in going on below
constexpr int kFewestIterations = 2;
constexpr double kLargestChebyshev = 4;  // above this nu dt / h^2 conjugate gradients are faster
constexpr int kChunk = 16;               // faces whose links are looked at together
constexpr float kShortestLink = 1e-3f;
constexpr int kLanes = 8;  // sums go over fixed lanes, so that they do not depend on the instruction set

/// One component's matrix: diagonal 1 + c (wallWeight + links to neighbours), c = nu dt / h^2.
struct System {
  bool alongX = true;
  int columns = 0, rows = 0;  // unknowns; a period is counted once
  Field toRight,
      toAbove;  // weight of the link to the next face along x and y: 1 or 0; toRight(-1), toAbove(., -1) wrap
  Field wallWeight;                   // sum of the cut links' weights
  std::vector<float> linkWeight;      // of each of the boundary's links
  std::vector<int> bent;              // cut links with a whole one opposite: see bendAtWalls()
  std::vector<float> bend;            // what each of them adds to the Laplacian, times h^2
  Field unknown;                      // 1 on open faces, 0 elsewhere
  int chunks = 0;                     // in a row
  std::vector<std::uint8_t> regular;  // by row and chunk: all links are 1 and none is cut
};

}  // namespace

struct Viscosity::Impl {
  Impl(const Boundary& boundary, ThreadPool& threads) : pool(threads) {
    const int nx = boundary.grid.nx, ny = boundary.grid.ny;
    for (System* s : {&systemU, &systemV}) {
      s->alongX = s == &systemU;
      for (Field* f : {&s->toRight, &s->toAbove, &s->wallWeight, &s->unknown}) *f = Field(nx, ny);
    }
    for (Field* f : {&diagonal, &residual, &direction, &product}) *f = Field(nx, ny);
    wrapX = boundary.periodicX();
    wrapY = boundary.periodicY();
    rebuild(boundary, systemU);
    rebuild(boundary, systemV);
  }

  void rebuild(const Boundary& boundary, System& s);
  void findRegular(System& s);
  void bendAtWalls(const Boundary& boundary, System& s, const Field& x);
  Result solve(const Boundary& boundary, const System& s, Field& x, double c);
  Result solveByGradients(const Boundary& boundary, const System& s, Field& x, double c);
  Result solveByChebyshev(const System& s, Field& x, double c, double largest);
  /// Adds what the walls give to the right side; returns the largest of their speeds.
  float addWalls(const Boundary& boundary, const System& s, float c, Field& right) const;
  /// The largest known value, no less than `lowest`.
  double largestOf(const System& s, const Field& x, double lowest);

  template <class Row>
  double sum(const System& s, Row&& row) {
    return pool.sum(0, s.rows, kRowGrain, [&](int begin, int end) {
      double total = 0;
      for (int j = begin; j < end; ++j) total += row(j);
      return total;
    });
  }

  /// Repeats a periodic field beyond its period, as far as the five-point stencil reaches.
  void wrap(const System& s, Field& f) const {
    if (wrapX)
      for (int j = 0; j < s.rows; ++j) {
        float* row = f.row(j);
        row[-1] = row[s.columns - 1];
        row[s.columns] = row[0];
      }
    if (wrapY) {
      std::copy_n(f.row(s.rows - 1) - 1, s.columns + 2, f.row(-1) - 1);
      std::copy_n(f.row(0) - 1, s.columns + 2, f.row(s.rows) - 1);
    }
  }

  /// out = A p on row j.
  void applyRow(const System& s, const Field& p, float c, int j, float* __restrict out) const {
    const float *q = p.row(j), *above = p.row(j + 1), *below = p.row(j - 1), *d = diagonal.row(j);
    const float *right = s.toRight.row(j), *up = s.toAbove.row(j), *down = s.toAbove.row(j - 1);
#pragma omp simd
    for (int i = 0; i < s.columns; ++i)
      out[i] = d[i] * q[i] - c * ((right[i - 1] * q[i - 1] + right[i] * q[i + 1]) +
                                  (down[i] * below[i] + up[i] * above[i]));
  }

  ThreadPool& pool;
  bool wrapX = false, wrapY = false;
  System systemU, systemV;
  Field diagonal, residual, direction, product;
};

namespace {

/// Sum of a b d over a row, in double.
template <class Term>
double rowSum(int count, Term&& term) {
  double lanes[kLanes] = {};
  int i = 0;
  for (; i + kLanes <= count; i += kLanes)
    for (int k = 0; k < kLanes; ++k) lanes[k] += term(i + k);
  for (int k = 0; i + k < count; ++k) lanes[k] += term(i + k);
  return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) + ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
}

/// One row of Chebyshev's iteration: out = x + momentum (x - out) + step (b - A x) / diagonal; returns the
/// largest |b - A x| / diagonal. `out` holds the iterate before x.
float chebyshevRow(const System& s, const Field& x, const Field& b, Field& out, float c, float momentum,
                   float step, int j) {
  const float *q = x.row(j), *above = x.row(j + 1), *below = x.row(j - 1), *known = b.row(j);
  float* o = out.row(j);
  const std::uint8_t* regular = s.regular.data() + static_cast<std::size_t>(j) * s.chunks;
  float largest = 0;
  for (int chunk = 0; chunk < s.chunks;) {
    int last = chunk + 1;
    while (last < s.chunks && regular[last] == regular[chunk]) ++last;
    const int begin = chunk * kChunk, end = std::min(last * kChunk, s.columns);
    if (regular[chunk]) {
      const float inverse = 1 / (1 + c * 4);
#pragma omp simd reduction(max : largest)
      for (int i = begin; i < end; ++i) {
        const float r = inverse * (known[i] + c * ((q[i - 1] + q[i + 1]) + (below[i] + above[i]))) - q[i];
        o[i] = (q[i] + momentum * (q[i] - o[i])) + step * r;
        largest = std::max(largest, std::fabs(r));
      }
    } else {
      const float *right = s.toRight.row(j), *up = s.toAbove.row(j), *down = s.toAbove.row(j - 1),
                  *wall = s.wallWeight.row(j);
#pragma omp simd reduction(max : largest)
      for (int i = begin; i < end; ++i) {
        const float inverse = 1 / (1 + c * (((right[i - 1] + right[i]) + (down[i] + up[i])) + wall[i]));
        const float links =
            (right[i - 1] * q[i - 1] + right[i] * q[i + 1]) + (down[i] * below[i] + up[i] * above[i]);
        const float r = inverse * (known[i] + c * links) - q[i];
        o[i] = (q[i] + momentum * (q[i] - o[i])) + step * r;
        largest = std::max(largest, std::fabs(r));
      }
    }
    chunk = last;
  }
  return largest;
}

float linkWeightOf(const CutLink& link) {
  return std::clamp(link.drag, 0.0f, 1.0f) / std::max(link.theta, kShortestLink);
}

/// What a second difference over a whole link and one of theta lacks of the second derivative:
/// 2 / (1 + theta) - 1.
float bendOf(const CutLink& link) {
  return std::clamp(link.drag, 0.0f, 1.0f) * (1 - link.theta) / (1 + link.theta);
}

}  // namespace

void Viscosity::Impl::rebuild(const Boundary& boundary, System& s) {
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  const Field& open = s.alongX ? boundary.openX : boundary.openY;
  s.columns = s.alongX && !wrapX ? nx + 1 : nx;
  s.rows = !s.alongX && !wrapY ? ny + 1 : ny;
  auto isOpen = [&](int i, int j) {
    if (i >= s.columns) {
      if (!wrapX) return false;
      i -= s.columns;
    }
    if (j >= s.rows) {
      if (!wrapY) return false;
      j -= s.rows;
    }
    return open(i, j) > 0;
  };
  pool.blocks(0, s.rows, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j)
      for (int i = 0; i < s.columns; ++i) {
        const bool here = open(i, j) > 0;
        s.unknown(i, j) = here ? 1.0f : 0.0f;
        s.toRight(i, j) = here && isOpen(i + 1, j) ? 1.0f : 0.0f;
        s.toAbove(i, j) = here && isOpen(i, j + 1) ? 1.0f : 0.0f;
        s.wallWeight(i, j) = 0;
      }
  });

  // A link that a surface cuts does not reach its neighbour, even where that is open (a thin wall between
  // them).
  const auto& links = s.alongX ? boundary.linksU : boundary.linksV;
  s.linkWeight.assign(links.size(), 0.0f);
  s.bent.clear();
  for (std::size_t k = 0; k < links.size(); ++k) {
    const CutLink& link = links[k];
    if (link.i >= s.columns || link.j >= s.rows || !(open(link.i, link.j) > 0)) continue;
    s.linkWeight[k] = linkWeightOf(link);
    int i = link.di < 0 ? link.i - 1 : link.i, j = link.dj < 0 ? link.j - 1 : link.j;
    if (i < 0) i += wrapX ? s.columns : 0;
    if (j < 0) j += wrapY ? s.rows : 0;
    (link.di != 0 ? s.toRight : s.toAbove)(i, j) = 0;
  }
  for (std::size_t k = 0; k < links.size(); ++k) {
    const CutLink& link = links[k];
    if (s.linkWeight[k] == 0 || link.theta >= 1) continue;
    int i = link.di > 0 ? link.i - 1 : link.i, j = link.dj > 0 ? link.j - 1 : link.j;
    if (i < 0) i += wrapX ? s.columns : 0;
    if (j < 0) j += wrapY ? s.rows : 0;
    if ((link.di != 0 ? s.toRight : s.toAbove)(i, j) == 0) continue;
    s.bent.push_back(static_cast<int>(k));
    s.linkWeight[k] += bendOf(link) * s.linkWeight[k];
  }
  for (std::size_t k = 0; k < links.size();) {
    const int i = links[k].i, j = links[k].j;
    double sum = 0;  // of any order, see addWalls()
    for (; k < links.size() && links[k].i == i && links[k].j == j; ++k)
      sum += static_cast<double>(s.linkWeight[k]);
    if (sum > 0) s.wallWeight(i, j) = static_cast<float>(sum);
  }
  s.bend.assign(s.bent.size(), 0.0f);
  wrap(s, s.toRight);
  wrap(s, s.toAbove);
  findRegular(s);
}

void Viscosity::Impl::bendAtWalls(const Boundary& boundary, System& s, const Field& x) {
  const auto& links = s.alongX ? boundary.linksU : boundary.linksV;
  for (std::size_t n = 0; n < s.bent.size(); ++n) {
    const CutLink& link = links[s.bent[n]];
    int i = link.i - link.di, j = link.j - link.dj;
    if (wrapX) i = i < 0 ? i + s.columns : i >= s.columns ? i - s.columns : i;
    if (wrapY) j = j < 0 ? j + s.rows : j >= s.rows ? j - s.rows : j;
    s.bend[n] = bendOf(link) * (x(i, j) - x(link.i, link.j));
  }
}

void Viscosity::Impl::findRegular(System& s) {
  s.chunks = (s.columns + kChunk - 1) / kChunk;
  s.regular.resize(static_cast<std::size_t>(s.rows) * s.chunks);
  pool.blocks(0, s.rows, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const float *right = s.toRight.row(j), *up = s.toAbove.row(j), *down = s.toAbove.row(j - 1),
                  *wall = s.wallWeight.row(j);
      for (int chunk = 0; chunk < s.chunks; ++chunk) {
        const int first = chunk * kChunk, last = std::min(first + kChunk, s.columns);
        float least = 1, most = 0;
#pragma omp simd reduction(min : least) reduction(max : most)
        for (int i = first; i < last; ++i) {
          least = std::min(least, std::min(std::min(right[i - 1], right[i]), std::min(down[i], up[i])));
          most = std::max(most, wall[i]);
        }
        s.regular[static_cast<std::size_t>(j) * s.chunks + chunk] = least == 1 && most == 0;
      }
    }
  });
}

float Viscosity::Impl::addWalls(const Boundary& boundary, const System& s, float c, Field& right) const {
  const auto& links = s.alongX ? boundary.linksU : boundary.linksV;
  float largest = 0;
  std::size_t n = 0;
  for (std::size_t k = 0; k < links.size();) {
    const int i = links[k].i, j = links[k].j;
    bool any = false;
    double sum =
        0;  // in float64, where the order of a face's links, which is not the mirror image's, is all one
    for (; k < links.size() && links[k].i == i && links[k].j == j; ++k) {
      if (s.linkWeight[k] == 0) continue;
      any = true;
      sum += static_cast<double>(c * s.linkWeight[k] * links[k].velocity);
      if (n < s.bent.size() && s.bent[n] == static_cast<int>(k)) sum += static_cast<double>(c * s.bend[n++]);
      largest = std::max(largest, std::fabs(links[k].velocity));
    }
    if (any) right(i, j) = static_cast<float>(static_cast<double>(right(i, j)) + sum);
  }
  return largest;
}

double Viscosity::Impl::largestOf(const System& s, const Field& x, double lowest) {
  return pool.max(0, s.rows, kRowGrain, lowest, [&](int begin, int end) {
    float m = 0;
    for (int j = begin; j < end; ++j) {
      const float *q = x.row(j), *known = s.unknown.row(j);
#pragma omp simd reduction(max : m)
      for (int i = 0; i < s.columns; ++i) m = std::max(m, known[i] * std::fabs(q[i]));
    }
    return static_cast<double>(m);
  });
}

Viscosity::Result Viscosity::Impl::solve(const Boundary& boundary, const System& s, Field& x, double c) {
  Result result;
  if (c > kLargestChebyshev) {
    result = solveByGradients(boundary, s, x, c);
  } else {
    pool.blocks(0, s.rows, kRowGrain, [&](int begin, int end) {
      for (int j = begin; j < end; ++j) std::copy_n(x.row(j), s.columns, residual.row(j));
    });
    const float walls = addWalls(boundary, s, static_cast<float>(c), residual);
    result = solveByChebyshev(s, x, c, largestOf(s, x, walls));
  }
  // A period's first row or column is repeated at its end.
  if (s.alongX && wrapX)
    for (int j = 0; j < s.rows; ++j) x(s.columns, j) = x(0, j);
  if (!s.alongX && wrapY) std::copy_n(x.row(0), s.columns, x.row(s.rows));
  return result;
}

// Over its diagonal the matrix has all its eigenvalues within 1 / (1 + 4 c) and 2 - 1 / (1 + 4 c), whatever
// the walls: Chebyshev's iteration needs no scalar products, one pass an iteration (Saad, Iterative Methods,
// algorithm 12.1). That also bounds the error after k iterations, by 2 q^k, so that their number is known
// after the first; to look at the residual would not do, which is small now and then by chance. The right
// side is in `residual`; closed faces have no link and keep their values.
Viscosity::Result Viscosity::Impl::solveByChebyshev(const System& s, Field& x, double coefficient,
                                                    double largest) {
  const auto c = static_cast<float>(coefficient);
  const double lowest = 1 / (1 + 4 * coefficient), radius = 1 - lowest;
  if (!(radius > 0)) return {0, true};
  const double root = std::sqrt((1 + radius) / lowest), q = (root - 1) / (root + 1);
  Field *now = &x, *next = &direction;
  double rho = radius;
  float momentum = 0, step = 1;  // the first step is Jacobi's
  int count = kFewestIterations;
  for (int k = 0; k < count; ++k) {
    wrap(s, *now);
    const double change = pool.max(0, s.rows, kRowGrain, 0, [&](int begin, int end) {
      float m = 0;
      for (int j = begin; j < end; ++j)
        m = std::max(m, chebyshevRow(s, *now, residual, *next, c, momentum, step, j));
      return static_cast<double>(m);
    });
    std::swap(now, next);
    if (k == 0) {
      const double enough =
          std::max(kRounding * largest, lowest * std::min(kOfVelocity * largest, kOfChange * change));
      double bound = 2 * change * q * q;
      while (bound > enough && count < kMostIterations) {
        bound *= q;
        ++count;
      }
    }
    const double rhoNext = 1 / (2 / radius - rho);
    momentum = static_cast<float>(rhoNext * rho);
    step = static_cast<float>(2 * rhoNext / radius);
    rho = rhoNext;
  }
  if (now != &x)
    pool.blocks(0, s.rows, kRowGrain, [&](int begin, int end) {
      for (int j = begin; j < end; ++j) std::copy_n(now->row(j), s.columns, x.row(j));
    });
  return {count, count < kMostIterations};
}

Viscosity::Result Viscosity::Impl::solveByGradients(const Boundary& boundary, const System& s, Field& x,
                                                    double coefficient) {
  const auto c = static_cast<float>(coefficient);
  const int n = s.columns;

  // Right side: the velocity before, and what the walls give. Closed faces: diagonal 1 and no residual.
  pool.blocks(0, s.rows, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const float *right = s.toRight.row(j), *up = s.toAbove.row(j), *down = s.toAbove.row(j - 1),
                  *w = s.wallWeight.row(j);
      float* d = diagonal.row(j);
#pragma omp simd
      for (int i = 0; i < n; ++i) d[i] = 1 + c * (((right[i - 1] + right[i]) + (down[i] + up[i])) + w[i]);
      std::copy_n(x.row(j), n, residual.row(j));
    }
  });
  const float walls = addWalls(boundary, s, c, residual);

  // The residual of what was there is small only for a small c; it is as good a start as any.
  wrap(s, x);
  const double largest = largestOf(s, x, walls);
  double rho = sum(s, [&](int j) {
    float *r = residual.row(j), *z = direction.row(j), *a = product.row(j);
    const float *d = diagonal.row(j), *known = s.unknown.row(j);
    applyRow(s, x, c, j, a);
#pragma omp simd
    for (int i = 0; i < n; ++i) {
      r[i] = known[i] * (r[i] - a[i]);
      z[i] = r[i] / d[i];
    }
    return rowSum(n, [&](int i) { return static_cast<double>(r[i]) * z[i]; });
  });

  auto largestResidual = [&] {
    return pool.max(0, s.rows, kRowGrain, 0, [&](int begin, int end) {
      float m = 0;
      for (int j = begin; j < end; ++j) {
        const float *r = residual.row(j), *d = diagonal.row(j);
#pragma omp simd reduction(max : m)
        for (int i = 0; i < n; ++i) m = std::max(m, std::fabs(r[i]) / d[i]);
      }
      return static_cast<double>(m);
    });
  };

  Result result;
  const double enough = kTolerance * largest;
  for (;;) {
    if (!(rho > 0) || largestResidual() <= enough) {
      result.converged = rho >= 0;
      break;
    }
    if (result.iterations == kMostIterations) break;
    ++result.iterations;
    wrap(s, direction);
    const double curvature = sum(s, [&](int j) {
      float *p = direction.row(j), *a = product.row(j);
      applyRow(s, direction, c, j, a);
      return rowSum(n, [&](int i) { return static_cast<double>(p[i]) * a[i]; });
    });
    if (!(curvature > 0)) break;
    const auto alpha = static_cast<float>(rho / curvature);
    const double last = rho;
    rho = sum(s, [&](int j) {
      float *q = x.row(j), *r = residual.row(j);
      const float *p = direction.row(j), *a = product.row(j), *d = diagonal.row(j);
#pragma omp simd
      for (int i = 0; i < n; ++i) {
        q[i] += alpha * p[i];
        r[i] -= alpha * a[i];
      }
      return rowSum(n, [&](int i) { return static_cast<double>(r[i]) * (r[i] / d[i]); });
    });
    const auto beta = static_cast<float>(rho / last);
    pool.blocks(0, s.rows, kRowGrain, [&](int begin, int end) {
      for (int j = begin; j < end; ++j) {
        float* p = direction.row(j);
        const float *r = residual.row(j), *d = diagonal.row(j);
#pragma omp simd
        for (int i = 0; i < n; ++i) p[i] = r[i] / d[i] + beta * p[i];
      }
    });
  }
  return result;
}

Viscosity::Viscosity(const Boundary& boundary, ThreadPool& pool)
    : impl_(std::make_unique<Impl>(boundary, pool)) {}

Viscosity::~Viscosity() = default;

void Viscosity::rebuild(const Boundary& boundary) {
  impl_->rebuild(boundary, impl_->systemU);
  impl_->rebuild(boundary, impl_->systemV);
}

void Viscosity::bendAtWalls(const Boundary& boundary, const Field& u, const Field& v) {
  impl_->bendAtWalls(boundary, impl_->systemU, u);
  impl_->bendAtWalls(boundary, impl_->systemV, v);
}

Viscosity::Result Viscosity::diffuse(const Boundary& boundary, Field& u, Field& v, double viscosity,
                                     double dt) {
  const double c = viscosity * dt / (boundary.grid.h * boundary.grid.h);
  const Result a = impl_->solve(boundary, impl_->systemU, u, c),
               b = impl_->solve(boundary, impl_->systemV, v, c);
  return {std::max(a.iterations, b.iterations), a.converged && b.converged};
}

std::size_t Viscosity::bytes() const {
  std::size_t total = 0;
  for (const System* s : {&impl_->systemU, &impl_->systemV})
    total += s->toRight.bytes() + s->toAbove.bytes() + s->wallWeight.bytes() + s->unknown.bytes() +
             s->linkWeight.capacity() * sizeof(float) + s->regular.capacity();
  for (const Field* f : {&impl_->diagonal, &impl_->residual, &impl_->direction, &impl_->product})
    total += f->bytes();
  return total;
}

void findSurfaceShear(const Boundary& boundary, const Field& u, const Field& v, SurfaceShear& shear) {
  auto find = [&](const std::vector<CutLink>& links, const Field& open, const Field& f, int columns, int rows,
                  std::vector<float>& out) {
    out.resize(links.size());
    for (std::size_t begin = 0, end; begin < links.size(); begin = end) {
      const int i = links[begin].i, j = links[begin].j;
      for (end = begin; end < links.size() && links[end].i == i && links[end].j == j;) ++end;
      for (std::size_t k = begin; k < end; ++k) {
        const CutLink& link = links[k];
        int a = i - link.di, b = j - link.dj;
        if (boundary.periodicX()) a = a < 0 ? a + columns : a >= columns ? a - columns : a;
        if (boundary.periodicY()) b = b < 0 ? b + rows : b >= rows ? b - rows : b;
        const bool joined =
            a >= 0 && a < columns && b >= 0 && b < rows && open(a, b) > 0 &&
            std::none_of(links.begin() + static_cast<std::ptrdiff_t>(begin),
                         links.begin() + static_cast<std::ptrdiff_t>(end),
                         [&](const CutLink& other) { return other.di == -link.di && other.dj == -link.dj; });
        const float here = f(i, j) - link.velocity, theta = std::max(link.theta, kShortestLink);
        out[k] = joined ? here * (1 + theta) / theta - (f(a, b) - link.velocity) * theta / (1 + theta)
                        : here / theta;
      }
    }
  };
  const int nx = boundary.grid.nx, ny = boundary.grid.ny;
  find(boundary.linksU, boundary.openX, u, boundary.periodicX() ? nx : nx + 1, ny, shear.u);
  find(boundary.linksV, boundary.openY, v, nx, boundary.periodicY() ? ny : ny + 1, shear.v);
}

void applySurfaceDrag(const Boundary& boundary, Field& u, Field& v) {
  // A surface takes along the faces that it cuts: all of the velocity at no distance, none of it a cell away.
  // The links of a face are together; the one that takes the most decides.
  auto apply = [](const std::vector<CutLink>& links, const Field& open, Field& f) {
    for (std::size_t k = 0; k < links.size();) {
      const int i = links[k].i, j = links[k].j;
      float share = 0, wall = 0;
      for (; k < links.size() && links[k].i == i && links[k].j == j; ++k) {
        const float s = std::clamp(links[k].drag, 0.0f, 1.0f) * (1 - std::clamp(links[k].theta, 0.0f, 1.0f));
        if (s > share)
          share = s, wall = links[k].velocity;
        else if (s == share)
          wall = 0.5f * (wall + links[k].velocity);  // mirror images have them in another order
      }
      if (open(i, j) > 0) f(i, j) += share * (wall - f(i, j));
    }
  };
  apply(boundary.linksU, boundary.openX, u);
  apply(boundary.linksV, boundary.openY, v);
}

}  // namespace smokebox
