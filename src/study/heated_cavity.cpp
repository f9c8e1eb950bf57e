// The heated cavity: a square box with a hot wall on the left and a cold one on the right, whose fluid rises
// and sinks along them, steady up to a Rayleigh number of 1e5 and more.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "study/cases.h"
#include "world/world.h"

namespace smokebox {

namespace {

constexpr double kPrandtl = 0.71;

struct HeatedTruth {
  const char* name;
  double rayleigh;
  double nusselt, umax, vmax;  // velocities in units of diffusivity / width
};

// The case and its first solution: de Vahl Davis (Int. J. Numer. Methods Fluids 3, 1983), good to 1%. These
// numbers: a steady solution in stream function and vorticity on stretched grids of 65 x 65 to 129 x 129,
// extrapolated, to 2e-5 (Ra 1e5: 1e-4) and within what de Vahl Davis says of his own.
constexpr HeatedTruth kTruths[] = {{"1e3", 1e3, 1.11779, 3.6494, 3.6974},
                                   {"1e4", 1e4, 2.24480, 16.1834, 19.6282},
                                   {"1e5", 1e5, 4.5216, 34.743, 68.637}};

constexpr double kLongest = 400;          // s
constexpr double kStillPerSecond = 2e-6;  // change of temperature and velocity, at which the flow is steady

std::string sceneOf(const HeatedTruth& truth, int size) {
  // Gravity, expansion, width and difference of the temperatures are 1.
  const std::string ra = truth.name, pr = std::to_string(kPrandtl);
  return "domain: {size: [1, 1], resolution: " + std::to_string(size) +
         "}\nwalls: {left: no-slip, right: no-slip, bottom: no-slip, top: no-slip}\ngravity: [0, -1]\n"
         "fluid: {viscosity: sqrt(" +
         pr + "/" + ra + ")}\ntemperature: {diffusivity: 1/sqrt(" + pr + "*" + ra +
         "), expansion: 1, start: 0.5, walls: {left: 1, right: 0}}\noutput: {fps: 1}\n"
         "time: {duration: " +
         std::to_string(static_cast<int>(kLongest)) + ", step: 2/" + std::to_string(size) + "}\n";
}

/// Height of the parabola through the largest sample and its neighbours.
double peakOf(const std::vector<double>& samples) {
  const auto top = std::max_element(samples.begin() + 1, samples.end() - 1);
  const double before = top[-1], here = top[0], after = top[1], bend = before - 2 * here + after;
  return bend < 0 ? here - (after - before) * (after - before) / (8 * bend) : here;
}

StudyOutcome measure(const HeatedTruth& truth, const SceneDocument& scene, int threads) {
  World world(scene, {.threads = threads});
  const Grid& grid = world.spec().domain.grid;
  const Fluid& fluid = *world.fluid();
  const HeatStage& heat = *world.heat();
  const long perSecond = std::lround(1 / world.spec().time.step);
  Field v = fluid.v(), t = heat.heat().value();
  double change = 1;
  while (world.stepCount() < world.spec().time.steps && change > kStillPerSecond) {
    for (long k = 0; k < perSecond && world.stepCount() < world.spec().time.steps; ++k) world.step();
    change = 0;
    for (int j = 0; j < grid.ny; ++j)
      for (int i = 0; i < grid.nx; ++i)
        change = std::max({change, std::fabs(static_cast<double>(fluid.v()(i, j)) - v(i, j)),
                           std::fabs(static_cast<double>(heat.heat().value()(i, j)) - t(i, j))});
    v = fluid.v();
    t = heat.heat().value();
  }
  // Through the walls, by the parabola through the wall's temperature and the two nearest cells.
  double hot = 0, cold = 0;
  for (int j = 0; j < grid.ny; ++j) {
    const int last = grid.nx - 1;
    hot += (8 - 9 * heat.at(0, j) + heat.at(1, j)) / 3;
    cold += (9 * heat.at(last, j) - heat.at(last - 1, j)) / 3;
  }
  const double unit = std::sqrt(kPrandtl * truth.rayleigh);  // of the velocity
  std::vector<double> alongY(grid.ny), alongX(grid.nx);
  for (int k = 0; k < grid.ny; ++k) {
    alongY[k] = unit * 0.5 * (fluid.u()(grid.nx / 2, k) + fluid.u()((grid.nx + 1) / 2, k));
    alongX[k] = unit * 0.5 * (fluid.v()(k, grid.ny / 2) + fluid.v()(k, (grid.ny + 1) / 2));
  }
  auto metric = [](const char* name, double value, double reference) {
    return StudyMetric{name, value, reference, std::fabs(value / reference - 1)};
  };
  const double balance = std::fabs(hot - cold) / hot;
  return {{metric("Nusselt number", hot, truth.nusselt),
           metric("umax", peakOf(alongY), truth.umax),
           metric("vmax", peakOf(alongX), truth.vmax),
           {"heat balance", balance, 0, balance},
           {"change in the last second", change, 0, change}},
          world.stepCount()};
}

}  // namespace

std::vector<Study> heatedCavities() {
  std::vector<Study> cases;
  for (const HeatedTruth& truth : kTruths)
    cases.push_back(
        {"heated-cavity-ra" + std::string(truth.name),
         "heated cavity, Prandtl number 0.71: heat through the walls, largest velocities; size: cells along "
         "a "
         "side",
         "steady solution of this project, which agrees with de Vahl Davis 1983",
         {32, 64, 128},
         [&truth](int size) { return sceneOf(truth, size); },
         [&truth](const SceneDocument& scene, int threads) { return measure(truth, scene, threads); }});
  return cases;
}

}  // namespace smokebox
