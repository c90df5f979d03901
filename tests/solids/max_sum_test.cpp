#include "raw/solids/max_sum.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>

namespace cloud2csg {
namespace {

std::vector<BinRange> all_ranges(std::uint32_t bins) {
  std::vector<BinRange> ranges;
  for (std::uint32_t first = 0; first < bins; ++first) {
    for (std::uint32_t last = first; last < bins; ++last) ranges.push_back({first, last});
  }
  return ranges;
}

RC_GTEST_PROP(MaxSumInterval, IsTheLargestOfAllIntervals, ()) {
  const std::vector<int> whole = *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(-9, 9)));
  const std::vector<double> values(whole.begin(), whole.end());
  double largest = -std::numeric_limits<double>::infinity();
  for (const BinRange range : all_ranges(static_cast<std::uint32_t>(values.size()))) {
    double sum = 0;
    for (std::uint32_t i = range.first; i <= range.last; ++i) sum += values[i];
    largest = std::max(largest, sum);
  }
  const BestInterval best = max_sum_interval(values);
  RC_ASSERT(best.sum == largest);
  double sum = 0;
  for (std::uint32_t i = best.range.first; i <= best.range.last; ++i) sum += values[i];
  RC_ASSERT(sum == largest);
}

}  // namespace
}  // namespace cloud2csg
