// Paths into a scene's tree, such as `solids.fan.drag`: keys of maps, positions in lists, or names of what a
// list holds. In `view.layers` the name of a layer leads to every entry of that name, `pressure` as well as
// `{pressure: {opacity: 0.6}}`; a bare name becomes a map when an option is set below it.
#pragma once
#include <string>
#include <vector>

#include "scene/yaml_tree.h"

namespace smokebox {

/// The layers of a scene that lists none: smoke, solids, what it names of bodies, and captions.
std::vector<const char*> defaultLayers(const YamlNode& root);

std::vector<std::string> pathSteps(const std::string& path);

/// A copy of the tree with `value` at the end of the path; maps that are missing on the way are made, and
/// everything else is shared with `root`. Throws SceneError, at `place`, if a step leads nowhere.
YamlPtr withValue(const YamlPtr& root, const std::string& path, const YamlPtr& value,
                  const SourcePlace& place);

/// Why an event must not set this, empty if it may: what belongs to the layout of the run stays as it is.
std::string whyFixed(const std::string& path);

}  // namespace smokebox
