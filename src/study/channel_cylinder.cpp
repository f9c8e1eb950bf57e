// The cylinder in a channel of Schaefer and Turek (1996), "Benchmark computations of laminar flow around a
// cylinder": 2D-1, steady at Re 20, and 2D-2, shedding vortices at Re 100. Channel 2.2 x 0.41, diameter 0.1,
// centre (0.2, 0.2), density 1, viscosity 1e-3, parabolic inflow; coefficients are 2 F / (U^2 D).
#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "study/cases.h"
#include "world/world.h"

namespace smokebox {

namespace {

constexpr double kDiameter = 0.1;

/// `peak`: the largest speed of the inflow, m/s; `across`: the velocity along y at the start.
std::string channel(int size, const std::string& peak, const std::string& across, double duration,
                    int stepsPerSecond) {
  const std::string along = "\"" + peak + "*4*y*(0.41-y)/0.41^2\"";
  return "domain: {size: [2.2, 0.41], resolution: " + std::to_string(22 * size) +
         "}\nwalls: {left: {inflow: [" + along +
         ", 0]}, right: open, bottom: no-slip, top: no-slip}\nfluid: {density: 1, viscosity: 1e-3, velocity: "
         "[" +
         along + ", \"" + across + "\"]}\ntime: {step: 1/" + std::to_string(stepsPerSecond) +
         ", duration: " + std::to_string(duration) +
         "}\noutput: {fps: 1}\nsolids: [{name: cylinder, shape: {circle: {radius: 0.05}}, position: [0.2, "
         "0.2], "
         "report: true}]\n";
}

double coefficient(double force, double speed) { return 2 * force / (speed * speed * kDiameter); }

/// The force along x by what the steady flow through a box around the cylinder loses of its momentum: on all
/// sides but there the cells are whole, so this has no part in how the surface's own force is found. The box
/// reaches half a diameter beyond the cylinder.
double momentumLost(const World& world, int size) {
  const Grid& grid = world.spec().domain.grid;
  const Fluid& fluid = *world.fluid();
  const Field &u = fluid.u(), &v = fluid.v(), &phi = fluid.phi();
  const double h = grid.h, viscosity = world.spec().fluid.viscosity;
  const double pascals = world.spec().fluid.density * h / world.spec().time.step;
  // Half way between the two in the middle of four, to fourth order.
  const auto between = [](double a, double b, double c, double d) { return (9 * (b + c) - (a + d)) / 16; };
  const int left = size, right = 3 * size, bottom = size, top = 3 * size;
  double flux = 0;  // of momentum along x, outwards, per density
  for (const int i : {left, right})
    for (int j = bottom; j < top; ++j) {
      const double pressure = pascals * between(phi(i - 2, j), phi(i - 1, j), phi(i, j), phi(i + 1, j));
      const double stretching = (8 * (u(i + 1, j) - u(i - 1, j)) - (u(i + 2, j) - u(i - 2, j))) / (12 * h);
      const double here = u(i, j);
      flux += (i == left ? -h : h) * (here * here + pressure - 2 * viscosity * stretching);
    }
  for (const int j : {bottom, top})
    for (int i = left; i < right; ++i) {
      const auto along = [&](int k) { return between(u(k, j - 2), u(k, j - 1), u(k, j), u(k, j + 1)); };
      const double shear = (0.5 * ((u(i, j) - u(i, j - 1)) + (u(i + 1, j) - u(i + 1, j - 1))) +
                            0.5 * (v(i + 1, j) - v(i - 1, j))) /
                           h;
      flux += (j == bottom ? -h : h) * (0.5 * (along(i) + along(i + 1)) * v(i, j) - viscosity * shear);
    }
  return -flux;  // the density is 1
}

StudyOutcome measureSteady(const SceneDocument& scene, int threads) {
  constexpr double kSpeed = 0.2, kDrag = 5.57953523384, kLift = 0.010618948146;
  World world(scene, {.threads = threads, .figures = true});
  while (world.stepCount() < world.spec().time.steps) world.step();
  const Vec2 force = world.figures().bodies.at(0).force;
  const double drag = coefficient(force.x, kSpeed), lift = coefficient(force.y, kSpeed);
  const int size = static_cast<int>(std::lround(kDiameter / world.spec().domain.grid.h));
  const double lost = coefficient(momentumLost(world, size), kSpeed);
  return {{{"drag", drag, kDrag, std::fabs(drag / kDrag - 1)},
           {"drag by the momentum lost", lost, kDrag, std::fabs(lost / kDrag - 1)},
           {"lift", lift, kLift, std::fabs(lift / kLift - 1)}},
          world.stepCount()};
}

/// The largest value, by the parabola through it and its neighbours.
double crest(const std::vector<double>& values) {
  const auto top = std::max_element(values.begin(), values.end());
  if (top == values.begin() || top == values.end() - 1) return *top;
  const double before = top[-1], after = top[1], bend = before - 2 * *top + after;
  return bend < 0 ? *top - (after - before) * (after - before) / (8 * bend) : *top;
}

StudyOutcome measureShedding(const SceneDocument& scene, int threads) {
  constexpr double kSpeed = 1, kDrag = 3.22739, kLift = 0.98658, kStrouhal = 0.30184;
  constexpr double kWindow = 2;  // s, six periods
  World world(scene, {.threads = threads, .figures = true});
  const TimeSpec time = world.spec().time;
  std::vector<double> drag, lift;
  while (world.stepCount() < time.steps) {
    world.step();
    if (world.time() < time.duration - kWindow) continue;
    const Vec2 force = world.figures().bodies.at(0).force;
    drag.push_back(coefficient(force.x, kSpeed));
    lift.push_back(coefficient(force.y, kSpeed));
  }
  std::vector<double> rises;  // where the lift goes up through 0, in steps
  for (std::size_t k = 1; k < lift.size(); ++k)
    if (lift[k - 1] < 0 && lift[k] >= 0)
      rises.push_back(static_cast<double>(k) - lift[k] / (lift[k] - lift[k - 1]));
  const double periods = static_cast<double>(rises.size()) - 1;
  const double strouhal =
      periods < 1 ? 0 : periods / ((rises.back() - rises.front()) * time.step) * kDiameter / kSpeed;
  const double mostDrag = crest(drag), mostLift = crest(lift);
  return {{{"largest drag", mostDrag, kDrag, std::fabs(mostDrag / kDrag - 1)},
           {"largest lift", mostLift, kLift, std::fabs(mostLift / kLift - 1)},
           {"Strouhal number", strouhal, kStrouhal, std::fabs(strouhal / kStrouhal - 1)}},
          world.stepCount()};
}

}  // namespace

Study steadyCylinder() {
  return {"steady-cylinder",
          "flow past a cylinder in a channel, Re 20 (DFG 2D-1); size: cells along the diameter",
          "Schaefer and Turek 1996; drag and lift by Nabh's spectral computation (1998)",
          {10, 20, 40},
          [](int size) { return channel(size, "0.3", "0", 6, 5 * size); },
          measureSteady};
}

Study sheddingCylinder() {
  // The start's push across the wake saves the time that the vortex street takes to wake up.
  return {"shedding-cylinder",
          "vortices shed by a cylinder in a channel, Re 100 (DFG 2D-2); size: cells along the diameter",
          "Schaefer and Turek 1996; values of FeatFlow at its finest level (2014)",
          {10, 20, 30, 40},
          [](int size) { return channel(size, "1.5", "0.5*exp(-200*((x-0.35)^2+(y-0.2)^2))", 6, 20 * size); },
          measureShedding};
}

}  // namespace smokebox
