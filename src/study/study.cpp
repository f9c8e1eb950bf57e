#include "study/study.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

#include "base/errors.h"
#include "scene/nearest.h"
#include "study/cases.h"

namespace smokebox {

namespace {

double processorSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

const StudyMetric& StudyOutcome::metric(const std::string& name) const {
  const auto found =
      std::find_if(metrics.begin(), metrics.end(), [&](const StudyMetric& m) { return m.name == name; });
  checkInvariant(found != metrics.end(), "a study has the metric that is asked for");
  return *found;
}

const std::vector<Study>& studies() {
  static const std::vector<Study> all = [] {
    std::vector<Study> list = allCases();
    std::sort(list.begin(), list.end(), [](const Study& a, const Study& b) { return a.name < b.name; });
    return list;
  }();
  return all;
}

const Study& studyNamed(const std::string& name) {
  std::vector<std::string> names;
  for (const Study& study : studies()) {
    if (study.name == name) return study;
    names.push_back(study.name);
  }
  throw UsageError("unknown study '" + name + "'; " + suggestion(name, names));
}

StudyOutcome runStudy(const Study& study, int size, const StudyMethod& method, int threads) {
  SceneDocument scene = SceneDocument::parse(study.scene(size), study.name + ".yaml");
  for (const auto& [key, value] : method.settings) scene.set(key, value, SourcePlace{method.name, 0, 0});
  const auto start = std::chrono::steady_clock::now();
  const double processorStart = processorSeconds();
  StudyOutcome outcome = study.run(scene, threads);
  outcome.processorSeconds = processorSeconds() - processorStart;
  outcome.wallSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

double fittedOrder(const std::vector<int>& sizes, const std::vector<double>& errors) {
  checkInvariant(sizes.size() == errors.size() && sizes.size() >= 2,
                 "an order is fitted to two points or more");
  double meanX = 0, meanY = 0, xx = 0, xy = 0;
  const auto count = static_cast<double>(sizes.size());
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    meanX += std::log(sizes[k]) / count;
    meanY += std::log(errors[k]) / count;
  }
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const double x = std::log(sizes[k]) - meanX, y = std::log(errors[k]) - meanY;
    xx += x * x;
    xy += x * y;
  }
  return -xy / xx;
}

}  // namespace smokebox
