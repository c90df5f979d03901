#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace cloud2csg {

/// The sum of the positive values: an upper bound for any subset.
[[nodiscard]] double positive_sum(std::span<const double> values);

/// A range of bins, both ends included.
struct BinRange {
  std::uint32_t first = 0, last = 0;
  friend bool operator==(const BinRange&, const BinRange&) = default;
};

struct BestInterval {
  BinRange range = {};
  double sum = 0;
};
/// The interval of at least one bin with the largest sum (Kadane); the first on ties. O(n). Precondition: not empty.
[[nodiscard]] BestInterval max_sum_interval(std::span<const double> values);

/// A grid of sums, the third index fastest.
struct SumGrid {
  std::array<std::uint32_t, 3> bins = {};
  std::vector<double> sums = {};
};
struct BestBox {
  std::array<BinRange, 3> ranges = {};
  double sum = 0;
};
/// The box of bins with the largest sum above `least`; without one, `least` and an arbitrary box. Combines slabs along
/// the shorter sides with an interval along the longest: O(a^2 b^2 c) at worst. Skips what cannot exceed the best.
[[nodiscard]] BestBox max_sum_box(const SumGrid& grid, double least);

}  // namespace cloud2csg
