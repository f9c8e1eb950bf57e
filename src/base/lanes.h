// 16 floats at a time, for loops that compilers do not vectorise or that would need a loop for a rest. Every
// lane does the same operations whatever the instruction set, so the results are the same too.
//
// Where the machine has vectors of 16 floats, Lanes is one; else it is made of narrower ones
// (lanes_narrow.h): vectors wider than the machine's live in memory, and GCC 12 takes them apart number by
// number where they are compared, chosen from or shuffled.
#pragma once
#include <cstdint>
#include <cstring>

#define SMOKEBOX_INLINE inline __attribute__((always_inline))

#ifndef __AVX512F__
#include "base/lanes_narrow.h"
#endif

namespace smokebox {

constexpr int kLanes = 16;

#ifdef __AVX512F__

typedef float Lanes __attribute__((vector_size(64), aligned(4), may_alias));
typedef int LaneMask __attribute__((vector_size(64), aligned(4), may_alias));

SMOKEBOX_INLINE Lanes load(const float* p) { return *reinterpret_cast<const Lanes*>(p); }
SMOKEBOX_INLINE void store(float* p, const Lanes& v) { *reinterpret_cast<Lanes*>(p) = v; }

/// 0 to 15.
SMOKEBOX_INLINE LaneMask laneNumbers() {
  return LaneMask{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
}

/// Where the mask is true (-1) those of a, else those of b.
SMOKEBOX_INLINE Lanes select(const LaneMask& mask, const Lanes& a, const Lanes& b) { return mask ? a : b; }
SMOKEBOX_INLINE LaneMask select(const LaneMask& mask, const LaneMask& a, const LaneMask& b) {
  return mask ? a : b;
}

SMOKEBOX_INLINE LaneMask bitsOfFloats(const Lanes& v) { return reinterpret_cast<const LaneMask&>(v); }
SMOKEBOX_INLINE Lanes floatsOfBits(const LaneMask& v) { return reinterpret_cast<const Lanes&>(v); }

/// Every other one of the 32 lanes of a and b, from the first or from the second on.
SMOKEBOX_INLINE Lanes evenLanes(const Lanes& a, const Lanes& b) {
  return __builtin_shuffle(a, b, 2 * laneNumbers());
}
SMOKEBOX_INLINE Lanes oddLanes(const Lanes& a, const Lanes& b) {
  return __builtin_shuffle(a, b, 2 * laneNumbers() + 1);
}

/// The last lane of a, and all but the last of b.
SMOKEBOX_INLINE Lanes lastAndRest(const Lanes& a, const Lanes& b) {
  return __builtin_shuffle(a, b, laneNumbers() + (kLanes - 1));
}

/// Lane k: p[k / 2]; or p[(k + 1) / 2].
SMOKEBOX_INLINE Lanes loadTwice(const float* p) { return __builtin_shuffle(load(p), laneNumbers() >> 1); }
SMOKEBOX_INLINE Lanes loadTwiceFromMiddle(const float* p) {
  return __builtin_shuffle(load(p), (laneNumbers() + 1) >> 1);
}

#else

using Lanes = Pack<float, kLanes>;
using LaneMask = Pack<int, kLanes>;

SMOKEBOX_INLINE Lanes load(const float* p) { return Lanes::at(p); }
SMOKEBOX_INLINE void store(float* p, const Lanes& v) { v.to(p); }
SMOKEBOX_INLINE LaneMask laneNumbers() { return LaneMask::numbers(0); }

#endif

/// The lanes whose bits are set.
SMOKEBOX_INLINE LaneMask lanesOfBits(std::uint16_t bits) {
#ifdef __AVX512F__
  const LaneMask place = {1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
#else
  static constexpr int kBits[] = {1,   2,   4,    8,    16,   32,   64,    128,
                                  256, 512, 1024, 2048, 4096, 8192, 16384, 32768};
  const LaneMask place = LaneMask::at(kBits);
#endif
  return (place & static_cast<int>(bits)) != 0;
}

/// Lane k of v becomes `value`. No template: it would take v for one that lies at multiples of 64 bytes.
SMOKEBOX_INLINE void setLane(Lanes& v, int k, float value) {
  float lanes[kLanes];
  std::memcpy(lanes, &v, sizeof(lanes));
  lanes[k] = value;
  std::memcpy(&v, lanes, sizeof(lanes));
}

/// Asks for a line of the cache that the next row will need: the machine sees no further than a page, and a
/// row is about as long.
SMOKEBOX_INLINE void expect(const float* p) { __builtin_prefetch(p, 0, 2); }

SMOKEBOX_INLINE Lanes magnitude(const Lanes& v) { return floatsOfBits(bitsOfFloats(v) & 0x7fffffff); }

}  // namespace smokebox
