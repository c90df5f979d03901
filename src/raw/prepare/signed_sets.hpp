#pragma once

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace cloud2csg {

/// Disjoint sets whose members have a sign relative to each other.
class SignedSets {
 public:
  explicit SignedSets(std::size_t count) : parents_(count), flipped_(count, 0), sizes_(count, 1) {
    std::iota(parents_.begin(), parents_.end(), 0U);
  }

  struct Member {
    std::uint32_t root;
    bool is_flipped;  ///< its sign is opposite to the root's
  };
  /// Shortens the way to the root. Amortised O(log n)
  Member find(std::uint32_t item) {
    std::uint32_t root = item;
    bool is_flipped = false;
    while (parents_[root] != root) {
      is_flipped = is_flipped != (flipped_[root] != 0);
      root = parents_[root];
    }
    bool rest = is_flipped;
    while (parents_[item] != root && item != root) {
      const std::uint32_t next = parents_[item];
      const bool own = flipped_[item] != 0;
      parents_[item] = root;
      flipped_[item] = rest ? 1 : 0;
      rest = rest != own;
      item = next;
    }
    return {root, is_flipped};
  }

  /// Joins the sets of two items, the signs of which are equal or opposite. Nothing when they are in one set.
  void join(std::uint32_t one, std::uint32_t other, bool are_opposite) {
    Member a = find(one);
    Member b = find(other);
    if (a.root == b.root) return;
    if (sizes_[a.root] < sizes_[b.root]) std::swap(a, b);
    parents_[b.root] = a.root;
    flipped_[b.root] = (a.is_flipped != b.is_flipped) != are_opposite ? 1 : 0;
    sizes_[a.root] += sizes_[b.root];
  }

 private:
  std::vector<std::uint32_t> parents_;
  std::vector<char> flipped_;
  std::vector<std::uint32_t> sizes_;
};

}  // namespace cloud2csg
