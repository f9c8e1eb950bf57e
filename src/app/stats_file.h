// The figures of a run as JSON, with the names of section 2 of the design. Each step's record goes to the
// file at once: thousands of bodies over thousands of steps need no memory.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "world/figures.h"

namespace smokebox {

class StatsFile {
 public:
  /// Opens the file, beside its final name. Throws IoError.
  explicit StatsFile(const std::string& file);
  ~StatsFile();

  /// Throws IoError.
  void add(const StepFigures& figures);
  /// Completes the file. `filmFps`: frames drawn per second of wall time. Throws IoError.
  void finish(const std::string& scene, const SummaryFigures& summary, std::optional<double> filmFps);

 private:
  struct Output;
  std::unique_ptr<Output> output_;
};

/// The most memory that this process has had, in MB.
double peakMemoryMb();

}  // namespace smokebox
