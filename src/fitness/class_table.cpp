#include "fitness/class_table.hpp"

#include <array>

namespace cloud2csg {
namespace {

constexpr std::size_t k_first_slots = 1024;

std::uint64_t hash_of(const std::uint64_t* key, std::size_t stride, std::size_t words) {
  std::uint64_t hash = 0;
  for (std::size_t w = 0; w < words; ++w) {
    hash = (hash ^ key[w * stride]) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 29U;
  }
  return hash * 0xbf58476d1ce4e5b9ULL >> 20U;
}

bool equal(const std::uint64_t* a, const std::uint64_t* key, std::size_t stride, std::size_t words) {
  for (std::size_t w = 0; w < words; ++w) {
    if (a[w] != key[w * stride]) return false;
  }
  return true;
}

}  // namespace

ClassTable::ClassTable(std::size_t primitives, const KeyLayout& layout)
    : words_(layout.words), row_(2 * primitives), slots_(k_first_slots, 0) {}

std::size_t ClassTable::slot_of(const std::uint64_t* key, std::size_t stride, std::uint64_t hash) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash & mask;
  while (slots_[slot] != 0 && !equal(&keys_[(slots_[slot] - 1) * words_], key, stride, words_))
    slot = (slot + 1) & mask;
  return slot;
}

void ClassTable::find_or_insert(const std::uint64_t* keys, std::span<const std::uint16_t> points,
                                std::span<std::uint32_t> classes) {
  std::array<std::uint64_t, k_block_points> hashes;  // NOLINT: written below before it is read
  for (std::size_t k = 0; k < points.size(); ++k) {
    hashes[k] = hash_of(keys + points[k], k_block_points, words_);
    // The table is larger than the first-level cache: the slots of a whole block are asked for at once.
    __builtin_prefetch(&slots_[hashes[k] & (slots_.size() - 1)]);
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    classes[k] = find_or_insert(keys + points[k], k_block_points, hashes[k]);
    __builtin_prefetch(&sums_[classes[k] * row_], 1);
  }
}

std::uint32_t ClassTable::find_or_insert(const std::uint64_t* key, std::size_t stride, std::uint64_t hash) {
  std::size_t slot = slot_of(key, stride, hash);
  if (slots_[slot] != 0) return slots_[slot] - 1;
  if (2 * (size() + 1) > slots_.size()) {
    grow();
    slot = slot_of(key, stride, hash);
  }
  const auto class_index = static_cast<std::uint32_t>(size());
  for (std::size_t w = 0; w < words_; ++w) keys_.push_back(key[w * stride]);
  sums_.resize(sums_.size() + row_, 0.0);
  slots_[slot] = class_index + 1;
  return class_index;
}

void ClassTable::grow() {
  slots_.assign(2 * slots_.size(), 0);
  for (std::size_t c = 0; c < size(); ++c) {
    const std::uint64_t* key_of_class = &keys_[c * words_];
    slots_[slot_of(key_of_class, 1, hash_of(key_of_class, 1, words_))] = static_cast<std::uint32_t>(c + 1);
  }
}

void ClassTable::absorb(const ClassTable& other) {
  point_count_ += other.point_count_;
  for (std::size_t c = 0; c < other.size(); ++c) {
    const std::uint64_t* key_of_class = other.key(c).data();
    const std::uint32_t mine = find_or_insert(key_of_class, 1, hash_of(key_of_class, 1, words_));
    const std::span<const double> added = other.sums(c);
    const std::span<double> sum = sums(mine);
    for (std::size_t k = 0; k < row_; ++k) sum[k] += added[k];
  }
}

}  // namespace cloud2csg
