// FNV-1a, 64 bits: a fingerprint of bytes that is the same everywhere. Not for secrets.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace smokebox {

class Fnv1a {
 public:
  void update(const void* bytes, std::size_t count) {
    const auto* p = static_cast<const unsigned char*>(bytes);
    for (std::size_t k = 0; k < count; ++k) value_ = (value_ ^ p[k]) * 0x100000001b3u;
  }
  void update(std::string_view text) { update(text.data(), text.size()); }

  std::uint64_t value() const { return value_; }
  /// Sixteen hexadecimal digits.
  std::string text() const {
    char buffer[17];
    std::snprintf(buffer, sizeof buffer, "%016llx", static_cast<unsigned long long>(value_));
    return buffer;
  }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace smokebox
