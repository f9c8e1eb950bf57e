// Potential flow past a disk with slip. The start is uniform, the exact flow is given on all four sides: the
// first projection alone has to bend the flow around the disk. A short run then shows whether carrying it
// along the wall keeps it.
#include <cmath>
#include <string>

#include "study/cases.h"
#include "world/world.h"

namespace smokebox {

namespace {

constexpr double kRadius = 0.4;
constexpr Vec2 kCentre{1.013, 0.987};

Vec2 exactAt(Vec2 p) {
  const Vec2 r = p - kCentre;
  const double rr = dot(r, r), scale = kRadius * kRadius / (rr * rr);
  return {1 - scale * (r.x * r.x - r.y * r.y), -2 * scale * r.x * r.y};
}

std::string sceneOf(int size) {
  const std::string x = "(x-1.013)", y = "(y-0.987)", rr = "(" + x + "^2+" + y + "^2)^2";
  const std::string inflow =
      "{inflow: [\"1-0.16*(" + x + "^2-" + y + "^2)/" + rr + "\", \"-0.32*" + x + "*" + y + "/" + rr + "\"]}";
  return "domain: {size: [2, 2], resolution: " + std::to_string(size) + "}\nwalls: {left: " + inflow +
         ", right: " + inflow + ", bottom: " + inflow + ", top: " + inflow +
         "}\nfluid: {velocity: [1, 0]}\ntime: {step: 1/" + std::to_string(size) +
         ", duration: 1}\noutput: {fps: 1}\nmethod: {tolerance: 1e-6}\n"
         "solids: [{name: disk, shape: {circle: {radius: 0.4}}, position: [1.013, 0.987]}]\n";
}

/// Mean over the fluid of |u - exact| on both kinds of faces, each where the open part of it has its middle.
double meanError(const World& world) {
  const Grid& grid = world.spec().domain.grid;
  const Boundary& boundary = world.boundary();
  const Fluid& fluid = *world.fluid();
  double sum = 0, area = 0;
  auto add = [&](double open, Vec2 centre, Vec2 along, double value) {
    if (open <= 0) return;
    // What is closed lies on the disk's side of the face.
    const Vec2 away = centre - kCentre;
    const double side = dot(away, along) > 0 ? 1 : -1;
    const Vec2 exact = exactAt(centre + 0.5 * (1 - open) * grid.h * side * along);
    sum += open * std::fabs(value - (along.x == 0 ? exact.x : exact.y));
    area += open;
  };
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      add(boundary.openX(i, j), grid.xFaceCentre(i, j), {0, 1}, fluid.u()(i, j));
      add(boundary.openY(i, j), grid.yFaceCentre(i, j), {1, 0}, fluid.v()(i, j));
    }
  return sum / area;
}

StudyOutcome measure(const SceneDocument& scene, int threads) {
  World world(scene, {.threads = threads});
  const double projected = meanError(world);
  while (world.stepCount() < world.spec().time.steps) world.step();
  const double carried = meanError(world);
  return {{{"mean error after one projection", projected, 0, projected},
           {"mean error after a second", carried, 0, carried}},
          world.stepCount()};
}

}  // namespace

Study potentialDisk() {
  return {"potential-disk", "potential flow past a disk with slip; size: cells along a side (5 radii)",
          "exact",          {32, 64, 128, 256},
          sceneOf,          measure};
}

}  // namespace smokebox
