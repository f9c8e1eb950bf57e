#include "scene/expression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/maths.h"

namespace smokebox {
namespace {

double value(const std::string& text) { return Expression::parse(text, "")(0, 0, 0); }

std::string faultOf(const std::string& text, const std::string& variables = "xyt") {
  try {
    Expression::parse(text, variables);
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
  return "no fault";
}

TEST(Expression, ArithmeticFollowsTheUsualRules) {
  // Truth: results worked out by hand.
  EXPECT_EQ(value("1/120"), 1.0 / 120);
  EXPECT_EQ(value("2*pi"), 2 * kPi);
  EXPECT_EQ(value("1+2*3"), 7);
  EXPECT_EQ(value("10-4-3"), 3);
  EXPECT_EQ(value("16/4/2"), 2);
  EXPECT_EQ(value("(1+2)*3"), 9);
  EXPECT_EQ(value("-2^2"), -4);
  EXPECT_EQ(value("2^-2"), 0.25);
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("2^(1+2)"), 8);
  EXPECT_EQ(value("5--3"), 8);
  EXPECT_EQ(value("2*-3"), -6);
  EXPECT_EQ(value("+4"), 4);
  EXPECT_EQ(value("010"), 10);
  EXPECT_EQ(value("1e3+.5"), 1000.5);
  EXPECT_EQ(value(" 7 "), 7);
}

TEST(Expression, ComparisonsChoose) {
  // Truth: a true comparison is 1, a false one 0, and ?: takes the branch.
  EXPECT_EQ(value("1 < 2 ? 3 : 4"), 3);
  EXPECT_EQ(value("1 >= 2 ? 3 : 4"), 4);
  EXPECT_EQ(value("(1 == 1) + (1 != 1) + (2 <= 2) + (3 > 2)"), 3);
  EXPECT_EQ(value("1 < 2 && 3 < 2 ? 5 : 6"), 6);
  EXPECT_EQ(value("1 < 2 || 3 < 2 ? 5 : 6"), 5);
  const Expression step = Expression::parse("t < 1 ? 0 : (t < 2 ? 1 : 2)", "t");
  EXPECT_EQ(step(0, 0, 0.5), 0);
  EXPECT_EQ(step(0, 0, 1.5), 1);
  EXPECT_EQ(step(0, 0, 2.5), 2);
}

TEST(Expression, FunctionsAreOurOwn) {
  // Truth: the very bits of exact::*, never the C library's.
  for (double x : {0.1, 0.7, 1.9, 3.3, 55.5}) {
    EXPECT_EQ(Expression::parse("sin(x)", "x")(x, 0, 0), exact::sin(x));
    EXPECT_EQ(Expression::parse("cos(x)", "x")(x, 0, 0), exact::cos(x));
    EXPECT_EQ(Expression::parse("tan(x)", "x")(x, 0, 0), exact::tan(x));
    EXPECT_EQ(Expression::parse("exp(x)", "x")(x, 0, 0), exact::exp(x));
    EXPECT_EQ(Expression::parse("log(x)", "x")(x, 0, 0), exact::log(x));
    EXPECT_EQ(Expression::parse("x^7", "x")(x, 0, 0), exact::power(x, 7));
    EXPECT_EQ(Expression::parse("x^2", "x")(x, 0, 0), x * x);
  }
  EXPECT_EQ(value("sqrt(2)"), std::sqrt(2.0));
  EXPECT_EQ(value("abs(-3)+min(4,2,3)+max(1,5)+floor(-0.5)"), 9);
}

TEST(Expression, VariablesAreWhereTheyBelong) {
  // Truth: the inflow profile of the cylinder benchmark has its peak 1 in the middle of the channel.
  const Expression profile = Expression::parse("4*y*(0.41-y)/0.41^2", "xyt");
  EXPECT_DOUBLE_EQ(profile(9, 0.205, 9), 1);
  EXPECT_FALSE(profile.isConstant());
  EXPECT_FALSE(profile.dependsOnTime());
  EXPECT_TRUE(Expression::parse("sin(2*pi*t)", "t").dependsOnTime());
  EXPECT_TRUE(Expression::parse("sin(2*pi)", "t").isConstant());
  EXPECT_EQ(Expression()(1, 2, 3), 0);
  EXPECT_EQ(Expression(5)(1, 2, 3), 5);
}

TEST(Expression, FaultsSayWhatAndWhere) {
  // Truth: each text is wrong in the way that its message must name.
  EXPECT_NE(faultOf("sinn(t)").find("did you mean `sin`?"), std::string::npos) << faultOf("sinn(t)");
  EXPECT_NE(faultOf("velocity*2").find("known: x, y, t, pi, sin"), std::string::npos)
      << faultOf("velocity*2");
  EXPECT_NE(faultOf("2*x", "t").find("`x` cannot be used here"), std::string::npos) << faultOf("2*x", "t");
  EXPECT_NE(faultOf("x^0.5").find("whole number"), std::string::npos) << faultOf("x^0.5");
  EXPECT_NE(faultOf("x^y").find("whole number"), std::string::npos) << faultOf("x^y");
  EXPECT_NE(faultOf("2^(1/2)").find("whole number"), std::string::npos);
  EXPECT_NE(faultOf("2^sin(0)").find("whole number"), std::string::npos);
  EXPECT_NE(faultOf("(1+2").find("parenthesis is not closed"), std::string::npos) << faultOf("(1+2");
  EXPECT_NE(faultOf("1+2)").find("parenthesis too many"), std::string::npos) << faultOf("1+2)");
  EXPECT_NE(faultOf("1+").find("missing at the end"), std::string::npos) << faultOf("1+");
  EXPECT_NE(faultOf("1 2").find("near `2`"), std::string::npos) << faultOf("1 2");
  EXPECT_NE(faultOf("1, 2").find("comma"), std::string::npos) << faultOf("1, 2");
  EXPECT_NE(faultOf("sin(1, 2)").find("too many values"), std::string::npos) << faultOf("sin(1, 2)");
  EXPECT_NE(faultOf("x = 3").find("near `= 3`"), std::string::npos) << faultOf("x = 3");
  EXPECT_NE(faultOf("3 $ 4").find("near `$ 4`"), std::string::npos) << faultOf("3 $ 4");
  EXPECT_NE(faultOf("\"a\"").find("does not belong"), std::string::npos) << faultOf("\"a\"");
  EXPECT_NE(faultOf("t < 1 ? 2").find("`?` and `:`"), std::string::npos) << faultOf("t < 1 ? 2");
  EXPECT_NE(faultOf("  ").find("empty"), std::string::npos);
  EXPECT_NE(faultOf(std::string(5000, '1')).find("too long"), std::string::npos);
  EXPECT_NE(faultOf("sin").find("sin"), std::string::npos);
}

TEST(Expression, NestedPowersAreCheckedInReasonableTime) {
  // Truth: a tower of 200 nested exponents, all ones, is one; checking must not double at every level.
  std::string text = "1";
  for (int k = 0; k < 200; ++k) text = "1^(" + text + ")";
  EXPECT_EQ(value(text), 1);
}

TEST(Expression, ManyThreadsShareOneProgram) {
  // Truth: every thread gets the value of its own arguments.
  const Expression shared = Expression::parse("x + 10*y + 100*t", "xyt");
  std::vector<std::thread> threads;
  std::vector<int> wrong(4, 0);
  for (int k = 0; k < 4; ++k)
    threads.emplace_back([&, k, copy = shared] {
      for (int n = 0; n < 5000; ++n) wrong[k] += copy(k, n, 1) != k + 10.0 * n + 100;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

}  // namespace
}  // namespace smokebox
