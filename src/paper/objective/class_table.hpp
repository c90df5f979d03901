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

/// The points of a block grouped by key: neighbours have few different ones, so that what is looked up and added in a
/// large table is first gathered here, in the first-level cache.
class BlockGroups {
 public:
  /// `points` are places in the block, ascending. O(points).
  void group(const BlockKeys& keys, std::span<const std::uint16_t> points);

  [[nodiscard]] std::size_t size() const { return size_; }
  /// By group: the first of its points, ascending.
  [[nodiscard]] std::span<const std::uint16_t> first_points() const { return std::span(first_points_).first(size_); }
  /// How many points the group has.
  [[nodiscard]] std::uint32_t count(std::size_t group) const { return counts_[group]; }
  /// The group of points[k].
  [[nodiscard]] std::size_t group_of(std::size_t k) const { return groups_[k]; }

 private:
  /// The slot of the key of a point: the one where it is, or a free one.
  [[nodiscard]] std::size_t slot_of(const BlockKeys& keys, std::uint16_t point) const;

  std::array<std::uint16_t, 2 * k_block_points> slots_{};  // group + 1; 0 is free
  std::array<std::uint16_t, k_block_points> first_points_{}, counts_{}, groups_{};
  std::size_t size_ = 0;
};

/// A set of primitives by which points are grouped one by one. Tables of subsets are made of its classes, of which
/// there are far fewer than points; therefore points of one class also belong to the same primitives of the set.
struct Root {
  std::vector<PrimitiveIndex> primitives;
  std::vector<PrimitiveIndex> owners;      ///< points that belong to one of these
  std::size_t stride = 1;                  ///< every k-th point
  bool all_points = false;                 ///< also those that belong to none of the owners
  bool without_strangers = false;          ///< not those inside of a primitive that is not in the set
  std::optional<AlignedBox> region = {};   ///< only the points in it
  bool has_member_word = false;            ///< whether keys end with a word that tells to whom the points belong
  std::vector<std::size_t> requests = {};  ///< that are answered from it

  [[nodiscard]] KeyLayout layout() const { return KeyLayout(primitives.size()); }
  [[nodiscard]] std::size_t key_words() const { return layout().words + (has_member_word ? 1 : 0); }
};

/// The roots for all requests. Each request is answered by one of them. O(sum of the set sizes x roots that share a
/// primitive).
[[nodiscard]] std::vector<Root> plan_roots(std::span<const RankClassesRequest> requests);

/// By class of a root, the primitives of its set that the points are inside of: bit k for the k-th.
[[nodiscard]] std::vector<std::uint32_t> inside_words(const Root& root, const ClassTable& classes);

/// Groups the classes of a root by the order of the request's primitives. `inside`: its inside_words().
[[nodiscard]] ClassTable project(const Root& root, const ClassTable& classes, std::span<const std::uint32_t> inside,
                                 const RankClassesRequest& request);

}  // namespace cloud2csg
