#include <algorithm>
#include <cassert>
#include <cmath>

#include "bench/experiment/paper.hpp"

namespace cloud2csg {

Spread spread_of(std::span<const double> values) {
  Spread spread{.count = values.size()};
  if (values.empty()) return spread;
  const auto count = static_cast<double>(values.size());
  // Relative to the first value, so that equal values have an exact mean and no deviation.
  double differences = 0;
  for (const double value : values) differences += value - values.front();
  spread.mean = values.front() + differences / count;
  if (values.size() < 2) return spread;
  double squares = 0;
  for (const double value : values) squares += (value - spread.mean) * (value - spread.mean);
  spread.deviation = std::sqrt(squares / (count - 1));
  return spread;
}

Spread ratio(const Spread& a, const Spread& b) {
  assert(b.mean != 0);
  // Avoids relative deviations, which do not exist for a.mean == 0.
  const double quotient = a.mean / b.mean;
  return {.count = std::min(a.count, b.count),
          .mean = quotient,
          .deviation = std::hypot(a.deviation, quotient * b.deviation) / std::abs(b.mean)};
}

}  // namespace cloud2csg
