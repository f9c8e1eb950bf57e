// 16 floats at a time, for loops that compilers do not vectorise or that would need a loop for a rest. Every
// lane does the same operations whatever the instruction set, so the results are the same too.
#pragma once

// Vectors wider than the machine's stay inside inlined functions. The warning comes at the end of a file: not
// restored.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace smokebox {

typedef float Lanes __attribute__((vector_size(64), aligned(4), may_alias));
typedef int LaneMask __attribute__((vector_size(64), aligned(4), may_alias));

constexpr int kLanes = 16;

#define SMOKEBOX_INLINE inline __attribute__((always_inline))

SMOKEBOX_INLINE Lanes load(const float* p) { return *reinterpret_cast<const Lanes*>(p); }
SMOKEBOX_INLINE void store(float* p, const Lanes& v) { *reinterpret_cast<Lanes*>(p) = v; }

/// Asks for a line of the cache that the next row will need: the machine sees no further than a page, and a
/// row is about as long.
SMOKEBOX_INLINE void expect(const float* p) { __builtin_prefetch(p, 0, 2); }

SMOKEBOX_INLINE Lanes magnitude(const Lanes& v) {
  const LaneMask bits = reinterpret_cast<const LaneMask&>(v) & 0x7fffffff;
  return reinterpret_cast<const Lanes&>(bits);
}

}  // namespace smokebox
