// Colours as scenes write them.
#pragma once

namespace smokebox {

/// sRGB-encoded components, 0 to 1.
struct Color {
  float r = 1, g = 1, b = 1;
  bool operator==(const Color&) const = default;
};

}  // namespace smokebox
