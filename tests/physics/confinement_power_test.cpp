// Vorticity confinement through a whole world: the power that it adds to a flow whose power is known.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "world/world.h"

namespace smokebox {
namespace {

constexpr double kStrength = 0.3, kLength = 1.0 / 256;  // of a domain whose shorter side is 1 m

/// The flow with a given strength at the start, in a periodic box of 2 m x 1 m; the fluid weighs 1 kg/m^2.
World worldOf(int resolution, double strength) {
  const std::string text = "domain: {size: [2, 1], resolution: " + std::to_string(resolution) +
                           "}\n"
                           "walls: {left: periodic, right: periodic, bottom: periodic, top: periodic}\n"
                           "time: {step: 1/3000, duration: 1/30}\n"
                           "fluid: {density: 1, vorticity: " +
                           std::to_string(strength) +
                           ", velocity: [\n"
                           "  'sin(2*pi*x)*cos(2*pi*y) + 0.3*cos(2*pi*y + pi*x)',\n"
                           "  '-cos(2*pi*x)*sin(2*pi*y) - 0.15*cos(2*pi*y + pi*x)']}\n";
  return World(SceneDocument::parse(text, "t.yaml"), {.threads = 2, .figures = true});
}

/// The integral of e L (N x w).u over the box, from the formulas of the same flow: N = grad|w| / |grad|w||,
/// and N x w = w (N_y, -N_x). W.
double truePower() {
  constexpr int kPoints = 400;  // along a metre; twice as many change it by 2e-6 of itself
  double sum = 0;
  for (int j = 0; j < kPoints; ++j)
    for (int i = 0; i < 2 * kPoints; ++i) {
      const double a = 2 * M_PI * (i + 0.5) / kPoints, b = 2 * M_PI * (j + 0.5) / kPoints, c = b + 0.5 * a;
      const double u = std::sin(a) * std::cos(b) + 0.3 * std::cos(c);
      const double v = -std::cos(a) * std::sin(b) - 0.15 * std::cos(c);
      const double w = M_PI * (4 * std::sin(a) * std::sin(b) + 0.75 * std::sin(c));
      const double slopeX = M_PI * M_PI * (8 * std::cos(a) * std::sin(b) + 0.75 * std::cos(c));
      const double slopeY = M_PI * M_PI * (8 * std::sin(a) * std::cos(b) + 1.5 * std::cos(c));
      sum += std::fabs(w) * (slopeY * u - slopeX * v) / std::hypot(slopeX, slopeY);
    }
  return kStrength * kLength * sum / (kPoints * kPoints);
}

TEST(ConfinementPower, IsTheIntegralOfItsForceAtEveryResolution) {
  // Truth: what the kinetic energy has more than without confinement, over the time, is the integral of
  // e L (N x w).u; it does not depend on the resolution.
  const double truth = truePower();
  std::vector<double> errors;
  for (const int resolution : {64, 128, 256, 512}) {
    World with = worldOf(resolution, kStrength), without = worldOf(resolution, 0);
    for (int k = 0; k < 4; ++k) {
      with.step();
      without.step();
    }
    const double power = (with.figures().energyFluid - without.figures().energyFluid) / with.time();
    errors.push_back(power / truth - 1);
    std::printf("Confinement: power at %d cells %.5e W, true %.5e W, %+.3f%%\n", resolution, power, truth,
                100 * errors.back());
  }
  EXPECT_LT(std::fabs(errors[0]), 0.01);
  EXPECT_LT(std::fabs(errors[1]), 0.4 * std::fabs(errors[0]));
  EXPECT_LT(std::fabs(errors[2]), 0.4 * std::fabs(errors[1]));
  // Not below: where the slope of |w| is under a thousandth of its largest, the force fades.
  EXPECT_LT(std::fabs(errors[3]), 5e-4);
}

}  // namespace
}  // namespace smokebox
