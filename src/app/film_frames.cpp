#include "app/film_frames.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "base/errors.h"

namespace smokebox {

FrameRange filmFrames(const FrameRequest& request) {
  if (!request.frames) return {0, request.count - 1};
  const auto [first, last] = *request.frames;
  if (last >= request.count)
    throw UsageError("--frames: the film has the frames 0-" + std::to_string(request.count - 1) + " only");
  return {first, last};
}

FrameRange stillFrame(const FrameRequest& request) {
  if (!request.at) {
    const long last = filmFrames(request).last;
    return {last, last};
  }
  const double end = static_cast<double>(request.count) / request.fps;
  if (*request.at > end) {
    char text[80];
    std::snprintf(text, sizeof text, "%s: the film ends at %g s", request.atOption, end);
    throw UsageError(text);
  }
  const long frame = std::min(std::lround(*request.at * request.fps), request.count - 1);
  return {frame, frame};
}

}  // namespace smokebox
