// Colours as scenes write them.
#pragma once
#include <optional>
#include <string_view>

namespace smokebox {

/// sRGB-encoded components, 0 to 1.
struct Color {
  float r = 1, g = 1, b = 1;
  bool operator==(const Color&) const = default;
};

/// "#rgb", "#rrggbb" or one of the commoner CSS names.
std::optional<Color> parseColor(std::string_view text);

}  // namespace smokebox
