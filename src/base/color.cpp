#include "base/color.h"

#include <array>
#include <utility>

namespace smokebox {
namespace {

constexpr std::array<std::pair<std::string_view, unsigned>, 36> kNames{{
    {"black", 0x000000},     {"white", 0xffffff},  {"gray", 0x808080},      {"grey", 0x808080},
    {"silver", 0xc0c0c0},    {"red", 0xff0000},    {"green", 0x008000},     {"blue", 0x0000ff},
    {"lime", 0x00ff00},      {"yellow", 0xffff00}, {"orange", 0xffa500},    {"gold", 0xffd700},
    {"purple", 0x800080},    {"violet", 0xee82ee}, {"magenta", 0xff00ff},   {"fuchsia", 0xff00ff},
    {"pink", 0xffc0cb},      {"cyan", 0x00ffff},   {"aqua", 0x00ffff},      {"teal", 0x008080},
    {"turquoise", 0x40e0d0}, {"navy", 0x000080},   {"maroon", 0x800000},    {"brown", 0xa52a2a},
    {"olive", 0x808000},     {"coral", 0xff7f50},  {"tomato", 0xff6347},    {"crimson", 0xdc143c},
    {"salmon", 0xfa8072},    {"khaki", 0xf0e68c},  {"indigo", 0x4b0082},    {"orchid", 0xda70d6},
    {"skyblue", 0x87ceeb},   {"tan", 0xd2b48c},    {"steelblue", 0x4682b4}, {"darkgray", 0xa9a9a9},
}};

int hexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

Color fromBytes(unsigned rgb) {
  return {static_cast<float>(rgb >> 16 & 255) / 255, static_cast<float>(rgb >> 8 & 255) / 255,
          static_cast<float>(rgb & 255) / 255};
}

}  // namespace

std::optional<Color> parseColor(std::string_view text) {
  if (text.empty() || text[0] != '#') {
    for (const auto& [name, rgb] : kNames)
      if (name == text) return fromBytes(rgb);
    return {};
  }
  if (text.size() != 4 && text.size() != 7) return {};
  unsigned rgb = 0;
  for (char c : text.substr(1)) {
    const int digit = hexDigit(c);
    if (digit < 0) return {};
    rgb = rgb << 4 | static_cast<unsigned>(digit);
    if (text.size() == 4) rgb = rgb << 4 | static_cast<unsigned>(digit);
  }
  return fromBytes(rgb);
}

}  // namespace smokebox
