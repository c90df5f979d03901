#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace cloud2csg {

/// Some of the rows of a function, a bit each; a formula is known by the rows where it is true.
template <std::size_t Words>
struct RowSet {
  std::array<std::uint64_t, Words> words{};

  void insert(std::size_t row) { words[row / 64] |= std::uint64_t{1} << (row % 64); }
  [[nodiscard]] bool contains(std::size_t row) const { return (words[row / 64] >> (row % 64) & 1U) != 0; }

  [[nodiscard]] bool is_empty() const {
    std::uint64_t any = 0;
    for (const std::uint64_t word : words) any |= word;
    return any == 0;
  }

  [[nodiscard]] std::size_t size() const {
    std::size_t count = 0;
    for (const std::uint64_t word : words) count += static_cast<std::size_t>(std::popcount(word));
    return count;
  }

  [[nodiscard]] std::uint64_t hash() const {
    std::uint64_t hash = 0;
    for (const std::uint64_t word : words) {
      hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL;
      hash ^= hash >> 32;
    }
    return hash * 0xd6e8feb86659fd93ULL;
  }

  friend RowSet operator&(RowSet a, const RowSet& b) {
    for (std::size_t w = 0; w < Words; ++w) a.words[w] &= b.words[w];
    return a;
  }
  friend RowSet operator|(RowSet a, const RowSet& b) {
    for (std::size_t w = 0; w < Words; ++w) a.words[w] |= b.words[w];
    return a;
  }
  friend RowSet operator-(RowSet a, const RowSet& b) {
    for (std::size_t w = 0; w < Words; ++w) a.words[w] &= ~b.words[w];
    return a;
  }
  friend bool operator==(const RowSet&, const RowSet&) = default;
};

template <std::size_t Words>
[[nodiscard]] bool are_disjoint(const RowSet<Words>& a, const RowSet<Words>& b) {
  return (a & b).is_empty();
}
/// Whether all of `inner` is in `outer`.
template <std::size_t Words>
[[nodiscard]] bool is_within(const RowSet<Words>& inner, const RowSet<Words>& outer) {
  return (inner - outer).is_empty();
}

}  // namespace cloud2csg
