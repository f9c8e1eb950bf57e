#include "world/event_schedule.h"

namespace smokebox {

EventSchedule::EventSchedule(const std::vector<EventSpec>& events, double dt) : dt_(dt) {
  entries_.reserve(events.size());
  for (const EventSpec& event : events) entries_.push_back({event.first, event.every, event.until});
}

const std::vector<int>& EventSchedule::due(long step) {
  // A millionth of a step of slack: 0.3 must be step 36 of 1/120 although 0.3 * 120 is a rounding above 36.
  const double now = (step + 1e-6) * dt_;
  due_.clear();
  for (int k = 0; k < static_cast<int>(entries_.size()); ++k) {
    Entry& entry = entries_[k];
    for (;;) {
      if (entry.every <= 0 && entry.fired > 0) break;
      const double at = entry.first + entry.fired * entry.every;
      if (at > now || at > entry.until + 1e-6 * dt_) break;
      ++entry.fired;
      due_.push_back(k);
    }
  }
  return due_;
}

}  // namespace smokebox
