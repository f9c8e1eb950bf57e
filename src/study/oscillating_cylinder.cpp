// A cylinder that oscillates in a fluid at rest, Keulegan-Carpenter number 5, Reynolds number 100: Duetsch,
// Durst, Becker and Lienhart, J. Fluid Mech. 360 (1998). Diameter 1, largest speed 1, period 5. The force
// along the motion is fitted by Morison's formula,
//   F / (rho Um^2 D) = -Cd/2 |u| u / Um^2 - pi/4 (D / Um^2) Cm du/dt .
#include <algorithm>
#include <array>
#include <cmath>

#include "base/maths.h"
#include "study/cases.h"
#include "world/world.h"

namespace smokebox {

namespace {

constexpr double kPeriod = 5;
constexpr int kSide = 16, kCycles = 4;

std::string sceneOf(int size) {
  const std::string side = std::to_string(kSide);
  return "domain: {size: [" + side + ", " + side + "], resolution: " + std::to_string(kSide * size) +
         "}\nfluid: {density: 1, viscosity: 0.01}\ntime: {step: 1/" + std::to_string(4 * size) +
         ", duration: " + std::to_string(kCycles * kPeriod) +
         "}\noutput: {fps: 1}\nsolids: [{name: cylinder, shape: {circle: {radius: 0.5}}, report: true, "
         "motion: "
         "{expression: {x: \"8 - 5/(2*pi)*sin(2*pi*t/5)\", y: \"8\", angle: \"0\"}}}]\n";
}

/// Solves the normal equations of a fit of `count` functions; a and b are overwritten.
template <std::size_t N>
std::array<double, N> solved(std::array<std::array<double, N>, N> a, std::array<double, N> b) {
  for (std::size_t k = 0; k < N; ++k)
    for (std::size_t r = k + 1; r < N; ++r) {
      const double factor = a[r][k] / a[k][k];
      for (std::size_t c = k; c < N; ++c) a[r][c] -= factor * a[k][c];
      b[r] -= factor * b[k];
    }
  for (std::size_t k = N; k-- > 0;) {
    for (std::size_t c = k + 1; c < N; ++c) b[k] -= a[k][c] * b[c];
    b[k] /= a[k][k];
  }
  return b;
}

/// Least squares fit of functions of the phase to forces.
template <std::size_t N, class Functions>
std::array<double, N> fitted(const std::vector<double>& phases, const std::vector<double>& forces,
                             Functions&& functions) {
  std::array<std::array<double, N>, N> a{};
  std::array<double, N> b{};
  for (std::size_t k = 0; k < phases.size(); ++k) {
    const std::array<double, N> f = functions(phases[k]);
    for (std::size_t r = 0; r < N; ++r) {
      b[r] += f[r] * forces[k];
      for (std::size_t c = 0; c < N; ++c) a[r][c] += f[r] * f[c];
    }
  }
  return solved<N>(a, b);
}

StudyOutcome measure(const SceneDocument& scene, int threads) {
  constexpr double kDrag = 2.09, kInertia = 1.45, kPeak = 1.65;
  World world(scene, {.threads = threads, .figures = true});
  const TimeSpec time = world.spec().time;
  std::vector<double> phases, forces;  // of the last cycle
  while (world.stepCount() < time.steps) {
    world.step();
    if (world.time() <= time.duration - kPeriod + 1e-9) continue;
    // The force over a step belongs to its middle.
    phases.push_back(2 * kPi * (world.time() - 0.5 * time.step) / kPeriod);
    forces.push_back(world.figures().bodies.at(0).force.x);
  }
  const auto morison = fitted<2>(phases, forces, [](double phase) {
    const double speed = -std::cos(phase), acceleration = 2 * kPi / kPeriod * std::sin(phase);
    return std::array<double, 2>{-0.5 * std::fabs(speed) * speed, -0.25 * kPi * acceleration};
  });
  auto harmonics = [](double phase) {
    return std::array<double, 11>{1,
                                  std::cos(phase),
                                  std::sin(phase),
                                  std::cos(2 * phase),
                                  std::sin(2 * phase),
                                  std::cos(3 * phase),
                                  std::sin(3 * phase),
                                  std::cos(4 * phase),
                                  std::sin(4 * phase),
                                  std::cos(5 * phase),
                                  std::sin(5 * phase)};
  };
  const auto smooth = fitted<11>(phases, forces, harmonics);
  double peak = 0, rest = 0;
  for (std::size_t k = 0; k < phases.size(); ++k) {
    const std::array<double, 11> f = harmonics(phases[k]);
    double value = 0;
    for (std::size_t n = 0; n < f.size(); ++n) value += smooth[n] * f[n];
    peak = std::max(peak, std::fabs(value));
    rest += (forces[k] - value) * (forces[k] - value);
  }
  const double noise = std::sqrt(rest / static_cast<double>(phases.size())) / peak;
  return {{{"drag", morison[0], kDrag, std::fabs(morison[0] / kDrag - 1)},
           {"inertia", morison[1], kInertia, std::fabs(morison[1] / kInertia - 1)},
           {"peak force", peak, kPeak, std::fabs(peak / kPeak - 1)},
           {"noise of the force", noise, 0, noise}},
          world.stepCount()};
}

}  // namespace

Study oscillatingCylinder() {
  return {"oscillating-cylinder",
          "a cylinder that oscillates in a fluid at rest, KC 5, Re 100; size: cells along the diameter",
          "Duetsch, Durst, Becker and Lienhart 1998: Cd 2.09, Cm 1.45; the peak from their figure 10",
          {8, 16, 24, 32},
          sceneOf,
          measure};
}

}  // namespace smokebox
