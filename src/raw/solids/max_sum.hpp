#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

/// Parts of a grid whose sum is largest.
namespace cloud2csg {

/// The sum of the values above zero: no part of them has a larger one.
[[nodiscard]] double positive_sum(std::span<const double> values);

/// Of bins: both ends belong to it.
struct BinRange {
  std::uint32_t first = 0, last = 0;
  friend bool operator==(const BinRange&, const BinRange&) = default;
};

struct BestInterval {
  BinRange range = {};
  double sum = 0;
};
/// The interval of at least one bin with the largest sum (Kadane); of equal ones the first. O(n).
/// Precondition: there is a bin.
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
/// The box of bins with the largest sum, where that is more than `least`; else `least` and no box in particular. Pairs
/// of slabs along the shorter sides, an interval along the longest: O(a^2 b^2 c) at worst; what cannot exceed the best
/// so far, since even all that is positive in it does not, is skipped.
[[nodiscard]] BestBox max_sum_box(const SumGrid& grid, double least);

}  // namespace cloud2csg
