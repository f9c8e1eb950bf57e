// Steps far from the Courant number that a scheme likes, grids from coarse to fine, long domains.
#include "stable_run.h"

namespace smokebox {
namespace {

using test::runStably;
using test::StableRun;

/// One step a frame, whatever it is: fps must be a whole number, so the step is 1 / fps.
std::string withStep(const std::string& head, int stepsASecond) {
  return head + "\ntime: {duration: 1000, step: 1/" + std::to_string(stepsASecond) + "}\noutput: {fps: 1}\n";
}

constexpr const char* kFlow =
    "fluid: {density: 1, velocity: [\"sin(2*pi*x)*cos(2*pi*y)\", \"-cos(2*pi*x)*sin(2*pi*y)\"]}";
constexpr const char* kPeriodic = "walls: {left: periodic, right: periodic, bottom: periodic, top: periodic}";
constexpr double kEnergy = 0.25;  // of that flow, J per metre of depth

class StepSize : public testing::TestWithParam<double> {};

TEST_P(StepSize, EnergyOfAFreeFlowNeverGrows) {
  // Truth: without forces the kinetic energy is constant; no scheme may add to it, whatever the step.
  const int cells = 64;
  const int stepsASecond = std::max(1, static_cast<int>(std::lround(2 * cells / GetParam())));
  for (const char* walls : {kPeriodic, "walls: {}"}) {
    const std::string head =
        "domain: {size: [1, 1], resolution: " + std::to_string(cells) + "}\n" + walls + "\n" + kFlow;
    const StableRun run = runStably(withStep(head, stepsASecond), 60, 1.002 * kEnergy);
    EXPECT_GT(run.energyEnd, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Courant, StepSize, testing::Values(0.14, 0.7, 1.4, 2.8, 5.6, 7.0, 14.0, 28.0, 70.0));

class PlumeStep : public testing::TestWithParam<double> {};

TEST_P(PlumeStep, APlumePastADiskKeepsItsSmoke) {
  // Truth: smoke is neither lost nor made, and its energy stays below what falling from the whole height
  // would give all of it.
  const int cells = 64;
  const int stepsASecond = std::max(1, static_cast<int>(std::lround(cells / GetParam())));
  const std::string head = "domain: {size: [1, 1], resolution: " + std::to_string(cells) + R"yaml(}
walls: {top: open}
gravity: [0, -9.81]
fluid: {vorticity: 0.3, density: 1}
smoke:
  buoyancy: 1
  sources: [{shape: {circle: {center: [0.5, 0.15], radius: 0.06}}, rate: 2, until: 1}]
solids: [{name: disk, shape: {circle: {radius: 0.12}}, position: [0.52, 0.5]}])yaml";
  runStably(withStep(head, stepsASecond), 80, 10);
}

INSTANTIATE_TEST_SUITE_P(Courant, PlumeStep, testing::Values(0.1, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 64.0));

class Resolution : public testing::TestWithParam<int> {};

TEST_P(Resolution, AWakeStaysBounded) {
  // Truth: at any resolution the energy stays near that of the stream, 1/2 rho U^2 over the area.
  const int cells = GetParam();
  const std::string head = "domain: {size: [2, 1], resolution: " + std::to_string(cells) + R"yaml(}
walls: {left: {inflow: [1, 0]}, right: open}
fluid: {density: 1, velocity: ["1", "0.1*sin(pi*x)"]
}
smoke: {sources: [{shape: {circle: {center: [0.2, 0.5], radius: 0.1}}, rate: 2}]}
solids: [{name: disk, shape: {circle: {radius: 0.15}}, position: [0.7, 0.52], drag: 1}])yaml";
  runStably(withStep(head, 60), cells > 500 ? 10 : 60, 3);
}

INSTANTIATE_TEST_SUITE_P(Cells, Resolution, testing::Values(16, 18, 34, 64, 130, 256, 1024));

TEST(LongDomain, FiftyTimesLongerThanHighConverges) {
  // Truth: a channel of 50 : 1, along x and along y, with an obstacle, projects to the tolerance each step.
  for (const bool upright : {false, true}) {
    const std::string head = upright ? R"yaml(domain: {size: [0.2, 10], resolution: 16}
walls: {bottom: {inflow: [0, 1]}, top: open, left: no-slip, right: no-slip}
fluid: {density: 1, viscosity: 1e-3, velocity: ["0", "1"]}
solids: [{name: post, shape: {circle: {radius: 0.04}}, position: [0.1, 2]}])yaml"
                                     : R"yaml(domain: {size: [10, 0.2], resolution: 800}
walls: {left: {inflow: [1, 0]}, right: open, bottom: no-slip, top: no-slip}
fluid: {density: 1, viscosity: 1e-3, velocity: ["1", "0"]}
solids: [{name: post, shape: {circle: {radius: 0.04}}, position: [2, 0.1]}])yaml";
    runStably(withStep(head, 100), 60, 10);
  }
}

TEST(LongDomain, AClosedOneToo) {
  // Truth: the hardest case for a pressure solve: closed, 50 : 1, stirred at one end.
  const std::string head = R"yaml(domain: {size: [10, 0.2], resolution: 800}
fluid: {density: 1}
events: [{at: 0, force: {circle: {center: [0.3, 0.1], radius: 0.08}, acceleration: [3, 1], for: 0.3}}])yaml";
  runStably(withStep(head, 60), 60, 1);
}

}  // namespace
}  // namespace smokebox
