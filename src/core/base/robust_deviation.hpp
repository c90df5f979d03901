#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

namespace cloud2csg {

/// Standard deviation of a normal distribution around zero from the median of absolute values. Reorders them. O(n)
/// Precondition: not empty.
inline double robust_deviation(std::vector<double>& absolute_values) {
  assert(!absolute_values.empty());
  const auto middle = absolute_values.begin() + static_cast<std::ptrdiff_t>(absolute_values.size() / 2);
  std::nth_element(absolute_values.begin(), middle, absolute_values.end());
  return 1.4826 * *middle;
}

}  // namespace cloud2csg
