// What lanes.h is made of where the machine's vectors are narrower than 16 floats: packs of halves, down to
// one vector. The compiler takes such a pack apart into registers. Each operation is done lane by lane, as in
// one wide vector; masks hold -1 or 0.
#pragma once

namespace smokebox {

#ifdef __AVX2__
constexpr int kVectorLanes = 8;
#else
constexpr int kVectorLanes = 4;
#endif

#ifndef SMOKEBOX_INLINE
#define SMOKEBOX_INLINE inline __attribute__((always_inline))
#endif

template <class T, int n>
class Pack {
 public:
  using Half = Pack<T, n / 2>;
  Half low, high;

  Pack() = default;
  SMOKEBOX_INLINE Pack(T all) : low(all), high(all) {}
  SMOKEBOX_INLINE Pack(const Half& first, const Half& second) : low(first), high(second) {}

  static SMOKEBOX_INLINE Pack at(const T* p) { return {Half::at(p), Half::at(p + n / 2)}; }
  SMOKEBOX_INLINE void to(T* p) const { low.to(p), high.to(p + n / 2); }
  static SMOKEBOX_INLINE Pack numbers(int first) {
    return {Half::numbers(first), Half::numbers(first + n / 2)};
  }
  SMOKEBOX_INLINE T operator[](int k) const { return k < n / 2 ? low[k] : high[k - n / 2]; }
};

/// One vector of the machine.
template <class T>
class Pack<T, kVectorLanes> {
 public:
  typedef T Vector __attribute__((vector_size(kVectorLanes * sizeof(T))));
  typedef T Anywhere __attribute__((vector_size(kVectorLanes * sizeof(T)), aligned(4), may_alias));
  Vector v;

  Pack() = default;
  SMOKEBOX_INLINE Pack(T all) : v(Vector{} + all) {}
  SMOKEBOX_INLINE Pack(const Vector& vector) : v(vector) {}

  static SMOKEBOX_INLINE Pack at(const T* p) { return Vector(*reinterpret_cast<const Anywhere*>(p)); }
  SMOKEBOX_INLINE void to(T* p) const { *reinterpret_cast<Anywhere*>(p) = v; }
  static SMOKEBOX_INLINE Pack numbers(int first) {
    if constexpr (kVectorLanes == 8)
      return Vector{0, 1, 2, 3, 4, 5, 6, 7} + first;
    else
      return Vector{0, 1, 2, 3} + first;
  }
  SMOKEBOX_INLINE T operator[](int k) const { return v[k]; }
};

#define SMOKEBOX_OPERATOR(op, result)                                                     \
  template <class T, int n>                                                               \
  SMOKEBOX_INLINE Pack<result, n> operator op(const Pack<T, n>& a, const Pack<T, n>& b) { \
    if constexpr (n == kVectorLanes)                                                      \
      return Pack<result, n>(a.v op b.v);                                                 \
    else                                                                                  \
      return {a.low op b.low, a.high op b.high};                                          \
  }                                                                                       \
  template <class T, int n>                                                               \
  SMOKEBOX_INLINE Pack<result, n> operator op(const Pack<T, n>& a, T b) {                 \
    return a op Pack<T, n>(b);                                                            \
  }                                                                                       \
  template <class T, int n>                                                               \
  SMOKEBOX_INLINE Pack<result, n> operator op(T a, const Pack<T, n>& b) {                 \
    return Pack<T, n>(a) op b;                                                            \
  }

SMOKEBOX_OPERATOR(+, T)
SMOKEBOX_OPERATOR(-, T)
SMOKEBOX_OPERATOR(*, T)
SMOKEBOX_OPERATOR(/, T)
SMOKEBOX_OPERATOR(&, T)
SMOKEBOX_OPERATOR(|, T)
SMOKEBOX_OPERATOR(^, T)
SMOKEBOX_OPERATOR(==, int)
SMOKEBOX_OPERATOR(!=, int)
SMOKEBOX_OPERATOR(<, int)
SMOKEBOX_OPERATOR(>, int)
SMOKEBOX_OPERATOR(<=, int)
SMOKEBOX_OPERATOR(>=, int)
#undef SMOKEBOX_OPERATOR

template <class T, int n>
SMOKEBOX_INLINE Pack<T, n>& operator+=(Pack<T, n>& a, const Pack<T, n>& b) {
  return a = a + b;
}

template <int n>
SMOKEBOX_INLINE Pack<int, n> operator~(const Pack<int, n>& a) {
  return a ^ -1;
}

template <class T, int n>
SMOKEBOX_INLINE Pack<T, n> select(const Pack<int, n>& mask, const Pack<T, n>& a, const Pack<T, n>& b) {
  if constexpr (n == kVectorLanes)
    return Pack<T, n>(mask.v ? a.v : b.v);
  else
    return {select(mask.low, a.low, b.low), select(mask.high, a.high, b.high)};
}

template <int n>
SMOKEBOX_INLINE Pack<int, n> bitsOfFloats(const Pack<float, n>& a) {
  if constexpr (n == kVectorLanes)
    return Pack<int, n>((typename Pack<int, n>::Vector)a.v);
  else
    return {bitsOfFloats(a.low), bitsOfFloats(a.high)};
}

template <int n>
SMOKEBOX_INLINE Pack<float, n> floatsOfBits(const Pack<int, n>& a) {
  if constexpr (n == kVectorLanes)
    return Pack<float, n>((typename Pack<float, n>::Vector)a.v);
  else
    return {floatsOfBits(a.low), floatsOfBits(a.high)};
}

template <int n>
SMOKEBOX_INLINE Pack<float, n> evenLanes(const Pack<float, n>& a, const Pack<float, n>& b) {
  if constexpr (n > kVectorLanes)
    return {evenLanes(a.low, a.high), evenLanes(b.low, b.high)};
  else if constexpr (n == 8)
    return Pack<float, n>(__builtin_shufflevector(a.v, b.v, 0, 2, 4, 6, 8, 10, 12, 14));
  else
    return Pack<float, n>(__builtin_shufflevector(a.v, b.v, 0, 2, 4, 6));
}

template <int n>
SMOKEBOX_INLINE Pack<float, n> oddLanes(const Pack<float, n>& a, const Pack<float, n>& b) {
  if constexpr (n > kVectorLanes)
    return {oddLanes(a.low, a.high), oddLanes(b.low, b.high)};
  else if constexpr (n == 8)
    return Pack<float, n>(__builtin_shufflevector(a.v, b.v, 1, 3, 5, 7, 9, 11, 13, 15));
  else
    return Pack<float, n>(__builtin_shufflevector(a.v, b.v, 1, 3, 5, 7));
}

template <int n>
SMOKEBOX_INLINE Pack<float, n> lastAndRest(const Pack<float, n>& a, const Pack<float, n>& b) {
  if constexpr (n > kVectorLanes)
    return {lastAndRest(a.high, b.low), lastAndRest(b.low, b.high)};
  else if constexpr (n == 8)
    return Pack<float, n>(__builtin_shufflevector(a.v, b.v, 7, 8, 9, 10, 11, 12, 13, 14));
  else
    return Pack<float, n>(__builtin_shufflevector(a.v, b.v, 3, 4, 5, 6));
}

template <int n = 16>
SMOKEBOX_INLINE Pack<float, n> loadTwice(const float* p) {
  if constexpr (n > kVectorLanes) {
    return {loadTwice<n / 2>(p), loadTwice<n / 2>(p + n / 4)};
  } else {
    const auto v = Pack<float, n>::at(p).v;
    if constexpr (n == 8)
      return Pack<float, n>(__builtin_shufflevector(v, v, 0, 0, 1, 1, 2, 2, 3, 3));
    else
      return Pack<float, n>(__builtin_shufflevector(v, v, 0, 0, 1, 1));
  }
}

template <int n = 16>
SMOKEBOX_INLINE Pack<float, n> loadTwiceFromMiddle(const float* p) {
  if constexpr (n > kVectorLanes) {
    return {loadTwiceFromMiddle<n / 2>(p), loadTwiceFromMiddle<n / 2>(p + n / 4)};
  } else {
    const auto v = Pack<float, n>::at(p).v;
    if constexpr (n == 8)
      return Pack<float, n>(__builtin_shufflevector(v, v, 0, 1, 1, 2, 2, 3, 3, 4));
    else
      return Pack<float, n>(__builtin_shufflevector(v, v, 0, 1, 1, 2));
  }
}

}  // namespace smokebox
