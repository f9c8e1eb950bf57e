#include "app/progress.h"

#include <unistd.h>

#include <cstdio>

namespace smokebox {

namespace {

constexpr double kSecondsBetween = 0.1;

}  // namespace

Progress::Progress(long frames, bool quiet)
    : frames_(frames), quiet_(quiet), terminal_(::isatty(STDERR_FILENO)) {}

Progress::~Progress() { clear(); }

double Progress::seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

bool Progress::due() {
  const Clock::time_point now = Clock::now();
  if (std::chrono::duration<double>(now - last_).count() < kSecondsBetween) return false;
  last_ = now;
  return true;
}

void Progress::showPreparing(long done, long of) {
  if (quiet_ || !terminal_ || of < 1 || !due()) return;
  shown_ = true;
  std::fprintf(stderr, "\rfinding the ranges of the colours, %ld%%\033[K", 100 * done / of);
}

void Progress::show(long done) {
  if (quiet_ || frames_ < 1 || done < 1) return;
  const double left = seconds() * static_cast<double>(frames_ - done) / static_cast<double>(done);
  const long minutes = static_cast<long>(left) / 60, seconds = static_cast<long>(left) % 60;
  const long percent = 100 * done / frames_;
  if (terminal_) {
    if (!due() && done < frames_) return;
    shown_ = true;
    std::fprintf(stderr, "\rframe %ld of %ld, %ld%%, %ld:%02ld left\033[K", done, frames_, percent, minutes,
                 seconds);
  } else if (10 * done / frames_ > tenths_) {
    tenths_ = 10 * done / frames_;
    std::fprintf(stderr, "frame %ld of %ld, %ld%%, %ld:%02ld left\n", done, frames_, percent, minutes,
                 seconds);
  }
}

void Progress::clear() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

}  // namespace smokebox
