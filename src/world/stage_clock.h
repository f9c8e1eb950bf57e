// Wall time of each stage of a step.
#pragma once
#include <chrono>
#include <utility>
#include <vector>

namespace smokebox {

class StageClock {
 public:
  void begin() {
    stages_.clear();
    start_ = last_ = Clock::now();
  }
  /// Everything since the last call (or begin) was this stage.
  void stage(const char* name) {
    const Clock::time_point now = Clock::now();
    stages_.emplace_back(name, milliseconds(last_, now));
    last_ = now;
  }
  const std::vector<std::pair<const char*, double>>& stages() const { return stages_; }
  double totalMs() const { return milliseconds(start_, last_); }

 private:
  using Clock = std::chrono::steady_clock;
  static double milliseconds(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double, std::milli>(to - from).count();
  }
  Clock::time_point start_, last_;
  std::vector<std::pair<const char*, double>> stages_;
};

}  // namespace smokebox
