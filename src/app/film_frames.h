// Which frames of a film are drawn, and which of its outputs takes which.
#pragma once
#include <optional>
#include <utility>
#include <vector>

namespace smokebox {

/// Frames are counted from 0; frame k shows the state at time k / fps.
struct FrameRange {
  long first = 0, last = -1;
  bool has(long frame) const { return first <= frame && frame <= last; }
};

/// What is asked of a film of `count` frames at `fps`.
struct FrameRequest {
  long count = 0;
  int fps = 30;
  std::optional<std::pair<long, long>> frames;  // first and last of a film's frames
  std::optional<double> at;                     // s; time of a still
  const char* atOption = "--at";                // what gave it
};

/// The frames of a film or a sequence. Throws UsageError if they are not all there.
FrameRange filmFrames(const FrameRequest& request);
/// The one frame of a still: the nearest to `at`, else the last. Throws UsageError for a time after the
/// film's end.
FrameRange stillFrame(const FrameRequest& request);

}  // namespace smokebox
