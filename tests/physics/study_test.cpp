// The cases with known answers that the chart runs, held against their limits.
#include <gtest/gtest.h>

#include <cstdio>

#include "study/study.h"

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

TEST(Study, DriftingVorticesKeepTheirShapeWithHighOrder) {
  // Truth: the flow moves without change; the error falls with an order of 2.5 at least.
  const std::vector<int> sizes = {32, 64, 128};
  const std::vector<double> errors = errorsOf("drifting-vortices", "max error of the velocity", sizes);
  EXPECT_LT(errors[1], 1e-3);
  EXPECT_LT(errors[2], 2e-4);
  EXPECT_GT(fittedOrder(sizes, errors), 2.5);
}

TEST(Study, AnOrderIsFittedExactlyToAPowerLaw) {
  // Truth: errors of 3 n^-2 have the order 2.
  EXPECT_NEAR(fittedOrder({8, 16, 64}, {3.0 / 64, 3.0 / 256, 3.0 / 4096}), 2, 1e-12);
}

}  // namespace
}  // namespace smokebox
