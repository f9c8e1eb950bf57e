// Numbers by chance that depend on nothing but (seed, step, index): the same on every machine, in any order.
// The mixing function is SplitMix64's (Steele, Lea, Flood 2014), applied once to each word. Not for secrets.
#pragma once
#include <cstdint>

namespace smokebox {

inline std::uint64_t mixedBits(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

inline std::uint64_t randomBits(std::uint64_t seed, std::uint64_t step, std::uint64_t index) {
  return mixedBits(index ^ mixedBits(step ^ mixedBits(seed)));
}

/// From 0, below 1.
inline double randomShare(std::uint64_t seed, std::uint64_t step, std::uint64_t index) {
  return static_cast<double>(randomBits(seed, step, index) >> 11) * 0x1p-53;
}

}  // namespace smokebox
