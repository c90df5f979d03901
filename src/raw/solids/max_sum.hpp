#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace cloud2csg {

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

}  // namespace cloud2csg
