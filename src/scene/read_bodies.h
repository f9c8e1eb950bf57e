// Bodies and particles of a scene, also those that events add.
#pragma once
#include <string>
#include <vector>

#include "scene/reader.h"
#include "scene/spec.h"

namespace smokebox {

/// Who the bodies that are read are: from the lists of the scene, or from an event.
struct BodyOrigin {
  bool particle = false;
  int item = -1;       // position in the list
  bool later = false;  // an event adds it
  long times = 1;      // how often it does
};

/// Appends what the node describes to spec.bodies; returns how many these are.
int readBody(Reader& reader, const YamlNode& node, const std::string& name, const BodyOrigin& origin,
             SceneSpec& spec);

}  // namespace smokebox
