// Vectors of 64 bytes. Where the machine has none that wide they are pairs of 32 bytes, which GCC 12 does not
// make of them by itself: it would go through the memory, number by number. The results are the same.
#pragma once
#include "rigid/lanes.h"

namespace smokebox {

#ifdef __AVX512F__
typedef double WideLanes __attribute__((vector_size(64)));
typedef float WideFloatLanes __attribute__((vector_size(64)));

inline WideLanes joined(Lanes low, Lanes high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
inline WideFloatLanes joined(FloatLanes low, FloatLanes high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
inline Lanes lowOf(WideLanes a) { return __builtin_shufflevector(a, a, 0, 1, 2, 3); }
inline Lanes highOf(WideLanes a) { return __builtin_shufflevector(a, a, 4, 5, 6, 7); }
inline FloatLanes lowOf(WideFloatLanes a) { return __builtin_shufflevector(a, a, 0, 1, 2, 3, 4, 5, 6, 7); }
inline FloatLanes highOf(WideFloatLanes a) {
  return __builtin_shufflevector(a, a, 8, 9, 10, 11, 12, 13, 14, 15);
}
/// a where the mask, which a comparison gives, is set; b elsewhere.
template <class Mask, class V>
V choose(Mask mask, V a, V b) {
  return mask ? a : b;
}
#else
template <class Half>
struct alignas(64) Pair {
  Half low, high;
  Pair operator-() const { return {-low, -high}; }
  friend Pair operator+(const Pair& a, const Pair& b) { return {a.low + b.low, a.high + b.high}; }
  friend Pair operator-(const Pair& a, const Pair& b) { return {a.low - b.low, a.high - b.high}; }
  friend Pair operator*(const Pair& a, const Pair& b) { return {a.low * b.low, a.high * b.high}; }
  friend Pair operator/(const Pair& a, const Pair& b) { return {a.low / b.low, a.high / b.high}; }
  Pair& operator+=(const Pair& b) { return *this = *this + b; }
  Pair& operator-=(const Pair& b) { return *this = *this - b; }
  friend auto operator<(const Pair& a, const Pair& b) { return mask(a.low < b.low, a.high < b.high); }
  friend auto operator>(const Pair& a, const Pair& b) { return mask(a.low > b.low, a.high > b.high); }
  friend auto operator!=(const Pair& a, const Pair& b) { return mask(a.low != b.low, a.high != b.high); }

 private:
  template <class Mask>
  static Pair<Mask> mask(Mask low, Mask high) {
    return {low, high};
  }
};
using WideLanes = Pair<Lanes>;
using WideFloatLanes = Pair<FloatLanes>;

template <class Half>
Pair<Half> joined(Half low, Half high) {
  return {low, high};
}
template <class Half>
Half lowOf(const Pair<Half>& a) {
  return a.low;
}
template <class Half>
Half highOf(const Pair<Half>& a) {
  return a.high;
}
template <class Mask, class Half>
Pair<Half> choose(const Pair<Mask>& mask, const Pair<Half>& a, const Pair<Half>& b) {
  return {mask.low ? a.low : b.low, mask.high ? a.high : b.high};
}
#endif

template <class Number>
struct WideOf;
template <>
struct WideOf<double> {
  using Type = WideLanes;
  using Half = Lanes;
  static constexpr int kCount = 8;
};
template <>
struct WideOf<float> {
  using Type = WideFloatLanes;
  using Half = FloatLanes;
  static constexpr int kCount = 16;
};

/// All lanes the same.
template <class Number>
typename WideOf<Number>::Type wide(Number x) {
  const typename WideOf<Number>::Half half = typename WideOf<Number>::Half{} + x;
  return joined(half, half);
}
template <class V>
V larger(V a, V b) {
  return choose(a > b, a, b);
}
template <class V>
V smaller(V a, V b) {
  return choose(a < b, a, b);
}
inline double largestOf(Lanes a) {
  const Lanes turned = __builtin_shufflevector(a, a, 2, 3, 0, 1), two = a > turned ? a : turned;
  return two[0] > two[1] ? two[0] : two[1];
}
inline float largestOf(FloatLanes a) {
  const FloatLanes half = __builtin_shufflevector(a, a, 4, 5, 6, 7, 0, 1, 2, 3), four = a > half ? a : half;
  const FloatLanes turned = __builtin_shufflevector(four, four, 2, 3, 0, 1, 6, 7, 4, 5),
                   two = four > turned ? four : turned;
  return two[0] > two[1] ? two[0] : two[1];
}
template <class V>
auto largestOf(const V& a) {
  const auto low = lowOf(a), high = highOf(a);
  return largestOf(low > high ? low : high);
}
template <class V>
auto smallestOf(const V& a) {
  return -largestOf(-a);
}

}  // namespace smokebox
