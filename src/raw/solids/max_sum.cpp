#include "raw/solids/max_sum.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace cloud2csg {
namespace {

void add(std::span<double> to, std::span<const double> values) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += values[i];
}

/// The grid with permuted sides: side i of the result is side order[i] of the grid.
SumGrid reordered(const SumGrid& grid, const std::array<std::size_t, 3>& order) {
  SumGrid result{.bins = {grid.bins[order[0]], grid.bins[order[1]], grid.bins[order[2]]},
                 .sums = std::vector<double>(grid.sums.size())};
  std::array<std::uint32_t, 3> at{};
  std::size_t from = 0;
  for (at[0] = 0; at[0] < grid.bins[0]; ++at[0]) {
    for (at[1] = 0; at[1] < grid.bins[1]; ++at[1]) {
      for (at[2] = 0; at[2] < grid.bins[2]; ++at[2]) {
        const std::size_t to =
            (std::size_t{at[order[0]]} * result.bins[1] + at[order[1]]) * result.bins[2] + at[order[2]];
        result.sums[to] = grid.sums[from++];
      }
    }
  }
  return result;
}

class BoxSearch {
 public:
  BoxSearch(const SumGrid& grid, double least) : grid_(grid), best_{.ranges = {}, .sum = least} {}

  BestBox run() {
    const std::size_t layer = std::size_t{grid_.bins[1]} * grid_.bins[2];
    std::vector<double> positive_from(grid_.bins[0] + 1, 0.0);
    for (std::uint32_t x = grid_.bins[0]; x-- > 0;) {
      positive_from[x] = positive_from[x + 1] + positive_sum(std::span(grid_.sums).subspan(x * layer, layer));
    }
    std::vector<double> slab(layer);
    for (std::uint32_t first = 0; first < grid_.bins[0]; ++first) {
      if (positive_from[first] <= best_.sum) break;
      std::ranges::fill(slab, 0.0);
      for (std::uint32_t last = first; last < grid_.bins[0]; ++last) {
        add(slab, std::span(grid_.sums).subspan(last * layer, layer));
        search_slab(slab, {first, last});
      }
    }
    return best_;
  }

 private:
  void search_slab(std::span<const double> slab, BinRange x) {
    const std::size_t rows = grid_.bins[1];
    const std::size_t length = grid_.bins[2];
    positive_.assign(rows + 1, 0.0);
    for (std::size_t y = rows; y-- > 0;) {
      positive_[y] = positive_[y + 1] + positive_sum(slab.subspan(y * length, length));
    }
    row_.resize(length);
    for (std::uint32_t first = 0; first < rows; ++first) {
      if (positive_[first] <= best_.sum) return;
      std::ranges::fill(row_, 0.0);
      for (std::uint32_t last = first; last < rows; ++last) {
        add(row_, slab.subspan(last * length, length));
        if (positive_sum(row_) <= best_.sum) continue;
        const BestInterval interval = max_sum_interval(row_);
        if (interval.sum > best_.sum)
          best_ = {.ranges = {x, BinRange{first, last}, interval.range}, .sum = interval.sum};
      }
    }
  }

  const SumGrid& grid_;
  BestBox best_;
  std::vector<double> positive_, row_;
};

}  // namespace

double positive_sum(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += std::max(value, 0.0);
  return sum;
}

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

BestBox max_sum_box(const SumGrid& grid, double least) {
  assert(grid.sums.size() == std::size_t{grid.bins[0]} * grid.bins[1] * grid.bins[2]);
  std::array<std::size_t, 3> order{0, 1, 2};
  std::ranges::stable_sort(order, {}, [&](std::size_t side) { return grid.bins[side]; });
  const BestBox found = BoxSearch(reordered(grid, order), least).run();
  BestBox best{.ranges = {}, .sum = found.sum};
  for (std::size_t i = 0; i < 3; ++i) best.ranges[order[i]] = found.ranges[i];
  return best;
}

}  // namespace cloud2csg
