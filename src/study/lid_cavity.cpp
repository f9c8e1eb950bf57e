// The lid-driven cavity: the steady flow in a square box whose lid slides at 1 m/s, held against the profiles
// along both centre lines.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "study/cases.h"
#include "world/world.h"

namespace smokebox {

namespace {

struct ProfilePoint {
  double place, value;  // m, m/s
};
struct CavityTruth {
  int reynolds;
  std::array<ProfilePoint, 15> u, v;  // u along x = 0.5, v along y = 0.5
};

// At the interior points of Ghia, Ghia and Shin (J. Comput. Phys. 48, 1982, tables I and II), but not their
// values, which are off by up to 0.02 at Re 1000: a steady solution in stream function and vorticity on
// stretched grids of 193 x 193 and 257 x 257, extrapolated (to 1e-5), which has the extrema of Botella and
// Peyret (Computers and Fluids 27, 1998) to 2e-6.
constexpr CavityTruth kTruths[] = {
    {100,
     {{{0.0547, -0.037228},
       {0.0625, -0.041975},
       {0.0703, -0.04662},
       {0.1016, -0.064431},
       {0.1719, -0.101742},
       {0.2813, -0.157673},
       {0.4531, -0.213978},
       {0.5, -0.209149},
       {0.6172, -0.138798},
       {0.7344, 0.004187},
       {0.8516, 0.236552},
       {0.9531, 0.691028},
       {0.9609, 0.74047},
       {0.9688, 0.791939},
       {0.9766, 0.843733}}},
     {{{0.0625, 0.094808},
       {0.0703, 0.103585},
       {0.0781, 0.111752},
       {0.0938, 0.126428},
       {0.1563, 0.164824},
       {0.2266, 0.179357},
       {0.2344, 0.17956},
       {0.5, 0.057537},
       {0.8047, -0.253543},
       {0.8594, -0.233692},
       {0.9063, -0.17708},
       {0.9453, -0.108533},
       {0.9531, -0.093388},
       {0.9609, -0.077976},
       {0.9688, -0.062192}}}},
    {400,
     {{{0.0547, -0.081822},
       {0.0625, -0.092599},
       {0.0703, -0.1033},
       {0.1016, -0.14619},
       {0.1719, -0.243779},
       {0.2813, -0.328719},
       {0.4531, -0.171482},
       {0.5, -0.115053},
       {0.6172, 0.021034},
       {0.7344, 0.162567},
       {0.8516, 0.292033},
       {0.9531, 0.561566},
       {0.9609, 0.619915},
       {0.9688, 0.687206},
       {0.9766, 0.760672}}},
     {{{0.0625, 0.185132},
       {0.0703, 0.198788},
       {0.0781, 0.210964},
       {0.0938, 0.231721},
       {0.1563, 0.283543},
       {0.2266, 0.303826},
       {0.2344, 0.303447},
       {0.5, 0.052058},
       {0.8047, -0.385657},
       {0.8594, -0.453837},
       {0.9063, -0.389686},
       {0.9453, -0.234722},
       {0.9531, -0.198209},
       {0.9609, -0.161587},
       {0.9688, -0.125146}}}},
    {1000,
     {{{0.0547, -0.181286},
       {0.0625, -0.202328},
       {0.0703, -0.222893},
       {0.1016, -0.300454},
       {0.1719, -0.388573},
       {0.2813, -0.280367},
       {0.4531, -0.108199},
       {0.5, -0.062056},
       {0.6172, 0.057018},
       {0.7344, 0.188674},
       {0.8516, 0.33722},
       {0.9531, 0.47233},
       {0.9609, 0.516925},
       {0.9688, 0.580833},
       {0.9766, 0.66442}}},
     {{{0.0625, 0.280703},
       {0.0703, 0.296268},
       {0.0781, 0.309907},
       {0.0938, 0.333042},
       {0.1563, 0.376919},
       {0.2266, 0.333992},
       {0.2344, 0.325358},
       {0.5, 0.0258},
       {0.8047, -0.320213},
       {0.8594, -0.426454},
       {0.9063, -0.526439},
       {0.9453, -0.410374},
       {0.9531, -0.35532},
       {0.9609, -0.293685},
       {0.9688, -0.22792}}}},
};

constexpr double kLongest = 120;          // s
constexpr double kStillPerSecond = 4e-6;  // change of the velocity, m/s, at which the flow counts as steady

std::string sceneOf(int reynolds, int size) {
  // The lid's Courant number is 0.8.
  return "domain: {size: [1, 1], resolution: " + std::to_string(size) +
         "}\nwalls: {left: no-slip, right: no-slip, bottom: no-slip, top: {no-slip: [1, 0]}}\n"
         "fluid: {viscosity: 1/" +
         std::to_string(reynolds) +
         "}\noutput: {fps: 1}\n"
         "time: {duration: " +
         std::to_string(static_cast<int>(kLongest)) + ", step: 1/" +
         std::to_string(static_cast<int>(std::ceil(1.25 * size))) + "}\n";
}

/// Cubic through the four nearest samples of a line; sample k is at (k + 1/2) h.
double alongLine(const std::vector<double>& samples, double h, double place) {
  const int count = static_cast<int>(samples.size());
  const double x = place / h - 0.5;
  const int first = std::clamp(static_cast<int>(std::floor(x)) - 1, 0, count - 4);
  double sum = 0;
  for (int k = first; k < first + 4; ++k) {
    double weight = 1;
    for (int m = first; m < first + 4; ++m)
      if (m != k) weight *= (x - m) / (k - m);
    sum += weight * samples[k];
  }
  return sum;
}

struct Misfit {
  double rms = 0, max = 0;
};
Misfit misfit(const std::vector<double>& samples, double h, const std::array<ProfilePoint, 15>& truth) {
  Misfit m;
  for (const ProfilePoint& point : truth) {
    const double error = std::fabs(alongLine(samples, h, point.place) - point.value);
    m.rms += error * error / static_cast<double>(truth.size());
    m.max = std::max(m.max, error);
  }
  m.rms = std::sqrt(m.rms);
  return m;
}

StudyOutcome measure(const CavityTruth& truth, const SceneDocument& scene, int threads) {
  World world(scene, {.threads = threads});
  const Grid& grid = world.spec().domain.grid;
  const Fluid& fluid = *world.fluid();
  const long perSecond = std::lround(1 / world.spec().time.step);
  Field u = fluid.u(), v = fluid.v();
  double change = 1;
  while (world.stepCount() < world.spec().time.steps && change > kStillPerSecond) {
    for (long k = 0; k < perSecond && world.stepCount() < world.spec().time.steps; ++k) world.step();
    change = 0;
    for (int j = 0; j < grid.ny; ++j)
      for (int i = 0; i < grid.nx; ++i)
        change = std::max({change, std::fabs(static_cast<double>(fluid.u()(i, j)) - u(i, j)),
                           std::fabs(static_cast<double>(fluid.v()(i, j)) - v(i, j))});
    u = fluid.u();
    v = fluid.v();
  }
  std::vector<double> alongY(grid.ny), alongX(grid.nx);
  for (int k = 0; k < grid.ny; ++k) {
    // With an odd number of cells the centre line runs through their middle.
    alongY[k] = 0.5 * (u(grid.nx / 2, k) + u((grid.nx + 1) / 2, k));
    alongX[k] = 0.5 * (v(k, grid.ny / 2) + v(k, (grid.ny + 1) / 2));
  }
  const Misfit a = misfit(alongY, grid.h, truth.u), b = misfit(alongX, grid.h, truth.v);
  return {{{"rms error of u", a.rms, 0, a.rms},
           {"max error of u", a.max, 0, a.max},
           {"rms error of v", b.rms, 0, b.rms},
           {"max error of v", b.max, 0, b.max},
           {"change in the last second", change, 0, change}},
          world.stepCount()};
}

}  // namespace

std::vector<Study> lidDrivenCavities() {
  std::vector<Study> cases;
  for (const CavityTruth& truth : kTruths)
    cases.push_back(
        {"cavity-re" + std::to_string(truth.reynolds),
         "lid-driven cavity, velocities on the centre lines; size: cells along a side",
         "steady solution of this project, which agrees with Botella and Peyret 1998",
         {32, 64, 128},
         [&truth](int size) { return sceneOf(truth.reynolds, size); },
         [&truth](const SceneDocument& scene, int threads) { return measure(truth, scene, threads); }});
  return cases;
}

}  // namespace smokebox
