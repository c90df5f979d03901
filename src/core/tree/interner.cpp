#include "core/tree/interner.hpp"

#include <algorithm>

namespace cloud2csg {
namespace {

constexpr std::size_t k_first_slots = 64;

std::uint64_t hash_of(std::span<const std::uint32_t> key) {
  std::uint64_t hash = key.size();
  for (const std::uint32_t value : key) hash = mix(hash ^ value);
  return hash;
}

}  // namespace

std::uint32_t Interner::intern(std::span<const std::uint32_t> key_of_new) {
  if (2 * (size() + 1) > slots_.size()) grow();
  const std::uint64_t hash = hash_of(key_of_new);
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash & mask;
  for (; slots_[slot] != 0; slot = (slot + 1) & mask) {
    const std::uint32_t id = slots_[slot] - 1;
    if (hashes_[id] == hash && std::ranges::equal(key(id), key_of_new)) return id;
  }
  const auto id = static_cast<std::uint32_t>(size());
  slots_[slot] = id + 1;
  keys_.insert(keys_.end(), key_of_new.begin(), key_of_new.end());
  begins_.push_back(static_cast<std::uint32_t>(keys_.size()));
  hashes_.push_back(hash);
  return id;
}

void Interner::clear() {
  keys_.clear();
  begins_.resize(1);
  hashes_.clear();
  std::ranges::fill(slots_, 0);
}

void Interner::grow() {
  slots_.assign(std::max(k_first_slots, 2 * slots_.size()), 0);
  const std::size_t mask = slots_.size() - 1;
  for (std::uint32_t id = 0; id < size(); ++id) {
    std::size_t slot = hashes_[id] & mask;
    while (slots_[slot] != 0) slot = (slot + 1) & mask;
    slots_[slot] = id + 1;
  }
}

}  // namespace cloud2csg
