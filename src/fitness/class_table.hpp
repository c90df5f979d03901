#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fitness/rank_kernels.hpp"

namespace cloud2csg {

/// Points grouped by key, with their contributions summed: an open-addressing hash table whose entries are numbered in
/// the order in which they came. No allocation a point.
class ClassTable {
 public:
  ClassTable(std::size_t primitives, std::size_t key_words)
      : words_(key_words), row_(2 * primitives), slots_(k_first_slots, 0) {}

  /// The classes of points of a block, made when they are new. `points` are places in the block, ascending; `classes`
  /// receives one a point.
  void find_or_insert(const BlockKeys& keys, std::span<const std::uint16_t> points, std::span<std::uint32_t> classes);

  /// The sums of a class: plain and complement contribution of each primitive in turn.
  [[nodiscard]] std::span<double> sums(std::size_t class_index) {
    return std::span(pages_[class_index / k_page_rows]).subspan(class_index % k_page_rows * row_, row_);
  }
  [[nodiscard]] std::span<const double> sums(std::size_t class_index) const {
    return std::span(pages_[class_index / k_page_rows]).subspan(class_index % k_page_rows * row_, row_);
  }
  [[nodiscard]] std::span<const std::uint32_t> key(std::size_t class_index) const {
    return std::span(keys_).subspan(class_index * words_, words_);
  }
  /// How many points the class has.
  [[nodiscard]] std::uint64_t count(std::size_t class_index) const { return counts_[class_index]; }
  void add_points(std::size_t class_index, std::uint64_t points) { counts_[class_index] += points; }
  [[nodiscard]] std::size_t size() const { return counts_.size(); }
  /// Of all classes. O(classes).
  [[nodiscard]] std::size_t point_count() const;

  /// Adds another table's classes. The sums are exact, so the order does not matter.
  void absorb(const ClassTable& other);

 private:
  static constexpr std::size_t k_first_slots = 64;
  static constexpr std::size_t k_page_rows = 64;

  /// The class of the key whose word w is at key[w * stride].
  [[nodiscard]] std::uint32_t find_or_insert(const std::uint32_t* key, std::size_t stride, std::uint32_t hash);
  void grow();
  [[nodiscard]] std::size_t slot_of(const std::uint32_t* key, std::size_t stride, std::uint32_t hash) const;

  std::size_t words_;
  std::size_t row_;
  std::vector<std::uint32_t> slots_;  // class index + 1; 0 is free. A power of two of them
  std::vector<std::uint32_t> keys_;
  std::vector<std::uint32_t> hashes_;
  std::vector<std::uint64_t> counts_;
  std::vector<std::vector<double>> pages_;  // of sums: k_page_rows classes each, so that growing moves none
};

}  // namespace cloud2csg
