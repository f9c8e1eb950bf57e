#include "base/maths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "base/hash.h"

namespace smokebox {
namespace {

/// Distance in units in the last place of the truth.
double ulps(double value, long double truth) {
  const double nearest = static_cast<double>(truth);
  const double place = std::nextafter(std::fabs(nearest), INFINITY) - std::fabs(nearest);
  return static_cast<double>(std::fabs(value - truth) / place);
}

/// A fixed sequence in [0, 1).
class Sequence {
 public:
  double next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_ = 12345;
};

TEST(Maths, OrdinaryArgumentsAreWithinTwoUnitsInTheLastPlace) {
  // Truth: the C library's 80-bit functions, far more exact than what is asked of ours.
  Sequence sequence;
  double worstSin = 0, worstCos = 0, worstTan = 0, worstExp = 0, worstLog = 0;
  for (int k = 0; k < 200000; ++k) {
    const double x = (sequence.next() - 0.5) * (k % 3 == 0 ? 8 : k % 3 == 1 ? 200 : 1e5);
    const long double wide = x;
    worstSin = std::max(worstSin, ulps(exact::sin(x), std::sin(wide)));
    worstCos = std::max(worstCos, ulps(exact::cos(x), std::cos(wide)));
    worstTan = std::max(worstTan, ulps(exact::tan(x), std::tan(wide)));
    const double e = (sequence.next() - 0.5) * (k % 2 ? 2 : 1400);
    worstExp = std::max(worstExp, ulps(exact::exp(e), std::exp(static_cast<long double>(e))));
    const double l = k % 2 ? sequence.next() * 3 + 1e-9 : std::exp(e);
    worstLog = std::max(worstLog, ulps(exact::log(l), std::log(static_cast<long double>(l))));
  }
  EXPECT_LT(worstSin, 1);
  EXPECT_LT(worstCos, 1);
  EXPECT_LT(worstTan, 2);
  EXPECT_LT(worstExp, 1);
  EXPECT_LT(worstLog, 1.5);
}

TEST(Maths, HugeArgumentsAreReducedWithoutDrift) {
  // Truth: sin of 1e22 is -0.8522008497671888 (a classic check of range reduction), and the 80-bit library
  // below 2^60.
  EXPECT_DOUBLE_EQ(exact::sin(1e22), -0.8522008497671888);
  EXPECT_DOUBLE_EQ(exact::cos(1e22), 0.5232147853951389);
  EXPECT_DOUBLE_EQ(exact::sin(std::numeric_limits<double>::max()), 0.004961954789184062);
  Sequence sequence;
  for (int k = 0; k < 20000; ++k) {
    const double x = 1048576.0 * (0.5 + 1e6 * sequence.next());
    EXPECT_LT(ulps(exact::sin(x), std::sin(static_cast<long double>(x))), 1) << x;
    EXPECT_LT(ulps(exact::cos(x), std::cos(static_cast<long double>(x))), 1) << x;
  }
}

TEST(Maths, SineIsOddAndCosineEven) {
  // Truth: sin(-x) = -sin(x), cos(-x) = cos(x), to the bit.
  Sequence sequence;
  for (int k = 0; k < 10000; ++k) {
    const double x = sequence.next() * (k % 2 ? 10 : 1e9);
    EXPECT_EQ(exact::sin(-x), -exact::sin(x));
    EXPECT_EQ(exact::cos(-x), exact::cos(x));
    EXPECT_EQ(exact::tan(-x), -exact::tan(x));
  }
}

TEST(Maths, PlainValuesAreExact) {
  // Truth: values that are known without error.
  EXPECT_EQ(exact::sin(0), 0);
  EXPECT_TRUE(std::signbit(exact::sin(-0.0)));
  EXPECT_EQ(exact::cos(0), 1);
  EXPECT_EQ(exact::sin(kPi / 2), 1);
  EXPECT_EQ(exact::sin(-kPi / 2), -1);
  for (int k = 0; k <= 1000; ++k) EXPECT_EQ(exact::cos(k * kPi), k % 2 ? -1 : 1) << k;
  EXPECT_EQ(exact::exp(0), 1);
  EXPECT_EQ(exact::log(1), 0);
  EXPECT_DOUBLE_EQ(exact::exp(1), 2.718281828459045);
}

TEST(Maths, TheEndsOfTheRangeAreRight) {
  // Truth: limits of the functions, and the smallest numbers.
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(exact::exp(710), inf);
  EXPECT_EQ(exact::exp(-inf), 0);
  EXPECT_EQ(exact::exp(inf), inf);
  EXPECT_GT(exact::exp(709.78), 1e308);
  EXPECT_LT(exact::exp(709.78), inf);
  EXPECT_EQ(exact::exp(-744.5), 4.940656458412465e-324);
  EXPECT_EQ(exact::log(0), -inf);
  EXPECT_EQ(exact::log(inf), inf);
  EXPECT_TRUE(std::isnan(exact::log(-1)));
  EXPECT_NEAR(exact::log(4.940656458412465e-324), -744.4400719213812, 1e-12);
  EXPECT_TRUE(std::isnan(exact::sin(inf)));
  EXPECT_TRUE(std::isnan(exact::cos(NAN)));
  EXPECT_TRUE(std::isnan(exact::exp(NAN)));
}

TEST(Maths, PowersMultiply) {
  // Truth: products of whole numbers are exact as long as they fit.
  EXPECT_EQ(exact::power(3, 4), 81);
  EXPECT_EQ(exact::power(-2, 3), -8);
  EXPECT_EQ(exact::power(2, -2), 0.25);
  EXPECT_EQ(exact::power(0, 0), 1);
  EXPECT_EQ(exact::power(7, 1), 7);
  EXPECT_EQ(exact::power(2, 1023), std::ldexp(1.0, 1023));
  EXPECT_EQ(exact::power(2, std::numeric_limits<long>::min()), 0);
}

TEST(Maths, BitsAreTheSameEverywhere) {
  // Truth: one fingerprint of the bits of many results, whatever the compiler, its flags and the processor.
  Fnv1a hash;
  auto add = [&](double value) { hash.update(&value, sizeof value); };
  Sequence sequence;
  for (int k = 0; k < 20000; ++k) {
    const double x = (sequence.next() - 0.5) * (k % 4 == 0 ? 1e9 : 100);
    add(exact::sin(x));
    add(exact::cos(x));
    add(exact::tan(x));
    add(exact::exp(x * 0.1));
    add(exact::log(x * x));
    add(exact::power(x, k % 9 - 4));
  }
  EXPECT_EQ(hash.text(), "aa851a547cbcaee7");
}

TEST(Hash, IsTheStandardFunction) {
  // Truth: published values of FNV-1a with 64 bits.
  EXPECT_EQ(Fnv1a().text(), "cbf29ce484222325");
  Fnv1a hash;
  hash.update("foobar");
  EXPECT_EQ(hash.text(), "85944171f73967e8");
}

}  // namespace
}  // namespace smokebox
