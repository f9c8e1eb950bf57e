// A scene file with the settings of the command line laid over it.
#pragma once
#include <string>
#include <vector>

#include "scene/document.h"

namespace smokebox {

/// Throws IoError, or SceneError with everything that is wrong.
SceneDocument loadScene(const std::string& file, const std::vector<std::string>& settings);

/// Throws an Error that names both figures if the scenes together need more memory than this machine has
/// free.
void refuseTooLarge(const std::vector<SceneSpec>& specs);

}  // namespace smokebox
