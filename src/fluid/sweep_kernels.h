// The loops of a sweep over the cells or faces of a row, 16 at a time: what is worked out beyond the last one
// that is wanted is not used. Pointers are to the first cell or face; rows have room for 16 more on either
// side.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>

#include "base/lanes.h"
#include "fluid/sweep.h"

namespace smokebox::sweeps {

static_assert(Activity::kStrip == kLanes);
constexpr LaneMask kLanePlace = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
constexpr float kTiny = 1e-30f;
// Fluxes out of cells with less than this many quanta are rounded towards zero, so that none is overdrawn.
constexpr float kRoundingFloor = 1024;

inline int chunksOf(int n) { return (n + kLanes - 1) / kLanes; }

SMOKEBOX_INLINE Lanes larger(const Lanes& a, const Lanes& b) { return a > b ? a : b; }
SMOKEBOX_INLINE Lanes smaller(const Lanes& a, const Lanes& b) { return a < b ? a : b; }

/// The donor flux through faces and what the reconstruction adds to it. `d` is the distance between a face's
/// high cell and its low cell.
template <class Step>
inline void fluxes(int chunks, const float* __restrict c, const float* __restrict r,
                   const float* __restrict vLow, const float* __restrict vHigh, Step d,
                   float* __restrict donor, float* __restrict extra) {
  for (int k = 0; k < chunks * kLanes; k += kLanes) {
    const Lanes flow = load(c + k), one = Lanes{} + 1.0f;
    const LaneMask up = flow > 0.0f;
    const float* at = r + k;
    const Lanes l4 = load(at - 4 * d), l3 = load(at - 3 * d), l2 = load(at - 2 * d), l1 = load(at - d);
    const Lanes h1 = load(at), h2 = load(at + d), h3 = load(at + 2 * d), h4 = load(at + 3 * d);
    const Lanes z = up ? l4 : h4, a = up ? l3 : h3, b = up ? l2 : h2, mid = up ? l1 : h1;
    const Lanes e = up ? h1 : l1, f = up ? h2 : l2, y = up ? h3 : l3;
    const Lanes g = smaller(one, magnitude(flow) / (up ? load(vLow + k) : load(vHigh + k)));
    const Lanes t1 = e - b, t2 = (e - mid) - (mid - b);
    const Lanes t3 = (f - a) - 2.0f * t1, t4 = ((f - mid) - (mid - a)) - 4.0f * t2;
    const Lanes t5 = (y - z) - 4.0f * t3 - 3.0f * t1, t6 = ((y - mid) - (mid - z)) - 6.0f * t4 - 9.0f * t2;
    const Lanes s = 1.0f - 2.0f * g, bend = g * (1.0f - g), w3 = (2.0f + bend) * (1.0f / 12),
                w5 = (6.0f + bend) * (1.0f / 30);
    const Lanes above =
        t1 + s * (1.0f / 3) * t2 - w3 * (t3 + s * 0.2f * t4 - w5 * (t5 + s * (1.0f / 7) * t6));
    store(donor + k, flow * mid);
    store(extra + k, flow * (0.25f * (1.0f - g) * above));
  }
}

/// Zalesak's limits: which part of the corrections may flow into a cell (`in`) and out of it (`out`).
inline void limits(int chunks, const float* __restrict m, const float* __restrict v,
                   const float* __restrict cLow, const float* __restrict cHigh,
                   const float* __restrict donorLow, const float* __restrict donorHigh,
                   const float* __restrict extraLow, const float* __restrict extraHigh, float highest,
                   float slack, float* __restrict in, float* __restrict out) {
  const Lanes zero = {}, one = zero + 1.0f;
  for (int k = 0; k < chunks * kLanes; k += kLanes) {
    const Lanes next = load(v + k) - (load(cHigh + k) - load(cLow + k));
    const Lanes donor = load(m + k) - (load(donorHigh + k) - load(donorLow + k));
    const Lanes low = load(extraLow + k), high = load(extraHigh + k);
    const Lanes enters = larger(low, zero) - smaller(high, zero);
    const Lanes leaves = larger(high, zero) - smaller(low, zero);
    const Lanes room = larger(highest * next - donor - slack, zero), stock = larger(donor - slack, zero);
    store(in + k, smaller(one, room / (enters + kTiny)));
    store(out + k, smaller(one, stock / (leaves + kTiny)));
  }
}

/// The final flux, a whole number of quanta.
template <class Step>
inline void joinFluxes(int chunks, const float* __restrict c, const float* __restrict r, Step d,
                       const float* __restrict donor, const float* __restrict extra,
                       const float* __restrict inLow, const float* __restrict outLow,
                       const float* __restrict inHigh, const float* __restrict outHigh, Quantum q,
                       float* __restrict flux) {
  const float floorValue = kRoundingFloor * q.size;
  const Lanes zero = {}, most = zero + 0.5f;
  for (int k = 0; k < chunks * kLanes; k += kLanes) {
    const Lanes up = smaller(load(inHigh + k), load(outLow + k)),
                down = smaller(load(inLow + k), load(outHigh + k));
    const Lanes change = load(extra + k), share = change > 0.0f ? up : down;
    const Lanes x = (load(donor + k) + change * share) * q.inverse;
    const Lanes upwind = load(c + k) > 0.0f ? load(r + k - d) : load(r + k);
    const Lanes half = upwind >= floorValue ? most : zero;
    const LaneMask whole = __builtin_convertvector(x + (x < 0.0f ? -half : half), LaneMask);
    store(flux + k, __builtin_convertvector(whole, Lanes) * q.size);
  }
}

/// New masses and values of n cells; returns the largest value (as its bits: those of floats that are not
/// negative are in the same order). `divisor`: what values are measured by (0: value 0), or null.
inline std::int32_t update(int n, const float* __restrict m, const float* __restrict divisor,
                           const float* __restrict v, const float* __restrict cLow,
                           const float* __restrict cHigh, const float* __restrict fluxLow,
                           const float* __restrict fluxHigh, float* __restrict mOut, float* __restrict rOut) {
  const Lanes zero = {}, one = zero + 1.0f;
  LaneMask top = {};
  for (int k = 0; k < n; k += kLanes) {
    Lanes next = load(m + k) - (load(fluxHigh + k) - load(fluxLow + k)), value;
    if (divisor) {
      const Lanes by = load(divisor + k);
      value = next / (by > 0.0f ? by : one);
      value = by > 0.0f ? value : zero;
    } else {
      value = next / (load(v + k) - (load(cHigh + k) - load(cLow + k)));
    }
    if (n - k >= kLanes) {
      store(mOut + k, next);
      store(rOut + k, value);
    } else {
      value = kLanePlace < n - k ? value : zero;
      std::memcpy(mOut + k, &next, (n - k) * sizeof(float));
      std::memcpy(rOut + k, &value, (n - k) * sizeof(float));
    }
    const LaneMask bits = reinterpret_cast<const LaneMask&>(value);
    top = bits > top ? bits : top;
  }
  std::int32_t most = 0;
  for (int k = 0; k < kLanes; ++k) most = std::max(most, top[k]);
  return most;
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
