#include "fitness/class_table.hpp"

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

std::size_t ClassTable::slot_of(const std::uint64_t* key, std::size_t stride) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash_of(key, stride, words_) & mask;
  while (slots_[slot] != 0 && !equal(&keys_[(slots_[slot] - 1) * words_], key, stride, words_)) slot = (slot + 1) & mask;
  return slot;
}

std::uint32_t ClassTable::find_or_insert(const std::uint64_t* key, std::size_t stride) {
  std::size_t slot = slot_of(key, stride);
  if (slots_[slot] != 0) return slots_[slot] - 1;
  if (2 * (size() + 1) > slots_.size()) {
    grow();
    slot = slot_of(key, stride);
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
    slots_[slot_of(&keys_[c * words_], 1)] = static_cast<std::uint32_t>(c + 1);
  }
}

void ClassTable::absorb(const ClassTable& other) {
  point_count_ += other.point_count_;
  for (std::size_t c = 0; c < other.size(); ++c) {
    const std::uint32_t mine = find_or_insert(other.key(c).data(), 1);
    const std::span<const double> added = other.sums(c);
    const std::span<double> sum = sums(mine);
    for (std::size_t k = 0; k < row_; ++k) sum[k] += added[k];
  }
}

}  // namespace cloud2csg
