#include <boost/math/distributions/students_t.hpp>
#include <cassert>
#include <cmath>

#include "bench/experiment/paper.hpp"

namespace cloud2csg {

double welch_test(const Spread& a, const Spread& b) {
  assert(a.count >= 2 && b.count >= 2);
  const auto variance_of_mean = [](const Spread& s) {
    return s.deviation * s.deviation / static_cast<double>(s.count);
  };
  const double va = variance_of_mean(a);
  const double vb = variance_of_mean(b);
  const double difference = std::abs(a.mean - b.mean);
  if (va + vb == 0) return difference == 0 ? 1 : 0;
  // Degrees of freedom by Welch and Satterthwaite.
  const double freedom =
      (va + vb) * (va + vb) / (va * va / static_cast<double>(a.count - 1) + vb * vb / static_cast<double>(b.count - 1));
  const boost::math::students_t distribution(freedom);
  return 2 * boost::math::cdf(boost::math::complement(distribution, difference / std::sqrt(va + vb)));
}

}  // namespace cloud2csg
