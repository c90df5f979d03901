#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/tree/conjunction.hpp"

namespace cloud2csg {

/// Pulls out what inner conjunctions have in common: [~[f x] ~[f y]] = [~[f ~[~[x] ~[y]]]], that is
/// (f & x) | (f & y) = f & (x | y) and its dual. Takes the factor that saves most literals first.
class Factoring {
 public:
  /// Returns whether anything changed: then the formula is shorter by a literal or more, and may hold conjunctions of
  /// one member, for Propagation to dissolve. O(size).
  bool run(Formula& formula, const FormulaIndex& index);

 private:
  bool find_group(std::uint32_t open);
  [[nodiscard]] std::uint32_t best_code() const;
  void write_group();
  void write_members(std::uint32_t open, bool in_factor);

  const FormulaIndex* index_ = nullptr;
  std::vector<Token> in_;
  std::vector<Token> out_;
  std::vector<std::uint32_t> inner_;    ///< opening tokens of the inner conjunctions at hand
  std::vector<std::uint32_t> group_;    ///< those of them that share the factor
  std::vector<std::uint32_t> factor_;   ///< the codes that all of group_ hold, ascending
  std::vector<std::uint32_t> count_;    ///< by code: how many of inner_ hold it
  std::vector<std::uint32_t> touched_;  ///< codes whose count is not 0
};

}  // namespace cloud2csg
