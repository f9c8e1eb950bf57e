// What a scene needs: decides which stages a World is built of. "Model no more than a scene needs" begins
// here.
#pragma once
#include <string>
#include <vector>

#include "fluid/fluid.h"
#include "scene/spec.h"

namespace smokebox {

struct Needs {
  bool fluid = false;
  Fluid::Parts parts;
  bool smoke = false;  // a source or a burst
  bool buoyancy = false;
  bool heat = false;          // a temperature is named
  bool heatDiffuses = false;  // a diffusivity that is not 0, now or after an event
  bool heatRises = false;     // expansion and gravity
  bool sourcesDrive = false;  // a source with a velocity
  bool rigid = false;         // a body, a particle or a cloth
  bool movingSolids = false;  // scripted ones
  bool reports = false;       // force and torque on a solid
};

Needs needsOf(const SceneSpec& spec);

/// Does an event set this option of the layers of that kind, or the whole of such a layer?
bool eventSetsLayer(const SceneSpec& spec, LayerKind kind, const std::string& option);

/// Is a layer of this kind shown at the start, or does an event show it?
bool canShow(const SceneSpec& spec, LayerKind kind);

/// Does a setting at `path` change this key, or one above or below it?
bool concerns(const std::string& path, const std::string& key);

/// Does an event set this key, or one above or below it?
bool eventSets(const SceneSpec& spec, const std::string& path);

}  // namespace smokebox
