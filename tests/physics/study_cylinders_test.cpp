// No-slip and slip on curved solids: the cases of the cylinders and the disk, held against their limits.
#include <gtest/gtest.h>

#include <cstdio>

#include "study/study.h"

namespace smokebox {
namespace {

StudyOutcome run(const std::string& name, int size) {
  StudyOutcome outcome = runStudy(studyNamed(name), size);
  std::printf("%s, %d:", name.c_str(), size);
  for (const StudyMetric& metric : outcome.metrics)
    std::printf("  %s %.6g (error %.3e)", metric.name.c_str(), metric.value, metric.error);
  std::printf("  %ld steps, %.1f s\n", outcome.steps, outcome.processorSeconds);
  return outcome;
}

TEST(StudyCylinders, SteadyDragIsThatOfTheBenchmark) {
  // Truth: drag 5.5795 (DFG 2D-1); 1% at 10 and at 20 cells across the cylinder.
  EXPECT_LT(run("steady-cylinder", 10).metric("drag").error, 0.01);
  const StudyOutcome fine = run("steady-cylinder", 20);
  EXPECT_LT(fine.metric("drag").error, 0.01);
  EXPECT_LT(fine.metric("lift").error, 0.06);
}

TEST(StudyCylinders, TheFlowLosesTheMomentumOfTheBenchmark) {
  // Truth: drag 5.5795 (DFG 2D-1), here by the balance of momentum around the cylinder: 0.5% at 10 cells
  // across, 0.2% at 20, to second order.
  const StudyOutcome coarse = run("steady-cylinder", 10), fine = run("steady-cylinder", 20);
  const char* lost = "drag by the momentum lost";
  EXPECT_LT(coarse.metric(lost).error, 0.005);
  EXPECT_LT(fine.metric(lost).error, 0.002);
  EXPECT_GT(fittedOrder({10, 20}, {coarse.metric(lost).error, fine.metric(lost).error}), 1.8);
}

TEST(StudyCylinders, TurningCylindersFeelTheExactTorque) {
  // Truth: 4 pi mu Omega / (1/R1^2 - 1/R2^2), in a flow whose inertia matters; the velocity to second order.
  const StudyOutcome coarse = run("turning-cylinders", 8), fine = run("turning-cylinders", 16);
  EXPECT_LT(coarse.metric("torque").error, 0.035);
  EXPECT_LT(fine.metric("torque").error, 0.003);
  const char* velocity = "mean error of the velocity";
  EXPECT_GT(fittedOrder({8, 16}, {coarse.metric(velocity).error, fine.metric(velocity).error}), 1.7);
}

TEST(StudyCylinders, FlowSlipsAlongADisk) {
  // Truth: potential flow. One projection finds it to second order; carried for a second, it is
  // kept to first order.
  const std::vector<int> sizes = {32, 64, 128};
  std::vector<double> projected, carried;
  for (const int size : sizes) {
    const StudyOutcome outcome = run("potential-disk", size);
    projected.push_back(outcome.metric("mean error after one projection").error);
    carried.push_back(outcome.metric("mean error after a second").error);
  }
  EXPECT_GT(fittedOrder(sizes, projected), 1.8);
  EXPECT_GT(fittedOrder(sizes, carried), 0.7);
  EXPECT_LT(carried[2], 0.01);
}

TEST(StudyCylindersSlow, TheSteadyDragStaysRightOnAFineGrid) {
  // Truth: 5.5795; by the balance of momentum to 0.1%.
  const StudyOutcome outcome = run("steady-cylinder", 40);
  EXPECT_LT(outcome.metric("drag").error, 0.01);
  EXPECT_LT(outcome.metric("drag by the momentum lost").error, 0.001);
}

TEST(StudyCylindersSlow, SlipIsOfSecondOrder) {
  // Truth: potential flow, 32 to 256 cells.
  const std::vector<int> sizes = {32, 64, 128, 256};
  std::vector<double> projected, carried;
  for (const int size : sizes) {
    const StudyOutcome outcome = run("potential-disk", size);
    projected.push_back(outcome.metric("mean error after one projection").error);
    carried.push_back(outcome.metric("mean error after a second").error);
  }
  EXPECT_GT(fittedOrder(sizes, projected), 1.8);
  EXPECT_GT(fittedOrder(sizes, carried), 0.8);
}

TEST(StudyCylindersSlow, VorticesAreShedAsInTheBenchmark) {
  // Truth: DFG 2D-2, FeatFlow's finest level.
  const StudyOutcome coarse = run("shedding-cylinder", 20), fine = run("shedding-cylinder", 30);
  EXPECT_LT(coarse.metric("largest drag").error, 0.01);
  EXPECT_LT(coarse.metric("largest lift").error, 0.03);
  EXPECT_LT(coarse.metric("Strouhal number").error, 0.005);
  EXPECT_LT(fine.metric("largest drag").error, 0.012);
  EXPECT_LT(fine.metric("largest lift").error, 0.025);
  EXPECT_LT(fine.metric("Strouhal number").error, 0.005);
}

TEST(StudyCylindersSlow, AnOscillatingCylinderFeelsTheMeasuredForces) {
  // Truth: Cd 2.09, Cm 1.45 (Duetsch 1998).
  const StudyOutcome outcome = run("oscillating-cylinder", 24);
  EXPECT_LT(outcome.metric("drag").error, 0.03);
  EXPECT_LT(outcome.metric("inertia").error, 0.03);
  EXPECT_LT(outcome.metric("peak force").error, 0.03);
  EXPECT_LT(outcome.metric("noise of the force").error, 0.03);
}

}  // namespace
}  // namespace smokebox
