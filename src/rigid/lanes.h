// Several numbers at a time. What is done lane by lane, and summed in this order, is the same on any machine.
#pragma once
#include <cstring>
#ifdef __AVX__
#include <immintrin.h>
#endif

namespace smokebox {
// Of its own: base/lanes.h has functions of these names for sixteen floats.
inline namespace rigid_lanes {

typedef double Lanes __attribute__((vector_size(32)));
typedef float FloatLanes __attribute__((vector_size(32)));
constexpr int kLanes = 8;  // arrays are padded to this many numbers: one FloatLanes, two Lanes

template <class Number>
struct LanesOf;
template <>
struct LanesOf<double> {
  typedef Lanes Type;
  static constexpr int kCount = 4;
};
template <>
struct LanesOf<float> {
  typedef FloatLanes Type;
  static constexpr int kCount = 8;
};

inline Lanes load(const double* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
inline FloatLanes load(const float* from) {
  FloatLanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
inline void loadAs(const float* from, FloatLanes& lanes) { lanes = load(from); }
inline void loadAs(const float* from, Lanes& lanes) {
  typedef float Four __attribute__((vector_size(16)));
  Four four;
  std::memcpy(&four, from, sizeof four);
  lanes = __builtin_convertvector(four, Lanes);
}
inline void store(double* to, Lanes lanes) { std::memcpy(to, &lanes, sizeof lanes); }
inline void store(float* to, FloatLanes lanes) { std::memcpy(to, &lanes, sizeof lanes); }

/// Is any lane of a comparison set?
template <class Mask>
bool anyOf(Mask mask) {
#ifdef __AVX__
  return _mm256_movemask_pd(reinterpret_cast<__m256d>(mask)) != 0;
#else
  return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
#endif
}

inline double sumOf(Lanes lanes) { return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]); }
inline double sumOf(FloatLanes lanes) {
  double sum = 0;
  for (int l = 0; l < 8; ++l) sum += static_cast<double>(lanes[l]);
  return sum;
}

inline int roundedToLanes(int count) { return (count + kLanes - 1) / kLanes * kLanes; }

}  // namespace rigid_lanes
}  // namespace smokebox
