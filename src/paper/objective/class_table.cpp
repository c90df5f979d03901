#include "paper/objective/class_table.hpp"

#include <numeric>
#include <utility>

namespace cloud2csg {
namespace {

/// Contributions a line of the cache.
constexpr std::size_t k_line = 64 / sizeof(PackedContribution);

bool equal(const std::uint32_t* a, const std::uint32_t* b, std::size_t stride_b, std::size_t words) {
  for (std::size_t w = 0; w < words; ++w) {
    if (a[w] != b[w * stride_b]) return false;
  }
  return true;
}

}  // namespace

std::size_t ClassTable::slot_of(const std::uint32_t* key, std::size_t stride, std::uint32_t hash) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash & mask;
  while (slots_[slot] != 0 && !equal(&keys_[(slots_[slot] - 1) * words_], key, stride, words_))
    slot = (slot + 1) & mask;
  return slot;
}

void ClassTable::find_or_insert(const BlockKeys& keys, std::span<const std::uint16_t> points,
                                std::span<std::uint32_t> classes) {
  // The table is larger than the first-level cache: the slots of a whole block are asked for at once.
  for (const std::uint16_t i : points) __builtin_prefetch(&slots_[keys.hashes[i] & (slots_.size() - 1)]);
  for (std::size_t k = 0; k < points.size(); ++k) {
    classes[k] = find_or_insert(&keys.words[points[k]], k_block_points, keys.hashes[points[k]]);
    const std::span<const PackedContribution> sums = std::as_const(*this).row(classes[k]);
    for (std::size_t place = 0; place < row_; place += k_line) __builtin_prefetch(&sums[place], 1);
  }
}

std::uint32_t ClassTable::find_or_insert(const std::uint32_t* key, std::size_t stride, std::uint32_t hash) {
  std::size_t slot = slot_of(key, stride, hash);
  if (slots_[slot] != 0) return slots_[slot] - 1;
  if (2 * (size() + 1) > slots_.size()) {
    grow();
    slot = slot_of(key, stride, hash);
  }
  const auto class_index = static_cast<std::uint32_t>(size());
  for (std::size_t w = 0; w < words_; ++w) keys_.push_back(key[w * stride]);
  if (class_index % k_page_rows == 0) pages_.emplace_back(k_page_rows * row_, 0U);
  hashes_.push_back(hash);
  pending_.push_back(0);
  wide_.push_back(0);
  slots_[slot] = class_index + 1;
  return class_index;
}

void ClassTable::grow() {
  slots_.assign(2 * slots_.size(), 0);
  for (std::size_t c = 0; c < size(); ++c) {
    slots_[slot_of(&keys_[c * words_], 1, hashes_[c])] = static_cast<std::uint32_t>(c + 1);
  }
}

void ClassTable::make_wide(std::size_t class_index) {
  if (has_wide(class_index)) return;
  wide_points_.push_back(0);
  wide_sums_.resize(wide_sums_.size() + row_);
  wide_[class_index] = static_cast<std::uint32_t>(wide_points_.size());
}

void ClassTable::widen(std::size_t class_index) {
  make_wide(class_index);
  wide_points_[wide_[class_index] - 1] += std::exchange(pending_[class_index], 0U);
  const std::span<PackedContribution> packed = row(class_index);
  const std::span<WideContribution> wide = wide_row(class_index);
  for (std::size_t k = 0; k < row_; ++k) wide[k] += widened(std::exchange(packed[k], 0U));
}

void ClassTable::add_class(std::size_t class_index, const ClassTable& other, std::size_t other_class,
                           std::span<const std::size_t> places) {
  const std::span<const PackedContribution> packed = other.row(other_class);
  const std::span<PackedContribution> sums = add_points(class_index, other.pending_[other_class]);
  for (std::size_t k = 0; k < places.size(); ++k) sums[k] += packed[places[k]];
  if (!other.has_wide(other_class)) return;
  make_wide(class_index);
  wide_points_[wide_[class_index] - 1] += other.wide_points_[other.wide_[other_class] - 1];
  const std::span<const WideContribution> added = other.wide_row(other_class);
  const std::span<WideContribution> wide = wide_row(class_index);
  for (std::size_t k = 0; k < places.size(); ++k) wide[k] += added[places[k]];
}

std::size_t ClassTable::point_count() const {
  const std::size_t packed = std::accumulate(pending_.begin(), pending_.end(), std::size_t{0});
  return std::accumulate(wide_points_.begin(), wide_points_.end(), packed);
}

void ClassTable::absorb(const ClassTable& other) {
  std::vector<std::size_t> same_places(row_);
  std::iota(same_places.begin(), same_places.end(), std::size_t{0});
  for (std::size_t c = 0; c < other.size(); ++c) {
    add_class(find_or_insert(other.key(c).data(), 1, other.hashes_[c]), other, c, same_places);
  }
}

}  // namespace cloud2csg
