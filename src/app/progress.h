// How far a film is, on standard error: one line that is written over on a terminal, else a line for each
// 10%.
#pragma once
#include <chrono>

namespace smokebox {

class Progress {
 public:
  /// `frames`: how many there are to simulate.
  Progress(long frames, bool quiet);
  /// Clears the terminal's line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// After so many of the frames of the coarse run that comes first; on a terminal only.
  void showPreparing(long done, long of);
  /// After so many frames.
  void show(long done);
  void clear();
  double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;
  /// Has the terminal's line been left alone for long enough?
  bool due();
  long frames_;
  bool quiet_, terminal_, shown_ = false;
  long tenths_ = 0;
  Clock::time_point start_ = Clock::now(), last_{};
};

}  // namespace smokebox
