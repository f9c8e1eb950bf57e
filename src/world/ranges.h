// One range of each shown field for the whole film, known before the first frame is drawn: the film is
// simulated once on a coarser grid and its values are looked at. Costs a few per cent of the film.
#pragma once
#include <array>
#include <functional>

#include "scene/document.h"
#include "world/snapshot.h"

namespace smokebox {

struct FilmRanges {
  std::array<double, 2> pressure{-1, 1}, vorticity{-1, 1}, speed{0, 1}, temperature{0, 1};
  void put(Snapshot& snapshot) const {
    snapshot.pressureRange = pressure;
    snapshot.vorticityRange = vorticity;
    snapshot.speedRange = speed;
    snapshot.temperatureRange = temperature;
  }
};

/// Ranges that the scene gives are taken; others are found by a coarse run, in which all but one value in a
/// thousand of the frames that show the field (and all but one such frame in twenty, for a violent start) lie
/// inside; a layer that an event shows counts from then on. Runs nothing if no layer needs it. `eachFrame` is
/// called after each of the coarse run's frames with how many there have been, and of how many; what it
/// throws breaks off.
FilmRanges findRanges(const SceneDocument& document, int threads,
                      const std::function<void(long done, long frames)>& eachFrame = {});

/// The smallest of 1, 1.5, 2, 3, 4, 5, 6, 8, 10 times a power of ten that is not below `value` (> 0).
double niceCeiling(double value);

}  // namespace smokebox
