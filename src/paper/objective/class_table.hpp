#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "paper/objective/contribution_units.hpp"
#include "paper/objective/rank_kernels.hpp"

namespace cloud2csg {

/// Points grouped by key, with their contributions summed: an open-addressing hash table whose entries are numbered in
/// the order in which they came. No allocation a point.
class ClassTable {
 public:
  ClassTable(std::size_t primitives, std::size_t key_words)
      : words_(key_words), row_(primitives + primitives % 2), slots_(k_first_slots, 0) {}

  /// The classes of points of a block, made when they are new. `points` are places in the block, ascending; `classes`
  /// receives one a point.
  void find_or_insert(const BlockKeys& keys, std::span<const std::uint16_t> points, std::span<std::uint32_t> classes);

  /// Counts `points` more in a class, and gives the contributions to which theirs are to be added: one a primitive,
  /// and one more where their number is odd.
  /// Precondition: at most k_most_packed_points.
  [[nodiscard]] std::span<PackedContribution> add_points(std::size_t class_index, std::uint32_t points) {
    if (pending_[class_index] + points > k_most_packed_points) widen(class_index);
    pending_[class_index] += points;
    return row(class_index);
  }
  /// Adds a class of another table; its primitive places[k] is the k-th here.
  void add_class(std::size_t class_index, const ClassTable& other, std::size_t other_class,
                 std::span<const std::size_t> places);
  /// The sums of a class's points for a primitive.
  [[nodiscard]] WideContribution sum(std::size_t class_index, std::size_t primitive) const {
    WideContribution sum = widened(row(class_index)[primitive]);
    if (has_wide(class_index)) sum += wide_row(class_index)[primitive];
    return sum;
  }
  [[nodiscard]] std::span<const std::uint32_t> key(std::size_t class_index) const {
    return std::span(keys_).subspan(class_index * words_, words_);
  }
  /// How many points the class has.
  [[nodiscard]] std::uint64_t count(std::size_t class_index) const {
    return pending_[class_index] + (has_wide(class_index) ? wide_points_[wide_[class_index] - 1] : 0);
  }
  [[nodiscard]] std::size_t size() const { return pending_.size(); }
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

  [[nodiscard]] std::span<PackedContribution> row(std::size_t class_index) {
    return std::span(pages_[class_index / k_page_rows]).subspan(class_index % k_page_rows * row_, row_);
  }
  [[nodiscard]] std::span<const PackedContribution> row(std::size_t class_index) const {
    return std::span(pages_[class_index / k_page_rows]).subspan(class_index % k_page_rows * row_, row_);
  }
  [[nodiscard]] bool has_wide(std::size_t class_index) const { return wide_[class_index] != 0; }
  [[nodiscard]] std::span<WideContribution> wide_row(std::size_t class_index) {
    return std::span(wide_sums_).subspan((wide_[class_index] - 1) * row_, row_);
  }
  [[nodiscard]] std::span<const WideContribution> wide_row(std::size_t class_index) const {
    return std::span(wide_sums_).subspan((wide_[class_index] - 1) * row_, row_);
  }
  /// Gives the class wide sums, unless it has them.
  void make_wide(std::size_t class_index);
  /// Moves what is packed to the wide sums.
  void widen(std::size_t class_index);

  [[nodiscard]] std::size_t slot_of(const std::uint32_t* key, std::size_t stride, std::uint32_t hash) const;

  std::size_t words_;
  std::size_t row_;                   // of contributions: an even number
  std::vector<std::uint32_t> slots_;  // class index + 1; 0 is free. A power of two of them
  std::vector<std::uint32_t> keys_;
  std::vector<std::uint32_t> hashes_;
  std::vector<std::uint32_t> pending_;                  // by class: points whose contributions are packed
  std::vector<std::uint32_t> wide_;                     // by class: place among the wide sums + 1; 0 is none
  std::vector<std::vector<PackedContribution>> pages_;  // k_page_rows classes each, so that growing moves none
  std::vector<WideContribution> wide_sums_;             // of the classes of many points
  std::vector<std::uint64_t> wide_points_;
};

}  // namespace cloud2csg
