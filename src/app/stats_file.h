// The figures of a run as JSON, with the names of section 2 of the design.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "world/figures.h"

namespace smokebox {

class StatsFile {
 public:
  /// Finds out at once whether the file can be written. Throws IoError.
  explicit StatsFile(const std::string& file);
  ~StatsFile();

  void add(const StepFigures& figures);
  /// Writes the whole file. `filmFps`: frames drawn per second of wall time. Throws IoError.
  void write(const std::string& scene, const SummaryFigures& summary, std::optional<double> filmFps) const;

 private:
  struct Records;
  std::string file_;
  std::unique_ptr<Records> records_;
};

/// The most memory that this process has had, in MB.
double peakMemoryMb();

}  // namespace smokebox
