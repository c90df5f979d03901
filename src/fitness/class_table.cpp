#include "fitness/class_table.hpp"

#include <numeric>

namespace cloud2csg {
namespace {

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
    __builtin_prefetch(sums(classes[k]).data(), 1);
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
  if (class_index % k_page_rows == 0) pages_.emplace_back(k_page_rows * row_, 0.0);
  hashes_.push_back(hash);
  counts_.push_back(0);
  slots_[slot] = class_index + 1;
  return class_index;
}

void ClassTable::grow() {
  slots_.assign(2 * slots_.size(), 0);
  for (std::size_t c = 0; c < size(); ++c) {
    slots_[slot_of(&keys_[c * words_], 1, hashes_[c])] = static_cast<std::uint32_t>(c + 1);
  }
}

std::size_t ClassTable::point_count() const {
  return std::accumulate(counts_.begin(), counts_.end(), std::size_t{0});
}

void ClassTable::absorb(const ClassTable& other) {
  for (std::size_t c = 0; c < other.size(); ++c) {
    const std::uint32_t mine = find_or_insert(other.key(c).data(), 1, other.hashes_[c]);
    counts_[mine] += other.counts_[c];
    const std::span<const double> added = other.sums(c);
    const std::span<double> sum = sums(mine);
    for (std::size_t k = 0; k < row_; ++k) sum[k] += added[k];
  }
}

}  // namespace cloud2csg
