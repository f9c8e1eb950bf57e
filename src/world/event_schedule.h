// Which events fire at which step. An event at time T fires at the start of the first step whose time is not
// before T.
#pragma once
#include <vector>

#include "scene/spec.h"

namespace smokebox {

class EventSchedule {
 public:
  EventSchedule(const std::vector<EventSpec>& events, double dt);
  /// Indices into the scene's events that fire at the start of step `step` (counted from 0), in the file's
  /// order. An event whose interval is shorter than a step is named once for each time that it is due.
  const std::vector<int>& due(long step);

 private:
  struct Entry {
    double first, every, until;
    long fired = 0;  // times so far
  };
  std::vector<Entry> entries_;
  double dt_;
  std::vector<int> due_;
};

}  // namespace smokebox
