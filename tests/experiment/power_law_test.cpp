#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "bench/experiment/scaling.hpp"
#include "core/base/random.hpp"

namespace cloud2csg::test {
namespace {

using Pairs = std::vector<std::pair<double, double>>;

/// 10, 20, 40... 10 240.
std::vector<double> sizes() {
  std::vector<double> sizes{10};
  while (sizes.size() < 11) sizes.push_back(2 * sizes.back());
  return sizes;
}

RC_GTEST_PROP(PowerLaw, IsFoundWhereThereIsOne, (std::uint64_t seed)) {
  RandomStream random(seed);
  const double factor = std::exp(random.uniform(-9, 9));
  const double exponent = random.uniform(-1, 4);
  Pairs pairs;
  for (const double size : sizes()) pairs.emplace_back(size, factor * std::pow(size, exponent));
  const PowerLaw law = fit_power_law(pairs);
  RC_ASSERT(law.count == pairs.size());
  RC_ASSERT(std::abs(law.exponent - exponent) < 1e-9);
  RC_ASSERT(std::abs(law.factor / factor - 1) < 1e-7);
  RC_ASSERT(law.error < 1e-6);
}

TEST(PowerLaw, HasTheErrorOfALeastSquaresFit) {
  // log y = 0, 1, 1 at log x = 0, 1, 2: slope 1/2, residuals 1/6, 1/3, 1/6 (squares 1/6), sum of squares of x 2.
  const double e = std::exp(1.0);
  const PowerLaw law = fit_power_law(Pairs{{1, 1}, {e, e}, {e * e, e}});
  EXPECT_NEAR(law.exponent, 0.5, 1e-12);
  EXPECT_NEAR(law.error, std::sqrt(1.0 / 12), 1e-12);
  EXPECT_NEAR(law.factor, std::exp(2.0 / 3 - 0.5), 1e-12);
}

/// The error is the deviation of the exponent when the experiment is repeated.
TEST(PowerLaw, ErrorIsTheSpreadOfTheExponent) {
  constexpr int k_experiments = 400;
  double squares = 0;
  double error = 0;
  for (int i = 0; i < k_experiments; ++i) {
    RandomStream random(1, 2, static_cast<std::uint64_t>(i));
    Pairs pairs;
    for (const double size : sizes()) pairs.emplace_back(size, size * std::exp(0.2 * random.normal()));
    const PowerLaw law = fit_power_law(pairs);
    squares += (law.exponent - 1) * (law.exponent - 1) / k_experiments;
    error += law.error / k_experiments;
  }
  EXPECT_NEAR(std::sqrt(squares) / error, 1, 0.15);
}

TEST(PowerLaw, NeedsTwoSizes) {
  EXPECT_EQ(fit_power_law({}).count, 0U);
  EXPECT_EQ(fit_power_law(Pairs{{10, 5}}).count, 0U);
  EXPECT_EQ(fit_power_law(Pairs{{10, 5}, {10, 6}, {10, 7}}).count, 0U);
  const PowerLaw two = fit_power_law(Pairs{{10, 5}, {100, 500}});
  EXPECT_NEAR(two.exponent, 2, 1e-12);
  EXPECT_EQ(two.error, 0);
}

TEST(PowerLaw, LeavesOutWhatHasNoLogarithm) {
  const PowerLaw law = fit_power_law(Pairs{{10, 0}, {10, 10}, {100, 100}, {1000, -1}, {1000, 1000}});
  EXPECT_EQ(law.count, 3U);
  EXPECT_NEAR(law.exponent, 1, 1e-12);
}

}  // namespace
}  // namespace cloud2csg::test
