#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fitness/point_kernels.hpp"

namespace cloud2csg {

/// Points grouped by key, with their contributions summed: an open-addressing hash table whose entries are numbered in
/// the order in which they came. No allocation a point.
class ClassTable {
 public:
  ClassTable(std::size_t primitives, const KeyLayout& layout);

  /// The classes of points of a block, made when they are new. `keys` is as compute_rank_keys() gives them, `points`
  /// are places in the block; `classes` receives one a point.
  void find_or_insert(const std::uint64_t* keys, std::span<const std::uint16_t> points,
                      std::span<std::uint32_t> classes);

  /// The sums of a class: plain and complement contribution of each primitive in turn.
  [[nodiscard]] std::span<double> sums(std::size_t class_index) {
    return std::span(sums_).subspan(class_index * row_, row_);
  }
  [[nodiscard]] std::span<const double> sums(std::size_t class_index) const {
    return std::span(sums_).subspan(class_index * row_, row_);
  }
  [[nodiscard]] std::span<const std::uint64_t> key(std::size_t class_index) const {
    return std::span(keys_).subspan(class_index * words_, words_);
  }
  [[nodiscard]] std::size_t size() const { return keys_.size() / words_; }
  [[nodiscard]] std::size_t point_count() const { return point_count_; }
  void count_points(std::size_t points) { point_count_ += points; }

  /// Adds another table's classes. The sums are exact, so the order does not matter.
  void absorb(const ClassTable& other);

 private:
  /// The class of the key whose word w is at key[w * stride].
  [[nodiscard]] std::uint32_t find_or_insert(const std::uint64_t* key, std::size_t stride, std::uint64_t hash);
  void grow();
  [[nodiscard]] std::size_t slot_of(const std::uint64_t* key, std::size_t stride, std::uint64_t hash) const;

  std::size_t words_;
  std::size_t row_;
  std::size_t point_count_ = 0;
  std::vector<std::uint32_t> slots_;  // class index + 1; 0 is free. A power of two of them
  std::vector<std::uint64_t> keys_;
  std::vector<double> sums_;
};

}  // namespace cloud2csg
