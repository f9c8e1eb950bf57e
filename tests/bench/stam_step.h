// Stam's step, the yardstick for the cost of a step: Stam, Real-Time Fluid Dynamics for Games (GDC 2003),
// with its 20 Gauss-Seidel sweeps for each of three diffusions and two projections, collocated, float32,
// divided as published, loops in the order of memory, one thread. Square, walls all around.
#pragma once
#include <algorithm>
#include <utility>
#include <vector>

namespace smokebox::test {

class StamStep {
 public:
  explicit StamStep(int n) : n_(n), row_(n + 2) {
    for (auto* field : {&u_, &v_, &u0_, &v0_, &x_, &x0_})
      field->assign(static_cast<std::size_t>(row_) * row_, 0.0f);
  }

  void step(float dt, float viscosity, float diffusion) {
    fill();
    velocityStep(dt, viscosity);
    densityStep(dt, diffusion);
  }
  float density(int i, int j) const { return x_[at(i, j)]; }

 private:
  static constexpr int kSweeps = 20;
  using Values = std::vector<float>;

  std::size_t at(int i, int j) const { return static_cast<std::size_t>(j) * row_ + i; }

  /// A source of smoke at the bottom that also blows upwards.
  void fill() {
    for (auto* field : {&u0_, &v0_, &x0_}) std::fill(field->begin(), field->end(), 0.0f);
    for (int j = n_ / 20 + 1; j < n_ / 10 + 1; ++j)
      for (int i = n_ * 9 / 20; i < n_ * 11 / 20; ++i) {
        x0_[at(i, j)] = 4;
        v0_[at(i, j)] = 2;
      }
  }

  void addSource(Values& x, const Values& s, float dt) {
    for (std::size_t k = 0; k < x.size(); ++k) x[k] += dt * s[k];
  }

  void setBoundary(int kind, Values& x) {
    for (int k = 1; k <= n_; ++k) {
      x[at(0, k)] = kind == 1 ? -x[at(1, k)] : x[at(1, k)];
      x[at(n_ + 1, k)] = kind == 1 ? -x[at(n_, k)] : x[at(n_, k)];
      x[at(k, 0)] = kind == 2 ? -x[at(k, 1)] : x[at(k, 1)];
      x[at(k, n_ + 1)] = kind == 2 ? -x[at(k, n_)] : x[at(k, n_)];
    }
    x[at(0, 0)] = 0.5f * (x[at(1, 0)] + x[at(0, 1)]);
    x[at(0, n_ + 1)] = 0.5f * (x[at(1, n_ + 1)] + x[at(0, n_)]);
    x[at(n_ + 1, 0)] = 0.5f * (x[at(n_, 0)] + x[at(n_ + 1, 1)]);
    x[at(n_ + 1, n_ + 1)] = 0.5f * (x[at(n_, n_ + 1)] + x[at(n_ + 1, n_)]);
  }

  void solve(int kind, Values& x, const Values& x0, float a, float c) {
    for (int k = 0; k < kSweeps; ++k) {
      for (int j = 1; j <= n_; ++j)
        for (int i = 1; i <= n_; ++i)
          x[at(i, j)] =
              (x0[at(i, j)] + a * (x[at(i - 1, j)] + x[at(i + 1, j)] + x[at(i, j - 1)] + x[at(i, j + 1)])) /
              c;
      setBoundary(kind, x);
    }
  }

  void diffuse(int kind, Values& x, const Values& x0, float rate, float dt) {
    const float a = dt * rate * static_cast<float>(n_) * static_cast<float>(n_);
    solve(kind, x, x0, a, 1 + 4 * a);
  }

  void advect(int kind, Values& d, const Values& d0, const Values& u, const Values& v, float dt) {
    const float dt0 = dt * static_cast<float>(n_), most = static_cast<float>(n_) + 0.5f;
    for (int j = 1; j <= n_; ++j)
      for (int i = 1; i <= n_; ++i) {
        const float x = std::clamp(static_cast<float>(i) - dt0 * u[at(i, j)], 0.5f, most);
        const float y = std::clamp(static_cast<float>(j) - dt0 * v[at(i, j)], 0.5f, most);
        const int i0 = static_cast<int>(x), j0 = static_cast<int>(y);
        const float s1 = x - static_cast<float>(i0), s0 = 1 - s1;
        const float t1 = y - static_cast<float>(j0), t0 = 1 - t1;
        d[at(i, j)] = s0 * (t0 * d0[at(i0, j0)] + t1 * d0[at(i0, j0 + 1)]) +
                      s1 * (t0 * d0[at(i0 + 1, j0)] + t1 * d0[at(i0 + 1, j0 + 1)]);
      }
    setBoundary(kind, d);
  }

  void project(Values& u, Values& v, Values& p, Values& div) {
    const float h = 1 / static_cast<float>(n_);
    for (int j = 1; j <= n_; ++j)
      for (int i = 1; i <= n_; ++i) {
        div[at(i, j)] = -0.5f * h * (u[at(i + 1, j)] - u[at(i - 1, j)] + v[at(i, j + 1)] - v[at(i, j - 1)]);
        p[at(i, j)] = 0;
      }
    setBoundary(0, div);
    setBoundary(0, p);
    solve(0, p, div, 1, 4);
    for (int j = 1; j <= n_; ++j)
      for (int i = 1; i <= n_; ++i) {
        u[at(i, j)] -= 0.5f * (p[at(i + 1, j)] - p[at(i - 1, j)]) / h;
        v[at(i, j)] -= 0.5f * (p[at(i, j + 1)] - p[at(i, j - 1)]) / h;
      }
    setBoundary(1, u);
    setBoundary(2, v);
  }

  void velocityStep(float dt, float viscosity) {
    addSource(u_, u0_, dt);
    addSource(v_, v0_, dt);
    std::swap(u_, u0_);
    diffuse(1, u_, u0_, viscosity, dt);
    std::swap(v_, v0_);
    diffuse(2, v_, v0_, viscosity, dt);
    project(u_, v_, u0_, v0_);
    std::swap(u_, u0_);
    std::swap(v_, v0_);
    advect(1, u_, u0_, u0_, v0_, dt);
    advect(2, v_, v0_, u0_, v0_, dt);
    project(u_, v_, u0_, v0_);
  }

  void densityStep(float dt, float diffusion) {
    addSource(x_, x0_, dt);
    std::swap(x_, x0_);
    diffuse(0, x_, x0_, diffusion, dt);
    std::swap(x_, x0_);
    advect(0, x_, x0_, u_, v_, dt);
  }

  int n_, row_;
  Values u_, v_, u0_, v0_, x_, x0_;
};

}  // namespace smokebox::test
