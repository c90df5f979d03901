#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace cloud2csg {

/// Disjoint sets of the numbers 0 .. count - 1 (union-find). At first each number is alone.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }

  /// The representative of the set that holds `thing`: its smallest member. Nearly O(1)
  [[nodiscard]] std::size_t root(std::size_t thing) {
    while (parent_[thing] != thing) thing = parent_[thing] = parent_[parent_[thing]];
    return thing;
  }

  void join(std::size_t one, std::size_t other) {
    const std::size_t a = root(one);
    const std::size_t b = root(other);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace cloud2csg
