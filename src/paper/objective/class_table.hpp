#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cloud2csg/advanced/rank_classes.hpp"
#include "paper/objective/contribution_units.hpp"
#include "paper/objective/rank_kernels.hpp"

namespace cloud2csg {

/// Sums of contributions by key: an open-addressing hash table, entries numbered by arrival. No allocation a point.
class ClassTable {
 public:
  ClassTable(std::size_t primitives, std::size_t key_words)
      : words_(key_words), row_(primitives + primitives % 2), slots_(k_first_slots, 0) {}

  /// Finds or makes a class for each of `points`, ascending places in the block, and writes it to `classes`.
  void find_or_insert(const BlockKeys& keys, std::span<const std::uint16_t> points, std::span<std::uint32_t> classes);

  /// Counts `points` <= k_most_packed_points more in a class. Returns the sums to add theirs to, an even number.
  [[nodiscard]] std::span<PackedContribution> add_points(std::size_t class_index, std::uint32_t points) {
    if (pending_[class_index] + points > k_most_packed_points) widen(class_index);
    pending_[class_index] += points;
    return row(class_index);
  }
  /// Adds a class of another table, whose primitive places[k] is the k-th here.
  void add_class(std::size_t class_index, const ClassTable& other, std::size_t other_class,
                 std::span<const std::size_t> places);
  /// A primitive's contributions, summed over the class.
  [[nodiscard]] WideContribution sum(std::size_t class_index, std::size_t primitive) const {
    WideContribution sum = widened(row(class_index)[primitive]);
    if (has_wide(class_index)) sum += wide_row(class_index)[primitive];
    return sum;
  }
  [[nodiscard]] std::span<const std::uint32_t> key(std::size_t class_index) const {
    return std::span(keys_).subspan(class_index * words_, words_);
  }
  [[nodiscard]] std::uint64_t count(std::size_t class_index) const {
    return pending_[class_index] + (has_wide(class_index) ? wide_points_[wide_[class_index] - 1] : 0);
  }
  [[nodiscard]] std::size_t size() const { return pending_.size(); }
  /// Points of all classes. O(classes).
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
  void make_wide(std::size_t class_index);
  /// Moves the packed sums to the wide ones.
  void widen(std::size_t class_index);

  [[nodiscard]] std::size_t slot_of(const std::uint32_t* key, std::size_t stride, std::uint32_t hash) const;

  std::size_t words_;
  std::size_t row_;                   // contributions in a row: an even number
  std::vector<std::uint32_t> slots_;  // class index + 1; 0 is free. A power of two of them
  std::vector<std::uint32_t> keys_;
  std::vector<std::uint32_t> hashes_;
  std::vector<std::uint32_t> pending_;                  // by class: points whose contributions are packed
  std::vector<std::uint32_t> wide_;                     // by class: place among the wide sums + 1; 0 is none
  std::vector<std::vector<PackedContribution>> pages_;  // k_page_rows classes each, so that growing moves none
  std::vector<WideContribution> wide_sums_;             // for classes of many points
  std::vector<std::uint64_t> wide_points_;
};

/// Groups a block's points by key, in the first-level cache: neighbours have few keys, which saves look-ups in a table.
class BlockGroups {
 public:
  /// `points` are places in the block, ascending. O(points).
  void group(const BlockKeys& keys, std::span<const std::uint16_t> points);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// By group: its first point. Ascending.
  [[nodiscard]] std::span<const std::uint16_t> first_points() const { return std::span(first_points_).first(size_); }
  [[nodiscard]] std::uint32_t count(std::size_t group) const { return counts_[group]; }
  /// The group of points[k].
  [[nodiscard]] std::size_t group_of(std::size_t k) const { return groups_[k]; }

 private:
  /// The slot of a point's key, or a free one.
  [[nodiscard]] std::size_t slot_of(const BlockKeys& keys, std::uint16_t point) const;

  std::array<std::uint16_t, 2 * k_block_points> slots_{};  // group + 1; 0 is free
  std::array<std::uint16_t, k_block_points> first_points_{}, counts_{}, groups_{};
  std::size_t size_ = 0;
};

/// A set of primitives by which points are grouped one by one. Tables of subsets come from its classes, which are far
/// fewer than points. So points of one class also belong to the same primitives of the set.
struct Root {
  std::vector<PrimitiveIndex> primitives;
  std::vector<PrimitiveIndex> owners;      ///< points that belong to one of these
  std::size_t stride = 1;                  ///< every k-th point
  bool all_points = false;                 ///< also points that belong to none of the owners
  bool without_strangers = false;          ///< no points inside a primitive that is not in the set
  std::optional<AlignedBox> region = {};   ///< only the points in it
  bool has_member_word = false;            ///< keys end with a word for the primitives that the points belong to
  std::vector<std::size_t> requests = {};  ///< requests that it answers

  [[nodiscard]] KeyLayout layout() const { return KeyLayout(primitives.size()); }
  [[nodiscard]] std::size_t key_words() const { return layout().words + (has_member_word ? 1 : 0); }
};

/// The roots for all requests; one answers each. O(sum of the set sizes x roots that share a primitive).
[[nodiscard]] std::vector<Root> plan_roots(std::span<const RankClassesRequest> requests);

/// By class of a root, the primitives of its set that the points are inside: bit k for the k-th.
[[nodiscard]] std::vector<std::uint32_t> inside_words(const Root& root, const ClassTable& classes);

/// Groups the classes of a root by the order of the request's primitives. `inside`: its inside_words().
[[nodiscard]] ClassTable project(const Root& root, const ClassTable& classes, std::span<const std::uint32_t> inside,
                                 const RankClassesRequest& request);

}  // namespace cloud2csg
