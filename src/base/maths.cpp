#include "base/maths.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace smokebox::exact {
namespace {

/// A number as the sum of two doubles, the second far below the last place of the first.
struct Pair {
  double high = 0, low = 0;
};

Pair difference(double a, double b) {  // a - b without error (Knuth)
  const double d = a - b, back = a - d;
  return {d, (back - b) + (a - (d + back))};
}

Pair product(double a,
             double b) {  // a b without error (Veltkamp, Dekker); no overflow for what it is used on
  constexpr double kSplit = 134217729;  // 2^27 + 1
  const double as = kSplit * a, a1 = as - (as - a), a2 = a - a1;
  const double bs = kSplit * b, b1 = bs - (bs - b), b2 = b - b1;
  const double p = a * b;
  return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
}

/// 2^exponent for a normal number.
double powerOfTwo(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

// --- reduction to [-pi/4, pi/4]
// ---------------------------------------------------------------------------------------
struct Reduced {
  unsigned quadrant = 0;  // modulo 4
  Pair rest;
};

constexpr double kPlainLimit = 1 << 20;  // up to here the multiples of the parts of pi/2 below are exact

/// x minus the nearest multiple of pi/2, which is held as four parts; the first three have 33 bits each, so
/// that their products with a whole number below 2^20 carry no error (Cody and Waite).
Reduced reducePlain(double x) {
  constexpr double kPart1 = 0x1.921fb54400000p+0, kPart2 = 0x1.0b4611a600000p-34,
                   kPart3 = 0x1.3198a2e000000p-69, kPart4 = 0x1.b839a252049c1p-104;
  const double n = std::nearbyint(x * (2 / kPi));
  const double first = x - n * kPart1;
  const Pair second = difference(first, n * kPart2);
  const Pair third = difference(second.high, n * kPart3);
  const double low = third.low + (second.low - n * kPart4);
  const double high = third.high + low;
  return {static_cast<unsigned>(static_cast<std::int64_t>(n)) & 3u, {high, (third.high - high) + low}};
}

/// The same for arguments of any size: multiplies by as many bits of 2/pi as matter (Payne and Hanek).
Reduced reduceHuge(double x) {
  // 2/pi in binary, behind one word of zeros.
  static constexpr std::uint64_t kTwoOverPi[] = {0,
                                                 0xa2f9836e4e441529,
                                                 0xfc2757d1f534ddc0,
                                                 0xdb6295993c439041,
                                                 0xfe5163abdebbc561,
                                                 0xb7246e3a424dd2e0,
                                                 0x06492eea09d1921c,
                                                 0xfe1deb1cb129a73e,
                                                 0xe88235f52ebb4484,
                                                 0xe99c7026b45f7e41,
                                                 0x3991d639835339f4,
                                                 0x9c845f8bbdf9283b,
                                                 0x1ff897ffde05980f,
                                                 0xef2f118b5a0a6d1f,
                                                 0x6d367ecf27cb09b7,
                                                 0x4f463f669e5fea2d,
                                                 0x7527bac7ebe5f17b,
                                                 0x3d0739f78a5292ea,
                                                 0x6bfb5fb11f8d5d08,
                                                 0x56033046fc7b6bab};
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const int exponent = static_cast<int>(bits >> 52 & 0x7ff) - 1075;  // x = mantissa 2^exponent
  const std::uint64_t mantissa = (bits & 0xfffffffffffff) | 0x10000000000000;

  // Bits of 2/pi of weight above 2^(1 - exponent) give multiples of 4. Three words from there on, times the
  // mantissa, modulo 2^192: two bits of the quadrant, then 190 bits of the fraction.
  const int start = exponent - 2 + 64, word = start / 64, shift = start % 64;
  std::uint64_t window[3];
  for (int k = 0; k < 3; ++k) {
    window[k] = kTwoOverPi[word + k] << shift;
    if (shift > 0) window[k] |= kTwoOverPi[word + k + 1] >> (64 - shift);
  }
  __extension__ using Wide = unsigned __int128;
  std::uint64_t result[3];
  Wide carry = 0;
  for (int k = 2; k >= 0; --k) {
    carry += static_cast<Wide>(window[k]) * mantissa;
    result[k] = static_cast<std::uint64_t>(carry);
    carry >>= 64;
  }
  unsigned quadrant = static_cast<unsigned>(result[0] >> 62);
  std::uint64_t f0 = result[0] << 2 | result[1] >> 62, f1 = result[1] << 2 | result[2] >> 62,
                f2 = result[2] << 2;
  const bool above = f0 >> 63;  // more than a half: from the next multiple downwards
  if (above) {
    ++quadrant;
    f2 = ~f2 + 1;
    f1 = ~f1 + (f2 == 0);
    f0 = ~f0 + (f2 == 0 && f1 == 0);
  }
  int lead = 0;
  while (lead < 128 && !(f0 >> 63)) {
    f0 = f0 << 1 | f1 >> 63;
    f1 = f1 << 1 | f2 >> 63;
    f2 <<= 1;
    ++lead;
  }
  double high = static_cast<double>(f0 >> 11) * powerOfTwo(-53 - lead);
  double low = static_cast<double>((f0 & 0x7ff) << 42 | f1 >> 22) * powerOfTwo(-106 - lead);
  if (above) high = -high, low = -low;
  constexpr double kHalfPi = 0x1.921fb54442d18p+0, kHalfPiLow = 0x1.1a62633145c07p-54;
  const Pair turned = product(high, kHalfPi);
  const double tail = turned.low + (high * kHalfPiLow + low * kHalfPi);
  const double sum = turned.high + tail;
  return {quadrant & 3u, {sum, (turned.high - sum) + tail}};
}

Reduced reduce(double x) { return x < kPlainLimit ? reducePlain(x) : reduceHuge(x); }

// --- on [-pi/4, pi/4]: Taylor polynomials, whose next term is below 1e-19
// ------------------------------------------------
double sinNear(Pair r) {
  const double x = r.high, z = x * x;
  double sum = 1 / 355687428096000.0;
  sum = sum * z - 1 / 1307674368000.0;
  sum = sum * z + 1 / 6227020800.0;
  sum = sum * z - 1 / 39916800.0;
  sum = sum * z + 1 / 362880.0;
  sum = sum * z - 1 / 5040.0;
  sum = sum * z + 1 / 120.0;
  sum = sum * z - 1 / 6.0;
  return x + (x * z * sum + r.low * (1 - 0.5 * z));
}

double cosNear(Pair r) {
  const double x = r.high, z = x * x;
  double sum = 1 / 20922789888000.0;
  sum = sum * z - 1 / 87178291200.0;
  sum = sum * z + 1 / 479001600.0;
  sum = sum * z - 1 / 3628800.0;
  sum = sum * z + 1 / 40320.0;
  sum = sum * z - 1 / 720.0;
  sum = sum * z + 1 / 24.0;
  const double half = 0.5 * z, one = 1 - half;
  return one + (((1 - one) - half) + (z * z * sum - x * r.low));
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLog2High = 0x1.62e42fee00000p-1, kLog2Low = 0x1.a39ef35793c76p-33;  // the first has 32 bits

}  // namespace

double sin(double x) {
  if (!std::isfinite(x)) return kNaN;
  const double size = std::fabs(x);
  if (size < 0x1p-27) return x;  // keeps the sign of zero
  const Reduced r = reduce(size);
  double value = r.quadrant & 1 ? cosNear(r.rest) : sinNear(r.rest);
  if (r.quadrant & 2) value = -value;
  return x < 0 ? -value : value;
}

double cos(double x) {
  if (!std::isfinite(x)) return kNaN;
  const Reduced r = reduce(std::fabs(x));
  const double value = r.quadrant & 1 ? sinNear(r.rest) : cosNear(r.rest);
  return r.quadrant == 1 || r.quadrant == 2 ? -value : value;
}

double tan(double x) {
  if (!std::isfinite(x)) return kNaN;
  const double size = std::fabs(x);
  if (size < 0x1p-27) return x;
  const Reduced r = reduce(size);
  const double s = sinNear(r.rest), c = cosNear(r.rest);
  const double value = r.quadrant & 1 ? -c / s : s / c;
  return x < 0 ? -value : value;
}

double exp(double x) {
  if (std::isnan(x)) return x;
  if (x > 709.79) return kInfinity;
  if (x < -745.2) return 0;
  const double n = std::nearbyint(x * (1 / (kLog2High + kLog2Low)));
  const double high = x - n * kLog2High, low = n * kLog2Low;
  const double r = high - low, rest = (high - r) - low;
  // e^r - 1 - r on [-0.35, 0.35]
  double sum = 1 / 6227020800.0;
  sum = sum * r + 1 / 479001600.0;
  sum = sum * r + 1 / 39916800.0;
  sum = sum * r + 1 / 3628800.0;
  sum = sum * r + 1 / 362880.0;
  sum = sum * r + 1 / 40320.0;
  sum = sum * r + 1 / 5040.0;
  sum = sum * r + 1 / 720.0;
  sum = sum * r + 1 / 120.0;
  sum = sum * r + 1 / 24.0;
  sum = sum * r + 1 / 6.0;
  sum = sum * r + 0.5;
  const double value = 1 + (r + (r * r * sum + rest));
  // In two steps, so that results near the smallest and the largest numbers are reached.
  const int exponent = static_cast<int>(n), half = exponent / 2;
  return value * powerOfTwo(half) * powerOfTwo(exponent - half);
}

double log(double x) {
  if (std::isnan(x) || x < 0) return kNaN;
  if (x == 0) return -kInfinity;
  if (x == kInfinity) return x;
  int exponent = 0;
  if (x < 0x1p-1022) {
    x *= 0x1p54;
    exponent = -54;
  }
  auto bits = std::bit_cast<std::uint64_t>(x);
  exponent += static_cast<int>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & 0xfffffffffffff) | 0x3ff0000000000000);
  if (m > 1.4142135623730951) {
    m *= 0.5;
    ++exponent;
  }
  // log(1 + f) = 2 artanh(s) with s = f / (2 + f); 2 s = f - s f leaves f itself, without error, in front.
  const double f = m - 1, s = f / (2 + f), z = s * s;
  double sum = 2 / 25.0;
  for (int odd = 23; odd >= 3; odd -= 2) sum = sum * z + 2.0 / odd;
  const double half = 0.5 * f * f, n = exponent;
  return n * kLog2High + (f - (half - (s * (half + z * sum) + n * kLog2Low)));
}

double power(double x, long exponent) {
  const bool negative = exponent < 0;
  auto left = negative ? 0ul - static_cast<unsigned long>(exponent) : static_cast<unsigned long>(exponent);
  double result = 1, square = x;
  while (left > 0) {
    if (left & 1) result *= square;
    left >>= 1;
    if (left > 0) square *= square;
  }
  return negative ? 1 / result : result;
}

}  // namespace smokebox::exact
