// Flow between a cylinder that turns and a fixed one around it: torque 4 pi mu Omega / (1/R1^2 - 1/R2^2). The
// fluid's inertia matters (Reynolds number 50 over the gap), so the carried momentum must find its way along
// both walls.
#include <cmath>
#include <cstdio>

#include "base/maths.h"
#include "study/cases.h"
#include "world/world.h"

namespace smokebox {

namespace {

constexpr double kInner = 0.2, kOuter = 0.45, kSpin = 1, kViscosity = 1e-3;  // m, rad/s, m^2/s
constexpr Vec2 kCentre{0.4973, 0.5041};

/// Half of the outer cylinder: a box with a half disk taken out of it, a little more than half so that the
/// two overlap.
std::string shell(const char* name, double from, double side, int corners) {
  std::string points;
  char text[64];
  auto add = [&](double x, double y) {
    std::snprintf(text, sizeof text, "%s[%.9f, %.9f]", points.empty() ? "" : ", ", x, y);
    points += text;
  };
  constexpr double kOverlap = 0.01;
  for (int k = 0; k <= corners; ++k) {
    const double angle = from - kOverlap + (kPi + 2 * kOverlap) * k / corners;
    add(kCentre.x + kOuter * std::cos(angle), kCentre.y + kOuter * std::sin(angle));
  }
  const double turn = from == 0 ? 1 : -1;
  add(kCentre.x - turn * side, kCentre.y - turn * 0.004);
  add(kCentre.x - turn * side, kCentre.y + turn * side);
  add(kCentre.x + turn * side, kCentre.y + turn * side);
  add(kCentre.x + turn * side, kCentre.y - turn * 0.004);
  return std::string("  - {name: ") + name + ", shape: {polygon: [" + points + "]}}\n";
}

std::string sceneOf(int size) {
  const int corners = 24 * size;
  return "domain: {size: [1, 1], resolution: " + std::to_string(4 * size) +
         "}\nfluid: {density: 1, viscosity: 1e-3}\ntime: {step: 1/" + std::to_string(size) +
         ", duration: 60}\noutput: {fps: 1}\nsolids:\n"
         "  - {name: inner, shape: {circle: {radius: 0.2}}, position: [0.4973, 0.5041], motion: {spin: " +
         std::to_string(degrees(kSpin)) + "}, report: true}\n" + shell("upper", 0, 0.6, corners) +
         shell("lower", kPi, 0.6, corners);
}

StudyOutcome measure(const SceneDocument& scene, int threads) {
  World world(scene, {.threads = threads, .figures = true});
  while (world.stepCount() < world.spec().time.steps) world.step();
  const double torque = world.figures().bodies.at(0).torque;
  const double gap = 1 / (kInner * kInner) - 1 / (kOuter * kOuter);
  const double exact = -4 * kPi * kViscosity * kSpin / gap;

  // Mean over the fluid of the error of the velocity, over the speed of the inner cylinder.
  const Grid& grid = world.spec().domain.grid;
  const Boundary& boundary = world.boundary();
  const Fluid& fluid = *world.fluid();
  double sum = 0, area = 0;
  auto add = [&](double open, Vec2 p, double value, bool alongX) {
    const Vec2 r = p - kCentre;
    const double rr = dot(r, r);
    if (open <= 0 || rr < kInner * kInner || rr > kOuter * kOuter) return;
    const Vec2 flow = kSpin / gap * (1 / rr - 1 / (kOuter * kOuter)) * perpendicular(r);
    sum += open * std::fabs(value - (alongX ? flow.x : flow.y));
    area += open;
  };
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i) {
      add(boundary.openX(i, j), grid.xFaceCentre(i, j), fluid.u()(i, j), true);
      add(boundary.openY(i, j), grid.yFaceCentre(i, j), fluid.v()(i, j), false);
    }
  const double error = sum / area / (kSpin * kInner);
  return {{{"torque", torque, exact, std::fabs(torque / exact - 1)},
           {"mean error of the velocity", error, 0, error}},
          world.stepCount()};
}

}  // namespace

Study turningCylinders() {
  return {"turning-cylinders",
          "a cylinder that turns inside a fixed one, Re 50; size: cells across the gap",
          "exact",
          {8, 16, 32},
          sceneOf,
          measure};
}

}  // namespace smokebox
