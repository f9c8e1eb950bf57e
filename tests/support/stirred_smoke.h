// Smoke in a fluid that only moving solids drive, for tests of what walls do to it.
#pragma once
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "coupling/solids_on_grid.h"
#include "fluid/pressure.h"
#include "fluid/smoke.h"

namespace smokebox::test {

inline Outline box(Vec2 centre, double w, double h, double angle = 0) {
  const double c = std::cos(angle), s = std::sin(angle);
  Outline out;
  for (Vec2 p : {Vec2{-w / 2, -h / 2}, Vec2{w / 2, -h / 2}, Vec2{w / 2, h / 2}, Vec2{-w / 2, h / 2}})
    out.push_back({centre.x + c * p.x - s * p.y, centre.y + s * p.x + c * p.y});
  return out;
}

// A fluid that only solids drive: each step the potential flow that fits them.
struct Stirred {
  Boundary b;
  SolidsOnGrid grid;
  ThreadPool pool;
  Field u, v, phi;
  double worst = 0;
  std::unique_ptr<PressureSolver> solver;
  std::unique_ptr<Smoke> smoke;

  Stirred(int nx, int ny, double h, const std::vector<MovingSolid>& solids, int threads = 1,
          WallKind side = WallKind::slip, int channels = 1)
      : pool(threads), u(nx, ny), v(nx, ny), phi(nx, ny) {
    b.grid = {nx, ny, h};
    b.sides[0].kind = b.sides[1].kind = side;
    if (side == WallKind::periodic) b.sides[2].kind = b.sides[3].kind = side;
    grid.cover(solids, true, b);
    solver = std::make_unique<PressureSolver>(b, pool);
    smoke = std::make_unique<Smoke>(b, pool, channels);
  }
  void step(const std::vector<MovingSolid>& solids, double dt) {
    grid.cover(solids, true, b);
    solver->rebuild(b);
    u.fill(0);
    v.fill(0);
    const auto result = solver->project(b, u, v, phi, 1e-6, 1e-6, 200);
    worst = std::max(worst, result.divergence);
    smoke->transport(b, u, v, dt);
  }
  double massWhere(auto inside) const {
    double sum = 0;
    for (int j = 0; j < b.grid.ny; ++j)
      for (int i = 0; i < b.grid.nx; ++i)
        if (inside(b.grid.cellCentre(i, j)))
          sum += static_cast<double>(smoke->value(0)(i, j)) * b.volume(i, j);
    return sum * b.grid.h * b.grid.h;
  }
};

}  // namespace smokebox::test
