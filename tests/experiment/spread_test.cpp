#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "bench/experiment/paper.hpp"

namespace cloud2csg {
namespace {

TEST(Spread, OfFourValues) {
  const Spread spread = spread_of(std::array{1.0, 2.0, 3.0, 4.0});
  EXPECT_EQ(spread.count, 4U);
  EXPECT_DOUBLE_EQ(spread.mean, 2.5);
  EXPECT_DOUBLE_EQ(spread.deviation, std::sqrt(5.0 / 3.0));
}

TEST(Spread, OfOneAndOfNone) {
  const Spread one = spread_of(std::array{7.0});
  EXPECT_EQ(one.count, 1U);
  EXPECT_EQ(one.mean, 7);
  EXPECT_EQ(one.deviation, 0);
  EXPECT_EQ(spread_of({}).count, 0U);
}

TEST(Spread, EqualValuesHaveNoDeviation) {
  const double value = 209592.314956 / 3;
  const Spread spread = spread_of(std::array{value, value, value, value, value, value, value});
  EXPECT_EQ(spread.mean, value);
  EXPECT_EQ(spread.deviation, 0);
}

TEST(Spread, RatioAddsRelativeDeviations) {
  const Spread a{.count = 5, .mean = 12, .deviation = 0.6};  // 5 %
  const Spread b{.count = 4, .mean = 4, .deviation = 0.48};  // 12 %
  const Spread quotient = ratio(a, b);
  EXPECT_EQ(quotient.count, 4U);
  EXPECT_DOUBLE_EQ(quotient.mean, 3);
  EXPECT_NEAR(quotient.deviation, 3 * 0.13, 1e-12);  // 5, 12, 13
}

TEST(Spread, RatioOfZero) {
  const Spread quotient = ratio({.count = 2, .mean = 0, .deviation = 1}, {.count = 2, .mean = 2, .deviation = 1});
  EXPECT_EQ(quotient.mean, 0);
  EXPECT_DOUBLE_EQ(quotient.deviation, 0.5);
}

}  // namespace
}  // namespace cloud2csg
