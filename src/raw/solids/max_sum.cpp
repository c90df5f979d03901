#include "raw/solids/max_sum.hpp"

#include <cassert>

namespace cloud2csg {
BestInterval max_sum_interval(std::span<const double> values) {
  assert(!values.empty());
  BestInterval best{.range = {}, .sum = values[0]};
  double sum = 0;
  std::uint32_t first = 0;
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    if (sum < 0) {
      sum = 0;
      first = i;
    }
    sum += values[i];
    if (sum > best.sum) best = {.range = {first, i}, .sum = sum};
  }
  return best;
}

}  // namespace cloud2csg
