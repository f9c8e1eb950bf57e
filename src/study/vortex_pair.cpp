// Two Taylor vortices that are just far enough from each other to part: a scheme that loses energy lets them
// merge (McKenzie 2007; Zehnder, Narain, Thomaszewski 2018).
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/maths.h"
#include "study/cases.h"
#include "world/world.h"

namespace smokebox {

namespace {

// A pseudo-spectral solution with 512 x 512 points, Runge-Kutta of order 4, at 7.5 s.
constexpr double kDistance = 2.66;
constexpr double kSmoothing = 0.08;  // m, of the Gaussian through which the centres are looked for

std::string sceneOf(int size) {
  // 300 steps of 0.025 s with 256 cells.
  const std::string vortex = "exp(0.5 - 0.5*((x - CX)^2 + (y - pi)^2)/0.09)";
  auto at = [&](const char* x) {
    std::string text = vortex;
    return text.replace(text.find("CX"), 2, x);
  };
  const std::string left = at("(pi - 0.405)"), right = at("(pi + 0.405)");
  return "domain: {size: [2*pi, 2*pi], resolution: " + std::to_string(size) + R"yaml(}
walls: {left: periodic, right: periodic, bottom: periodic, top: periodic}
fluid: {velocity: ["-(y - pi)/0.3*()yaml" +
         left + " + " + right + ")\", \"(x - pi + 0.405)/0.3*" + left + " + (x - pi - 0.405)/0.3*" + right +
         "\"]}\noutput: {fps: 1}\ntime: {duration: 7.5, step: 6.4/" + std::to_string(size) + "}\n";
}

/// Vorticity at the nodes of a periodic grid, smoothed.
std::vector<double> smoothVorticity(const Fluid& fluid, const Grid& grid) {
  const int n = grid.nx;
  auto wrap = [n](int i) { return (i % n + n) % n; };
  std::vector<double> curl(grid.cells()), half(grid.cells());
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      curl[j * n + i] =
          (fluid.v()(i, j) - fluid.v()(wrap(i - 1), j) - fluid.u()(i, j) + fluid.u()(i, wrap(j - 1))) /
          grid.h;
  const int reach = static_cast<int>(std::ceil(4 * kSmoothing / grid.h));
  std::vector<double> weight;
  double total = 0;
  for (int k = -reach; k <= reach; ++k) {
    weight.push_back(std::exp(-0.5 * std::pow(k * grid.h / kSmoothing, 2)));
    total += weight.back();
  }
  auto smooth = [&](const std::vector<double>& from, std::vector<double>& to, bool alongX) {
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        double sum = 0;
        for (int k = -reach; k <= reach; ++k)
          sum += weight[k + reach] * (alongX ? from[j * n + wrap(i + k)] : from[wrap(j + k) * n + i]);
        to[j * n + i] = sum / total;
      }
  };
  smooth(curl, half, true);
  smooth(half, curl, false);
  return curl;
}

/// Between the two highest peaks that reach half of the highest; 0 if there is one only.
double distanceOfPeaks(const std::vector<double>& w, const Grid& grid) {
  const int n = grid.nx;
  auto at = [&](int i, int j) { return w[(j + n) % n * n + (i + n) % n]; };
  struct Peak {
    Vec2 at;
    double height;
  };
  std::vector<Peak> peaks;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      bool highest = true;
      for (int b = -1; b <= 1 && highest; ++b)
        for (int a = -1; a <= 1 && highest; ++a) highest = (a == 0 && b == 0) || at(i, j) > at(i + a, j + b);
      if (!highest) continue;
      auto offset = [](double before, double here, double after) {  // of the parabola through the three
        return 0.5 * (before - after) / (before - 2 * here + after);
      };
      const double x = i + offset(at(i - 1, j), at(i, j), at(i + 1, j)),
                   y = j + offset(at(i, j - 1), at(i, j), at(i, j + 1));
      peaks.push_back({grid.h * Vec2{x, y}, at(i, j)});
    }
  std::sort(peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) { return a.height > b.height; });
  if (peaks.size() < 2 || peaks[1].height < 0.5 * peaks[0].height) return 0;
  return length(peaks[1].at - peaks[0].at);
}

StudyOutcome measure(const SceneDocument& scene, int threads) {
  World world(scene, {.threads = threads, .figures = true});
  const double before = world.figures().energyFluid;
  while (world.stepCount() < world.spec().time.steps) world.step();
  const double kept = world.figures().energyFluid / before;
  const Grid& grid = world.spec().domain.grid;
  const double distance = distanceOfPeaks(smoothVorticity(*world.fluid(), grid), grid);
  return {{{"energy kept", kept, 1, std::fabs(kept - 1)},
           {"distance", distance, kDistance, std::fabs(distance / kDistance - 1)}},
          world.stepCount()};
}

}  // namespace

Study vortexPair() {
  return {"vortex-pair",
          "two Taylor vortices that must part within 7.5 s; size: cells along a side of 2 pi m",
          "inviscid: energy is kept; distance: pseudo-spectral solution, 512 x 512, this project",
          {64, 128, 256},
          sceneOf,
          measure};
}

}  // namespace smokebox
