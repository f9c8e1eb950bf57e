// The cases with known answers that the chart runs, held against their limits.
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "study/study.h"
#include "world/world.h"

namespace smokebox {
namespace {

/// Runs a case at each size and prints what it measured.
std::vector<double> errorsOf(const std::string& name, const std::string& metric,
                             const std::vector<int>& sizes) {
  std::vector<double> errors;
  for (const int size : sizes) {
    const StudyOutcome outcome = runStudy(studyNamed(name), size);
    errors.push_back(outcome.metric(metric).error);
    std::printf("%s, %d: %s %.6g, error %.3e (%ld steps, %.2f s)\n", name.c_str(), size, metric.c_str(),
                outcome.metric(metric).value, errors.back(), outcome.steps, outcome.processorSeconds);
  }
  return errors;
}

/// Runs a case at one size and prints what it measured.
StudyOutcome outcomeOf(const std::string& name, int size) {
  const StudyOutcome outcome = runStudy(studyNamed(name), size);
  std::printf("%s, %d (%ld steps, %.2f s):\n", name.c_str(), size, outcome.steps, outcome.processorSeconds);
  for (const StudyMetric& m : outcome.metrics)
    std::printf("  %s %.6g, error %.3e\n", m.name.c_str(), m.value, m.error);
  return outcome;
}

/// A row of tests/data/cavity_plain_mac.csv: rms and max of u, then of v.
std::array<double, 4> plainMacErrors(int cells, int reynolds) {
  std::ifstream file(std::string(SMOKEBOX_SOURCE_DIR) + "/tests/data/cavity_plain_mac.csv");
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    for (char& c : line)
      if (c == ',') c = ' ';
    std::istringstream words(line);
    int n = 0, re = 0;
    std::array<double, 4> errors{};
    words >> n >> re >> errors[0] >> errors[1] >> errors[2] >> errors[3];
    if (words && n == cells && re == reynolds) return errors;
  }
  ADD_FAILURE() << "no row for " << cells << " cells at Re " << reynolds;
  return {};
}

/// Each of the four errors is at most this share of the plain method's.
void expectBetterThanPlainMac(int cells, int reynolds, double share) {
  const StudyOutcome outcome = outcomeOf("cavity-re" + std::to_string(reynolds), cells);
  const std::array<double, 4> plain = plainMacErrors(cells, reynolds);
  const char* names[] = {"rms error of u", "max error of u", "rms error of v", "max error of v"};
  for (int k = 0; k < 4; ++k) {
    const double error = outcome.metric(names[k]).error;
    std::printf("  %s: %.2f of the plain method's\n", names[k], error / plain[k]);
    EXPECT_LT(error, share * plain[k]) << names[k];
  }
}

TEST(Study, DriftingVorticesKeepTheirShapeWithHighOrder) {
  // Truth: the flow moves without change; the error falls with an order of 2.5 at least.
  const std::vector<int> sizes = {32, 64, 128};
  const std::vector<double> errors = errorsOf("drifting-vortices", "max error of the velocity", sizes);
  EXPECT_LT(errors[1], 1e-3);
  EXPECT_LT(errors[2], 2e-4);
  EXPECT_GT(fittedOrder(sizes, errors), 2.5);
}

TEST(Study, TwoVorticesPartAndKeepTheirEnergy) {
  // Truth: without friction the energy is kept; a spectral solution has the vortices 2.66 m apart at 7.5 s.
  const StudyOutcome outcome = outcomeOf("vortex-pair", 256);
  EXPECT_GT(outcome.metric("energy kept").value, 0.9993);
  EXPECT_LT(outcome.metric("energy kept").value, 1.0000001);
  EXPECT_LT(outcome.metric("distance").error, 0.005);
}

TEST(Study, CavitiesOf64CellsBeatAPlainMethod) {
  // Truth: the steady profiles; a plain second-order method's errors are in a table. The lid's corners, where
  // the velocity jumps, hold the error up at Re 100.
  expectBetterThanPlainMac(64, 100, 0.75);
  expectBetterThanPlainMac(64, 400, 0.5);
}

TEST(StudySlow, CavitiesBeatAPlainMethod) {
  // Truth: as above.
  expectBetterThanPlainMac(64, 1000, 0.5);
  expectBetterThanPlainMac(128, 100, 0.9);
  expectBetterThanPlainMac(128, 400, 0.7);
  expectBetterThanPlainMac(128, 1000, 0.65);
}

TEST(Study, APushedChannelHasItsParabola) {
  // Truth: a/(2 nu) y (1 - y) with 16 cells across, to rounding: the scheme is exact for parabolas at walls
  // too.
  World world(SceneDocument::parse(R"yaml(
domain: {size: [0.5, 1], resolution: 8}
walls: {left: periodic, right: periodic, bottom: no-slip, top: no-slip}
fluid: {viscosity: 0.1}
events: [{at: 0, force: {box: {size: [2, 3]}, acceleration: [1, 0], for: 100}}]
output: {fps: 1}
time: {duration: 20, step: 1/50}
)yaml",
                                   "channel.yaml"),
              {});
  while (world.stepCount() < world.spec().time.steps) world.step();
  for (int j = 0; j < 16; ++j) {
    const double y = (j + 0.5) / 16;
    EXPECT_NEAR(world.fluid()->u()(3, j), 5 * y * (1 - y), 2e-5);
  }
}

TEST(Study, FluidAtRestStaysThere) {
  // Truth: the speed stays 0. Smoke that weighs as much as gravity can make it is carried by the pressure, to
  // its tolerance.
  EXPECT_EQ(outcomeOf("rest", 64).metrics[0].value, 0);
  EXPECT_LT(outcomeOf("rest-heavy-smoke", 64).metrics[0].value, 1e-4);
}

TEST(Study, AMirroredFlowWithSmokeStaysAlike) {
  // Truth: both halves are mirror images; a plume against a disk makes any difference grow, and after 200
  // steps there is none.
  for (const char* name : {"mirror-left-right", "mirror-up-down"})
    for (const int size : {64, 100}) {
      const StudyOutcome outcome = outcomeOf(name, size);
      EXPECT_GT(outcome.metric("largest speed").value, 1) << name;
      EXPECT_EQ(outcome.metric("asymmetry of the velocity").value, 0) << name;
      EXPECT_EQ(outcome.metric("asymmetry of the smoke").value, 0) << name;
    }
}

TEST(Study, HeatedCavitiesOf64CellsAreRight) {
  // Truth: the Nusselt number and the largest velocities within half of a per cent, at Ra 1e5 of one.
  for (const char* name : {"heated-cavity-ra1e3", "heated-cavity-ra1e4", "heated-cavity-ra1e5"}) {
    const StudyOutcome outcome = outcomeOf(name, 64);
    const double most = std::string(name).ends_with("1e5") ? 0.01 : 0.005;
    for (const char* metric : {"Nusselt number", "umax", "vmax"})
      EXPECT_LT(outcome.metric(metric).error, most) << metric;
    EXPECT_LT(outcome.metric("heat balance").error, 2e-5);
  }
}

TEST(Study, AnOrderIsFittedExactlyToAPowerLaw) {
  // Truth: errors of 3 n^-2 have the order 2.
  EXPECT_NEAR(fittedOrder({8, 16, 64}, {3.0 / 64, 3.0 / 256, 3.0 / 4096}), 2, 1e-12);
}

}  // namespace
}  // namespace smokebox
