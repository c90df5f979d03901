#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

namespace cloud2csg {

/// The median, the upper one for an even count. Reorders the values. O(n) Precondition: not empty.
inline double median_of(std::vector<double>& values) {
  assert(!values.empty());
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Standard deviation of a normal distribution around zero, from the median. Reorders. O(n) Precondition: not empty.
inline double robust_deviation(std::vector<double>& absolute_values) {
  return 1.4826 * median_of(absolute_values);
}

}  // namespace cloud2csg
