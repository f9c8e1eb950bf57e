#include "fluid/heat.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fluid/heat_diffusion.h"
#include "fluid/heat_flux.h"

namespace smokebox {

namespace {

constexpr int kRowGrain = 16;
constexpr float kSmallestCapacity = 0.5f;
constexpr int kMostSubSteps = 64;  // faster flows are slowed down: stable, bounded, wrong
constexpr float kSlack = 1e-6f;    // of the spread: what rounding may do to the bounds
constexpr int kFillLayers = 4;     // of cells that open at once

}  // namespace

struct Heat::Impl {
  Impl(const Boundary& boundary, bool diffuses, ThreadPool& threads)
      : pool(threads),
        nx(boundary.grid.nx),
        ny(boundary.grid.ny),
        wrapX(boundary.periodicX()),
        wrapY(boundary.periodicY()),
        flux(boundary) {
    for (Field* f : {&value, &first, &second, &perCapacity, &courantX, &courantY, &fluxX, &fluxY, &room})
      *f = Field(nx, ny);
    if (diffuses) {
      rate = Field(nx, ny);
      diffusion.emplace(boundary, pool);
    }
    for (int side = 0; side < 4; ++side) sides.value[side].assign(side < 2 ? ny : nx, 0.0f);
    uncovered.reserve(256);
    rebuild(boundary, true);
  }

  void rebuild(const Boundary& boundary, bool first);
  void fillUncovered();
  /// The volume through each face in dt, in cells; returns the largest part of its own that any cell takes
  /// in.
  double findCourants(const Boundary& boundary, const Field& u, const Field& v, double dt);
  void scaleCourants(float factor);
  void fillGhosts(Field& t) const;
  /// The heat through all faces, of the state `t`, into fluxX and fluxY.
  void findFluxes(Field& t);
  /// out = base - share (div F - t div courant) / capacity + push rate; is all of it within the bounds?
  bool advanceBy(const Field& base, const Field& t, float share, float push, Field& out);
  /// The same with the fluxes corrected; `first` is scratch.
  void advanceBounded(const Field& base, float share, Field& out);
  void addRate(const Field& base, float push, Field& out);

  ThreadPool& pool;
  int nx, ny;
  bool wrapX, wrapY;
  HeatFlux flux;
  HeatSides sides;
  std::array<WallKind, 4> kinds{};
  Field value, first, second;
  Field perCapacity;  // one over what a cell holds, in cells; 0 where it is closed
  Field courantX, courantY, fluxX, fluxY, room;
  Field rate;  // by diffusion in the last step, 1/s
  bool rateIsZero = true;
  std::optional<HeatDiffusion> diffusion;
  float lowest = std::numeric_limits<float>::max(), highest = std::numeric_limits<float>::lowest();
  std::vector<int> uncovered;
};

void Heat::Impl::rebuild(const Boundary& boundary, bool isFirst) {
  for (int side = 0; side < 4; ++side) kinds[side] = boundary.sides[side].kind;
  uncovered.clear();
  for (int j = 0; j < ny; ++j) {
    const float *x = boundary.openX.row(j), *y = boundary.openY.row(j), *above = boundary.openY.row(j + 1),
                *volume = boundary.volume.row(j);
    float* per = perCapacity.row(j);
    for (int i = 0; i < nx; ++i) {
      const bool open = volume[i] > 0 && (x[i] > 0 || x[i + 1] > 0 || y[i] > 0 || above[i] > 0);
      if (open && !(per[i] > 0) && !isFirst) uncovered.push_back(j * nx + i);
      per[i] = open ? 1 / std::clamp(volume[i], kSmallestCapacity, 1.0f) : 0.0f;
    }
  }
  fillUncovered();
  flux.rebuild(boundary, sides);
  if (diffusion) diffusion->rebuild(boundary, sides, perCapacity);
}

void Heat::Impl::fillUncovered() {
  // Those that wait for a neighbour with a value are marked by a negative capacity.
  for (const int at : uncovered) perCapacity(at % nx, at / nx) *= -1;
  for (int layer = 0; layer < kFillLayers && !uncovered.empty(); ++layer) {
    for (const int at : uncovered) {
      const int i = at % nx, j = at / nx;
      float sum = 0;
      int count = 0;
      for (int b = -1; b <= 1; ++b)
        for (int a = -1; a <= 1; ++a) {
          const int p = wrapX ? (i + a + nx) % nx : i + a, q = wrapY ? (j + b + ny) % ny : j + b;
          if (p < 0 || p >= nx || q < 0 || q >= ny || !(perCapacity(p, q) > 0)) continue;
          sum += value(p, q);
          ++count;
        }
      room(i, j) = count > 0 ? sum / static_cast<float>(count) : std::numeric_limits<float>::quiet_NaN();
    }
    std::size_t left = 0;
    for (const int at : uncovered) {
      const int i = at % nx, j = at / nx;
      if (std::isnan(room(i, j))) {
        uncovered[left++] = at;
        continue;
      }
      value(i, j) = room(i, j);
      perCapacity(i, j) *= -1;
      if (!rate.empty()) rate(i, j) = 0;
    }
    uncovered.resize(left);
  }
  for (const int at : uncovered) perCapacity(at % nx, at / nx) *= -1;  // far from any fluid: as it was
}

double Heat::Impl::findCourants(const Boundary& boundary, const Field& u, const Field& v, double dt) {
  const auto scale = static_cast<float>(dt / boundary.grid.h);
  pool.blocks(0, ny + 1, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const float *openY = boundary.openY.row(j), *vRow = v.row(j);
      float* cy = courantY.row(j);
#pragma omp simd
      for (int i = 0; i < nx; ++i) cy[i] = scale * (openY[i] * vRow[i]);
      if (j < ny) {
        const float *openX = boundary.openX.row(j), *uRow = u.row(j);
        float* cx = courantX.row(j);
#pragma omp simd
        for (int i = 0; i <= nx; ++i) cx[i] = scale * (openX[i] * uRow[i]);
        // An inflow is a closed face whose wall moves.
        for (const int i : {0, nx})
          if (kinds[i == 0 ? 0 : 1] == WallKind::inflow)
            cx[i] += scale * ((1 - openX[i]) * boundary.wallU(i, j));
        if (wrapX) cx[nx] = cx[0];
      }
      if ((j == 0 || j == ny) && kinds[j == 0 ? 2 : 3] == WallKind::inflow)
        for (int i = 0; i < nx; ++i) cy[i] += scale * ((1 - openY[i]) * boundary.wallV(i, j));
      if (wrapY && j == ny)
        for (int i = 0; i < nx; ++i) cy[i] = scale * (boundary.openY(i, 0) * v(i, 0));
    }
  });
  return pool.max(0, ny, kRowGrain, 0, [&](int begin, int end) {
    float most = 0;
    for (int j = begin; j < end; ++j) {
      const float *cx = courantX.row(j), *cy = courantY.row(j), *above = courantY.row(j + 1),
                  *per = perCapacity.row(j);
#pragma omp simd reduction(max : most)
      for (int i = 0; i < nx; ++i) {
        const float in = (std::max(cx[i], 0.0f) + std::max(-cx[i + 1], 0.0f)) +
                         (std::max(cy[i], 0.0f) + std::max(-above[i], 0.0f));
        most = std::max(most, per[i] * in);
      }
    }
    return static_cast<double>(most);
  });
}

void Heat::Impl::scaleCourants(float factor) {
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      courantX(i, j) *= factor;
      courantY(i, j) *= factor;
    }
}

void Heat::Impl::fillGhosts(Field& t) const {
  const std::ptrdiff_t stride = t.stride();
  // s[0] is the cell at the side, s[step] the next one inwards; writes s[-step] .. s[-3 step].
  auto continueBeyond = [&](int side, float given, float* s, std::ptrdiff_t step) {
    const WallKind kind = kinds[side];
    if (sides.keeps[side]) {
      // The parabola through the wall and the two nearest cells.
      const float beyond = (8.0f / 3) * given - 2 * s[0] + (1.0f / 3) * s[step];
      for (int k = 1; k <= 3; ++k) s[-k * step] = beyond;
    } else if (kind == WallKind::inflow) {
      for (int k = 1; k <= 3; ++k) s[-k * step] = given;
    } else if (kind == WallKind::open) {
      for (int k = 1; k <= 3; ++k) s[-k * step] = s[0];
    } else {
      for (int k = 1; k <= 3; ++k) s[-k * step] = s[(k - 1) * step];
    }
  };
  pool.blocks(0, ny, 4 * kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      float* row = t.row(j);
      if (wrapX) {
        for (int k = 1; k <= 3; ++k) row[-k] = row[nx - k], row[nx - 1 + k] = row[k - 1];
      } else {
        continueBeyond(0, sides.value[0][j], row, 1);
        continueBeyond(1, sides.value[1][j], row + nx - 1, -1);
      }
    }
  });
  if (wrapY) {
    for (int k = 1; k <= 3; ++k) {
      std::copy_n(t.row(ny - k), nx, t.row(-k));
      std::copy_n(t.row(k - 1), nx, t.row(ny - 1 + k));
    }
    return;
  }
  for (int i = 0; i < nx; ++i) {
    continueBeyond(2, sides.value[2][i], t.row(0) + i, stride);
    continueBeyond(3, sides.value[3][i], t.row(ny - 1) + i, -stride);
  }
}

void Heat::Impl::findFluxes(Field& t) {
  fillGhosts(t);
  pool.blocks(0, ny + 1, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      if (j < ny) flux.rowX(sides, t, courantX, j, fluxX);
      flux.rowY(sides, t, courantY, j, fluxY);
    }
  });
}

bool Heat::Impl::advanceBy(const Field& base, const Field& t, float share, float push, Field& out) {
  const float slack = kSlack * (highest - lowest), low = lowest - slack, high = highest + slack;
  const bool pushed = push != 0;
  const double outside = pool.max(0, ny, kRowGrain, 0, [&](int begin, int end) {
    int beyond = 0;
    for (int j = begin; j < end; ++j) {
      const float *fx = fluxX.row(j), *fy = fluxY.row(j), *fUp = fluxY.row(j + 1), *cx = courantX.row(j),
                  *cy = courantY.row(j), *cUp = courantY.row(j + 1), *here = t.row(j), *b = base.row(j),
                  *per = perCapacity.row(j);
      float* o = out.row(j);
#pragma omp simd reduction(| : beyond)
      for (int i = 0; i < nx; ++i) {
        const float net =
            ((fx[i + 1] - fx[i]) + (fUp[i] - fy[i])) - here[i] * ((cx[i + 1] - cx[i]) + (cUp[i] - cy[i]));
        const float carried = b[i] - share * per[i] * net;
        o[i] = carried;
        beyond |= static_cast<int>(per[i] > 0) & static_cast<int>(!((carried >= low) & (carried <= high)));
      }
      if (!pushed) continue;
      const float* r = rate.row(j);
#pragma omp simd
      for (int i = 0; i < nx; ++i) o[i] += push * r[i];
    }
    return static_cast<double>(beyond);
  });
  return outside == 0;
}

void Heat::Impl::advanceBounded(const Field& base, float share, Field& out) {
  const float low = lowest, high = highest;
  // The donor's values are within the bounds; what the fluxes have more than theirs stays in fluxX and fluxY.
  auto donorX = [&](int i, int j) { return flux.donorX(sides, base, courantX, i, j); };
  auto donorY = [&](int i, int j) { return flux.donorY(sides, base, courantY, i, j); };
  pool.blocks(0, ny, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j)
      for (int i = 0; i < nx; ++i) {
        const float net =
            ((donorX(i + 1, j) - donorX(i, j)) + (donorY(i, j + 1) - donorY(i, j))) -
            base(i, j) * ((courantX(i + 1, j) - courantX(i, j)) + (courantY(i, j + 1) - courantY(i, j)));
        out(i, j) = base(i, j) - share * perCapacity(i, j) * net;
      }
  });
  pool.blocks(0, ny + 1, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j)
      for (int i = 0; i <= nx; ++i) {
        if (j < ny) fluxX(i, j) = share * (fluxX(i, j) - donorX(i, j));
        if (i < nx) fluxY(i, j) = share * (fluxY(i, j) - donorY(i, j));
      }
  });
  // `first`: share of what comes in that a cell can take; `room`: of what leaves.
  pool.blocks(0, ny, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      auto part = [](float left, float wanted) {
        return wanted > std::max(left, 0.0f) ? std::max(left, 0.0f) / wanted : 1.0f;
      };
      for (int i = 0; i < nx; ++i) {
        const float a = fluxX(i, j), b = fluxX(i + 1, j), c = fluxY(i, j), d = fluxY(i, j + 1);
        const float in = (std::max(a, 0.0f) + std::max(-b, 0.0f)) + (std::max(c, 0.0f) + std::max(-d, 0.0f)),
                    gone =
                        (std::max(-a, 0.0f) + std::max(b, 0.0f)) + (std::max(-c, 0.0f) + std::max(d, 0.0f));
        first(i, j) = part(high - out(i, j), perCapacity(i, j) * in);
        room(i, j) = part(out(i, j) - low, perCapacity(i, j) * gone);
      }
      for (Field* f : {&first, &room}) {
        (*f)(-1, j) = wrapX ? (*f)(nx - 1, j) : 1.0f;
        (*f)(nx, j) = wrapX ? (*f)(0, j) : 1.0f;
      }
    }
  });
  for (Field* f : {&first, &room})
    for (int i = 0; i < nx; ++i) {
      (*f)(i, -1) = wrapY ? (*f)(i, ny - 1) : 1.0f;
      (*f)(i, ny) = wrapY ? (*f)(i, 0) : 1.0f;
    }
  auto limited = [](float f, float takesAhead, float givesBehind, float takesBehind, float givesAhead) {
    return f * (f > 0 ? std::min(takesAhead, givesBehind) : std::min(takesBehind, givesAhead));
  };
  auto limitedX = [&](int i, int j) {
    return limited(fluxX(i, j), first(i, j), room(i - 1, j), first(i - 1, j), room(i, j));
  };
  auto limitedY = [&](int i, int j) {
    return limited(fluxY(i, j), first(i, j), room(i, j - 1), first(i, j - 1), room(i, j));
  };
  pool.blocks(0, ny, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j)
      for (int i = 0; i < nx; ++i)
        out(i, j) -= perCapacity(i, j) *
                     ((limitedX(i + 1, j) - limitedX(i, j)) + (limitedY(i, j + 1) - limitedY(i, j)));
  });
}

void Heat::Impl::addRate(const Field& base, float push, Field& out) {
  pool.blocks(0, ny, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const float *b = base.row(j), *r = rate.row(j);
      float* o = out.row(j);
#pragma omp simd
      for (int i = 0; i < nx; ++i) o[i] = b[i] + push * r[i];
    }
  });
}

Heat::Heat(const Boundary& boundary, bool diffuses, ThreadPool& pool)
    : impl_(std::make_unique<Impl>(boundary, diffuses, pool)) {}

Heat::~Heat() = default;

const Field& Heat::value() const { return impl_->value; }

Field& Heat::values() { return impl_->value; }

bool Heat::isOpen(int i, int j) const { return impl_->perCapacity(i, j) > 0; }

void Heat::allow(double low, double high) {
  impl_->lowest = std::min(impl_->lowest, static_cast<float>(low));
  impl_->highest = std::max(impl_->highest, static_cast<float>(high));
}

void Heat::started(const Boundary& boundary) {
  Impl& m = *impl_;
  for (int j = 0; j < boundary.grid.ny; ++j)
    for (int i = 0; i < boundary.grid.nx; ++i) {
      if (!isOpen(i, j)) continue;
      m.lowest = std::min(m.lowest, m.value(i, j));
      m.highest = std::max(m.highest, m.value(i, j));
    }
}

void Heat::setSides(const Boundary& boundary, const HeatSides& sides) {
  Impl& m = *impl_;
  const bool rebuild = sides.keeps != m.sides.keeps;
  m.sides = sides;
  for (int side = 0; side < 4; ++side) {
    const WallKind kind = boundary.sides[side].kind;
    if (!sides.keeps[side] && kind != WallKind::inflow && kind != WallKind::open) continue;
    for (const float given : sides.value[side]) {
      m.lowest = std::min(m.lowest, given);
      m.highest = std::max(m.highest, given);
    }
  }
  if (rebuild) m.rebuild(boundary, false);
}

void Heat::boundaryChanged(const Boundary& boundary) { impl_->rebuild(boundary, false); }

Heat::Result Heat::advance(const Boundary& boundary, const Field& u, const Field& v, double diffusivity,
                           double dt) {
  Impl& m = *impl_;
  Result result;
  const double courant = m.findCourants(boundary, u, v, dt);
  if (!std::isfinite(courant)) {
    result.finite = false;
    return result;
  }
  result.subSteps = std::clamp(static_cast<int>(std::ceil(std::min(courant, 1e6))), 1, kMostSubSteps);
  if (courant > kMostSubSteps) m.scaleCourants(static_cast<float>(kMostSubSteps / courant));

  if (m.diffusion && diffusivity == 0 && !m.rateIsZero) {
    m.rate.fill(0);
    m.rateIsZero = true;
  }
  const bool diffuses = m.diffusion && diffusivity > 0;
  if (diffuses) m.diffusion->bendAtWalls(m.sides, m.value);
  const double share = 1.0 / result.subSteps;
  for (int k = 0; k < result.subSteps; ++k) {
    // What diffusion has done by a part of the sub-step.
    auto pushed = [&](double part) { return diffuses ? static_cast<float>(dt * share * (k + part)) : 0.0f; };
    Field* state = &m.value;
    if (k > 0 && diffuses) {
      m.addRate(m.value, pushed(0), m.first);
      state = &m.first;
    }
    m.findFluxes(*state);
    m.advanceBy(m.value, *state, static_cast<float>(share / 3), pushed(1.0 / 3), m.second);
    m.findFluxes(m.second);
    m.advanceBy(m.value, m.second, static_cast<float>(share / 2), pushed(0.5), m.first);
    m.findFluxes(m.first);
    const auto whole = static_cast<float>(share);
    if (!m.advanceBy(m.value, m.first, whole, 0, m.second)) m.advanceBounded(m.value, whole, m.second);
    m.value.swap(m.second);
  }
  if (!diffuses) return result;

  // m.first: the guess in, the new values out.
  m.addRate(m.value, m.rateIsZero ? 0 : static_cast<float>(dt), m.first);
  const double c = diffusivity * dt / (boundary.grid.h * boundary.grid.h);
  const HeatDiffusion::Result solved = m.diffusion->solve(m.sides, m.value, c, m.lowest, m.highest, m.first);
  result.iterations = solved.iterations;
  result.converged = solved.converged;
  const auto perStep = static_cast<float>(1 / dt);
  m.pool.blocks(0, m.ny, kRowGrain, [&](int begin, int end) {
    for (int j = begin; j < end; ++j) {
      const float *before = m.value.row(j), *after = m.first.row(j);
      float* r = m.rate.row(j);
#pragma omp simd
      for (int i = 0; i < m.nx; ++i) r[i] = perStep * (after[i] - before[i]);
    }
  });
  m.rateIsZero = false;
  m.value.swap(m.first);
  return result;
}

std::size_t Heat::bytes() const {
  const Impl& m = *impl_;
  std::size_t total = m.flux.bytes() + (m.diffusion ? m.diffusion->bytes() : 0);
  for (const Field* f : {&m.value, &m.first, &m.second, &m.perCapacity, &m.courantX, &m.courantY, &m.fluxX,
                         &m.fluxY, &m.room, &m.rate})
    total += f->bytes();
  return total;
}

}  // namespace smokebox
