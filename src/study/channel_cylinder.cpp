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

StudyOutcome measureSteady(const SceneDocument& scene, int threads) {
  constexpr double kSpeed = 0.2, kDrag = 5.57953523384, kLift = 0.010618948146;
  World world(scene, {.threads = threads, .figures = true});
  while (world.stepCount() < world.spec().time.steps) world.step();
  const Vec2 force = world.figures().bodies.at(0).force;
  const double drag = coefficient(force.x, kSpeed), lift = coefficient(force.y, kSpeed);
  return {{{"drag", drag, kDrag, std::fabs(drag / kDrag - 1)},
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
