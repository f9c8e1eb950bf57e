// Cases with a known answer: each makes a scene for a size, runs it, and says how wrong it was and what that
// cost. Tests hold them against their limits, and the chart of speed against accuracy runs the same ones.
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "scene/document.h"

namespace smokebox {

/// One figure that the case measures.
struct StudyMetric {
  std::string name;      // "drag", "max error of u"
  double value = 0;      // as measured
  double reference = 0;  // the true or the published value; 0 where the value is an error itself
  double error = 0;      // >= 0: relative where the reference is not 0, else the value's own size
};

struct StudyOutcome {
  std::vector<StudyMetric> metrics;
  long steps = 0;
  double wallSeconds = 0, processorSeconds = 0;

  /// Throws an InvariantError if there is no such metric.
  const StudyMetric& metric(const std::string& name) const;
};

/// What is laid over a case's scene to run it by another method: `{"semi-Lagrangian", {{key, value}}}`.
struct StudyMethod {
  std::string name;
  std::vector<std::pair<std::string, std::string>> settings;
};

struct Study {
  std::string name;                            // "cavity-re1000"
  std::string about;                           // one line: what is measured
  std::string source;                          // where the truth is from
  std::vector<int> sizes;                      // for a chart; what a size counts is said in `about`
  std::function<std::string(int size)> scene;  // YAML
  /// Runs the scene to its end and measures.
  std::function<StudyOutcome(const SceneDocument& scene, int threads)> run;
};

/// All cases, by name.
const std::vector<Study>& studies();
/// Throws UsageError with a did-you-mean.
const Study& studyNamed(const std::string& name);

/// Makes the scene, lays the method over it, runs and times it.
StudyOutcome runStudy(const Study& study, int size, const StudyMethod& method = {}, int threads = 1);

/// The order p of error ~ size^-p, by least squares over the logarithms.
double fittedOrder(const std::vector<int>& sizes, const std::vector<double>& errors);

}  // namespace smokebox
