// The loops of a sweep over the cells or faces of a row, 16 at a time: what is worked out beyond the last one
// that is wanted is not used. Pointers are to the first cell or face; rows have room for 16 more on either
// side.
#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "fluid/sweep.h"

namespace smokebox::sweeps {

constexpr int kLanes = Activity::kStrip;
constexpr float kTiny = 1e-30f;
// Fluxes out of cells with less than this many quanta are rounded towards zero, so that none is overdrawn.
constexpr float kRoundingFloor = 1024;

// Functions of their own: where they are not inlined, compilers see that the number of turns is a multiple of
// 16 and leave out a loop for the rest.
#define SMOKEBOX_APART __attribute__((noinline))

inline int chunksOf(int n) { return (n + kLanes - 1) / kLanes; }

/// The donor flux through faces and what the reconstruction adds to it. `d` is the distance between a face's
/// high cell and its low cell.
template <class Step>
SMOKEBOX_APART inline void fluxes(int chunks, const float* __restrict c, const float* __restrict r,
                                  const float* __restrict vLow, const float* __restrict vHigh, Step d,
                                  float* __restrict donor, float* __restrict extra) {
#pragma omp simd
  for (int k = 0; k < chunks * kLanes; ++k) {
    const float flow = c[k];
    const bool up = flow > 0;
    const float l4 = r[k - 4 * d], l3 = r[k - 3 * d], l2 = r[k - 2 * d], l1 = r[k - d];
    const float h1 = r[k], h2 = r[k + d], h3 = r[k + 2 * d], h4 = r[k + 3 * d];
    const float z = up ? l4 : h4, a = up ? l3 : h3, b = up ? l2 : h2, mid = up ? l1 : h1;
    const float e = up ? h1 : l1, f = up ? h2 : l2, y = up ? h3 : l3;
    const float vUp = up ? vLow[k] : vHigh[k];
    const float g = std::min(std::fabs(flow) / vUp, 1.0f);
    const float t1 = e - b, t2 = (e - mid) - (mid - b);
    const float t3 = (f - a) - 2 * t1, t4 = ((f - mid) - (mid - a)) - 4 * t2;
    const float t5 = (y - z) - 4 * t3 - 3 * t1, t6 = ((y - mid) - (mid - z)) - 6 * t4 - 9 * t2;
    const float s = 1 - 2 * g, bend = g * (1 - g), w3 = (2 + bend) * (1.0f / 12),
                w5 = (6 + bend) * (1.0f / 30);
    const float above =
        t1 + s * (1.0f / 3) * t2 - w3 * (t3 + s * 0.2f * t4 - w5 * (t5 + s * (1.0f / 7) * t6));
    donor[k] = flow * mid;
    extra[k] = flow * (0.25f * (1 - g) * above);
  }
}

// By value: std::min and std::max hand out references, which keeps GCC 12 from vectorising the loops below.
inline float larger(float a, float b) { return a > b ? a : b; }
inline float smaller(float a, float b) { return a < b ? a : b; }

/// Zalesak's limits: which part of the corrections may flow into a cell (`in`) and out of it (`out`).
SMOKEBOX_APART inline void limits(int chunks, const float* __restrict m, const float* __restrict v,
                                  const float* __restrict cLow, const float* __restrict cHigh,
                                  const float* __restrict donorLow, const float* __restrict donorHigh,
                                  const float* __restrict extraLow, const float* __restrict extraHigh,
                                  float highest, float slack, float* __restrict in, float* __restrict out) {
#pragma omp simd
  for (int k = 0; k < chunks * kLanes; ++k) {
    const float vNext = v[k] - (cHigh[k] - cLow[k]);
    const float mDonor = m[k] - (donorHigh[k] - donorLow[k]);
    const float enters = larger(extraLow[k], 0.0f) - smaller(extraHigh[k], 0.0f);
    const float leaves = larger(extraHigh[k], 0.0f) - smaller(extraLow[k], 0.0f);
    const float room = larger(highest * vNext - mDonor - slack, 0.0f), stock = larger(mDonor - slack, 0.0f);
    in[k] = smaller(1.0f, room / (enters + kTiny));
    out[k] = smaller(1.0f, stock / (leaves + kTiny));
  }
}

/// The final flux, a whole number of quanta.
template <class Step>
SMOKEBOX_APART inline void joinFluxes(int chunks, const float* __restrict c, const float* __restrict r,
                                      Step d, const float* __restrict donor, const float* __restrict extra,
                                      const float* __restrict inLow, const float* __restrict outLow,
                                      const float* __restrict inHigh, const float* __restrict outHigh,
                                      Quantum q, float* __restrict flux) {
  const float floorValue = kRoundingFloor * q.size;
#pragma omp simd
  for (int k = 0; k < chunks * kLanes; ++k) {
    const float up = smaller(inHigh[k], outLow[k]), down = smaller(inLow[k], outHigh[k]);
    const float share = extra[k] > 0 ? up : down;
    const float x = (donor[k] + extra[k] * share) * q.inverse;
    const float upwind = c[k] > 0 ? r[k - d] : r[k];
    const float half = upwind >= floorValue ? 0.5f : 0.0f;
    flux[k] = static_cast<float>(static_cast<std::int32_t>(x + (x < 0 ? -half : half))) * q.size;
  }
}

/// New masses and values of n cells; returns the largest value, as its bits: those of floats that are not
/// negative are in the same order, and integers reduce in vectors.
SMOKEBOX_APART inline std::int32_t update(int n, const float* __restrict m, const float* __restrict v,
                                          const float* __restrict cLow, const float* __restrict cHigh,
                                          const float* __restrict fluxLow, const float* __restrict fluxHigh,
                                          float* __restrict mOut, float* __restrict rOut) {
  std::int32_t value = 0;
#pragma omp simd reduction(max : value)
  for (int k = 0; k < n; ++k) {
    const float next = m[k] - (fluxHigh[k] - fluxLow[k]);
    const float ratio = next / (v[k] - (cHigh[k] - cLow[k]));
    mOut[k] = next;
    rOut[k] = ratio;
    value = std::max(value, std::bit_cast<std::int32_t>(ratio));
  }
  return value;
}

/// The same with values measured by `divisor`; 0 where that is.
SMOKEBOX_APART inline std::int32_t updateWith(int n, const float* __restrict m,
                                              const float* __restrict divisor,
                                              const float* __restrict fluxLow,
                                              const float* __restrict fluxHigh, float* __restrict mOut,
                                              float* __restrict rOut) {
  std::int32_t value = 0;
#pragma omp simd reduction(max : value)
  for (int k = 0; k < n; ++k) {
    const float next = m[k] - (fluxHigh[k] - fluxLow[k]), by = divisor[k];
    const float quotient = next / (by > 0 ? by : 1.0f);
    const float ratio = by > 0 ? quotient : 0.0f;
    mOut[k] = next;
    rOut[k] = ratio;
    value = std::max(value, std::bit_cast<std::int32_t>(ratio));
  }
  return value;
}

/// Which chunks of n cells hold anything.
inline void markHeld(int n, const float* m, std::uint8_t* held) {
  for (; n >= kLanes; n -= kLanes, m += kLanes) {
    std::uint64_t bits[kLanes / 2], any = 0;
    std::memcpy(bits, m, sizeof(bits));
    for (const std::uint64_t b : bits) any |= b;
    *held++ = any != 0;
  }
  if (n > 0) *held = std::any_of(m, m + n, [](float x) { return x != 0; });
}

}  // namespace smokebox::sweeps
