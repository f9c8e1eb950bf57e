// Shapes of a scene: one key that names the kind, with `position` and `angle` beside it.
#pragma once
#include <optional>

#include "geometry/shape.h"
#include "scene/reader.h"

namespace smokebox {

/// Asks `map` for the shape's key, `position` and `angle`; the caller asks for its own keys and finishes the
/// map.
std::optional<PlacedShape> readPlacedShape(MapReader& map);

/// The same of a node that holds nothing else.
std::optional<PlacedShape> readPlacedShape(Reader& reader, const YamlNode& node, const std::string& name);

}  // namespace smokebox
