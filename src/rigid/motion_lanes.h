// Motions of several bodies at once: in the memory the numbers of each body lie side by side, in lanes those
// of one kind.
#pragma once
#ifdef __AVX__
#include <immintrin.h>
#endif

#include "rigid/bodies.h"
#include "rigid/wide_lanes.h"

namespace smokebox {

/// How the second body of each pair moves against the first one (x, y), and how each of them turns.
template <class Vector>
struct Relative {
  Vector x, y, turnA, turnB;
};

namespace motion_lanes {

constexpr int kNumbers = 4;  // in a Motion
static_assert(sizeof(Motion) == kNumbers * sizeof(double));
typedef float Four __attribute__((vector_size(16)));

// GCC 12 converts in halves, and goes round about where halves are joined: told what to take, it is a fifth
// faster.
#ifdef __AVX__
inline Lanes widened(Four a) { return reinterpret_cast<Lanes>(_mm256_cvtps_pd(reinterpret_cast<__m128>(a))); }
inline FloatLanes eightOf(Four low, Four high) {
  return reinterpret_cast<FloatLanes>(
      _mm256_set_m128(reinterpret_cast<__m128>(high), reinterpret_cast<__m128>(low)));
}
inline Lanes halves(Lanes low, Lanes high) {
  return reinterpret_cast<Lanes>(
      _mm256_blend_pd(reinterpret_cast<__m256d>(low), reinterpret_cast<__m256d>(high), 0b1100));
}
#else
inline Lanes widened(Four a) { return __builtin_convertvector(a, Lanes); }
inline FloatLanes eightOf(Four low, Four high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
/// The first two of `low`, the last two of `high`.
inline Lanes halves(Lanes low, Lanes high) { return __builtin_shufflevector(low, high, 0, 1, 6, 7); }
#endif

/// A body's motion; `at` counts numbers, not bodies: that needs no multiplication.
inline Lanes row(const Motion* from, int at) { return *reinterpret_cast<const Lanes*>(&from->x + at); }
inline void addTo(Motion* to, int at, Lanes by) { *reinterpret_cast<Lanes*>(&to->x + at) += by; }

/// Of one pair: x, y, turnB, turnA. The difference is taken in float64: what moves fast side by side keeps
/// its accuracy.
inline Lanes against(const Motion* of, int atA, int atB) {
  const Lanes a = row(of, atA), b = row(of, atB), apart = b - a;
  const Lanes turns = __builtin_shufflevector(b, a, 0, 4, 2, 6);
  return halves(apart, turns);
}

[[gnu::always_inline]] inline void gather(const Motion* of, const int* a, const int* b, Relative<Lanes>& to) {
  const Lanes r0 = against(of, a[0], b[0]), r1 = against(of, a[1], b[1]), r2 = against(of, a[2], b[2]),
              r3 = against(of, a[3], b[3]);
  const Lanes xb01 = __builtin_shufflevector(r0, r1, 0, 4, 2, 6),
              xb23 = __builtin_shufflevector(r2, r3, 0, 4, 2, 6),
              ya01 = __builtin_shufflevector(r0, r1, 1, 5, 3, 7),
              ya23 = __builtin_shufflevector(r2, r3, 1, 5, 3, 7);
  to = {__builtin_shufflevector(xb01, xb23, 0, 1, 4, 5), __builtin_shufflevector(ya01, ya23, 0, 1, 4, 5),
        __builtin_shufflevector(ya01, ya23, 2, 3, 6, 7), __builtin_shufflevector(xb01, xb23, 2, 3, 6, 7)};
}

[[gnu::always_inline]] inline void gather(const Motion* of, const int* a, const int* b,
                                          Relative<FloatLanes>& to) {
  auto two = [&](int k) {
    const Four low = __builtin_convertvector(against(of, a[k], b[k]), Four),
               high = __builtin_convertvector(against(of, a[k + 4], b[k + 4]), Four);
    return eightOf(low, high);
  };
  const FloatLanes r0 = two(0), r1 = two(1), r2 = two(2), r3 = two(3);
  const FloatLanes xy01 = __builtin_shufflevector(r0, r1, 0, 8, 1, 9, 4, 12, 5, 13),
                   xy23 = __builtin_shufflevector(r2, r3, 0, 8, 1, 9, 4, 12, 5, 13),
                   turn01 = __builtin_shufflevector(r0, r1, 2, 10, 3, 11, 6, 14, 7, 15),
                   turn23 = __builtin_shufflevector(r2, r3, 2, 10, 3, 11, 6, 14, 7, 15);
  to = {__builtin_shufflevector(xy01, xy23, 0, 1, 8, 9, 4, 5, 12, 13),
        __builtin_shufflevector(xy01, xy23, 2, 3, 10, 11, 6, 7, 14, 15),
        __builtin_shufflevector(turn01, turn23, 2, 3, 10, 11, 6, 7, 14, 15),
        __builtin_shufflevector(turn01, turn23, 0, 1, 8, 9, 4, 5, 12, 13)};
}

template <class Wide>
[[gnu::always_inline]] inline void gather(const Motion* of, const int* a, const int* b, Relative<Wide>& to) {
  using Half = decltype(lowOf(to.x));
  constexpr int kHalf = sizeof(Half) / sizeof(lowOf(to.x)[0]);
  Relative<Half> low, high;
  gather(of, a, b, low);
  gather(of, a + kHalf, b + kHalf, high);
  to = {joined(low.x, high.x), joined(low.y, high.y), joined(low.turnA, high.turnA),
        joined(low.turnB, high.turnB)};
}

/// Adds to the bodies' motions. One that does not move may be in several lanes: it gets zeros.
[[gnu::always_inline]] inline void scatterAdd(Motion* to, const int* at, Lanes x, Lanes y, Lanes turn) {
  const Lanes zero{};
  const Lanes xy02 = __builtin_shufflevector(x, y, 0, 4, 2, 6),
              xy13 = __builtin_shufflevector(x, y, 1, 5, 3, 7),
              turn02 = __builtin_shufflevector(turn, zero, 0, 4, 2, 6),
              turn13 = __builtin_shufflevector(turn, zero, 1, 5, 3, 7);
  addTo(to, at[0], __builtin_shufflevector(xy02, turn02, 0, 1, 4, 5));
  addTo(to, at[1], __builtin_shufflevector(xy13, turn13, 0, 1, 4, 5));
  addTo(to, at[2], __builtin_shufflevector(xy02, turn02, 2, 3, 6, 7));
  addTo(to, at[3], __builtin_shufflevector(xy13, turn13, 2, 3, 6, 7));
}

[[gnu::always_inline]] inline void scatterAdd(Motion* to, const int* at, FloatLanes x, FloatLanes y,
                                              FloatLanes turn) {
  const FloatLanes zero{};
  const FloatLanes xy01 = __builtin_shufflevector(x, y, 0, 8, 1, 9, 4, 12, 5, 13),
                   xy23 = __builtin_shufflevector(x, y, 2, 10, 3, 11, 6, 14, 7, 15),
                   turn01 = __builtin_shufflevector(turn, zero, 0, 8, 1, 9, 4, 12, 5, 13),
                   turn23 = __builtin_shufflevector(turn, zero, 2, 10, 3, 11, 6, 14, 7, 15);
  auto add = [&](int k, FloatLanes both) {
    addTo(to, at[k], widened(__builtin_shufflevector(both, both, 0, 1, 2, 3)));
    addTo(to, at[k + 4], widened(__builtin_shufflevector(both, both, 4, 5, 6, 7)));
  };
  add(0, __builtin_shufflevector(xy01, turn01, 0, 1, 8, 9, 4, 5, 12, 13));
  add(1, __builtin_shufflevector(xy01, turn01, 2, 3, 10, 11, 6, 7, 14, 15));
  add(2, __builtin_shufflevector(xy23, turn23, 0, 1, 8, 9, 4, 5, 12, 13));
  add(3, __builtin_shufflevector(xy23, turn23, 2, 3, 10, 11, 6, 7, 14, 15));
}

template <class Wide>
[[gnu::always_inline]] inline void scatterAdd(Motion* to, const int* at, Wide x, Wide y, Wide turn) {
  constexpr int kHalf = sizeof(lowOf(x)) / sizeof(lowOf(x)[0]);
  scatterAdd(to, at, lowOf(x), lowOf(y), lowOf(turn));
  scatterAdd(to, at + kHalf, highOf(x), highOf(y), highOf(turn));
}

}  // namespace motion_lanes
}  // namespace smokebox
