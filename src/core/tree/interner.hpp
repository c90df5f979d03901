#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/random.hpp"

namespace cloud2csg {

/// Numbers distinct sequences 0, 1, 2... by first appearance. Exact: sequences are compared. All keys share one array.
class Interner {
 public:
  /// Amortised O(key.size()). `key` must not point into this interner.
  std::uint32_t intern(std::span<const std::uint32_t> key);

  [[nodiscard]] std::span<const std::uint32_t> key(std::uint32_t id) const {
    return std::span(keys_).subspan(begins_[id], begins_[id + 1] - begins_[id]);
  }
  [[nodiscard]] std::size_t size() const { return hashes_.size(); }
  /// Forgets all keys, keeps the memory.
  void clear();

 private:
  void grow();

  std::vector<std::uint32_t> keys_;
  std::vector<std::uint32_t> begins_ = {0};
  std::vector<std::uint64_t> hashes_;  ///< by id
  std::vector<std::uint32_t> slots_;   ///< open addressing, a power of two of slots; each holds id + 1, 0 = free
};

}  // namespace cloud2csg
