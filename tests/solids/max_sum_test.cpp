#include "raw/solids/max_sum.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>

namespace cloud2csg {
namespace {

double sum_of(const SumGrid& grid, const std::array<BinRange, 3>& ranges) {
  double sum = 0;
  for (std::uint32_t x = ranges[0].first; x <= ranges[0].last; ++x) {
    for (std::uint32_t y = ranges[1].first; y <= ranges[1].last; ++y) {
      for (std::uint32_t z = ranges[2].first; z <= ranges[2].last; ++z) {
        sum += grid.sums[(std::size_t{x} * grid.bins[1] + y) * grid.bins[2] + z];
      }
    }
  }
  return sum;
}

std::vector<BinRange> all_ranges(std::uint32_t bins) {
  std::vector<BinRange> ranges;
  for (std::uint32_t first = 0; first < bins; ++first) {
    for (std::uint32_t last = first; last < bins; ++last) ranges.push_back({first, last});
  }
  return ranges;
}

double largest_sum(const SumGrid& grid) {
  double largest = -std::numeric_limits<double>::infinity();
  for (const BinRange x : all_ranges(grid.bins[0])) {
    for (const BinRange y : all_ranges(grid.bins[1])) {
      for (const BinRange z : all_ranges(grid.bins[2])) largest = std::max(largest, sum_of(grid, {x, y, z}));
    }
  }
  return largest;
}

/// Whole numbers, so that sums are exact in any order.
SumGrid any_grid() {
  SumGrid grid;
  for (std::uint32_t& bins : grid.bins) bins = *rc::gen::inRange(1U, 6U);
  const std::size_t count = std::size_t{grid.bins[0]} * grid.bins[1] * grid.bins[2];
  for (std::size_t i = 0; i < count; ++i) grid.sums.push_back(*rc::gen::inRange(-9, 6));
  return grid;
}

RC_GTEST_PROP(MaxSumBox, IsTheLargestOfAllBoxes, ()) {
  const SumGrid grid = any_grid();
  const double largest = largest_sum(grid);
  const BestBox best = max_sum_box(grid, -100);
  RC_ASSERT(best.sum == std::max(largest, 0.0) || largest <= 0);
  if (largest > 0) RC_ASSERT(sum_of(grid, best.ranges) == largest);
}

RC_GTEST_PROP(MaxSumBox, GivesTheLeastWhereNoneIsLarger, ()) {
  const SumGrid grid = any_grid();
  const double largest = std::max(largest_sum(grid), 0.0);
  RC_ASSERT(max_sum_box(grid, largest).sum == largest);
  RC_ASSERT(max_sum_box(grid, largest + 1).sum == largest + 1);
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
