// A picture in memory.
#pragma once
#include <cstdint>
#include <vector>

namespace smokebox {

/// 8-bit sRGB with alpha (always 255 in finished frames), top row first.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // 4 * width * height

  Image() = default;
  Image(int w, int h) : width(w), height(h), rgba(std::size_t{4} * w * h, 0) {}
};

}  // namespace smokebox
