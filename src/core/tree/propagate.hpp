#pragma once

#include <cstdint>
#include <vector>

#include "core/tree/conjunction.hpp"

namespace cloud2csg {

/// One pass of the rules that follow from what is already known. Within a conjunction, each member may take all others
/// for granted, and everything that surrounds the conjunction likewise: a literal known to hold is left out; one known
/// not to hold makes its conjunction empty; an inner conjunction that holds all members of one known to be empty is
/// empty itself. That is idempotence, absorption, complementary pairs, empty and full, and all nested differences.
/// Conjunctions of one member are dissolved (double complement).
class Propagation {
 public:
  /// Returns whether anything changed; then another pass may find more. `index` belongs to `formula` as it comes in.
  /// O(size x members known to be empty that share a member); mostly O(size).
  bool run(Formula& formula, const FormulaIndex& index);

 private:
  /// A conjunction that is being read.
  struct Frame {
    std::uint32_t open;       ///< its opening token in the input...
    std::uint32_t out_begin;  ///< ...and in the output
    std::size_t first_literal;
    std::size_t first_known;
    std::uint32_t members = 0;  ///< written so far
    bool changed = false;
  };
  /// An inner conjunction known to be empty, listed under its first member.
  struct KnownEmpty {
    std::uint32_t open;
    std::uint32_t next;  ///< of the list; position in known_
    std::uint32_t listed_under;
    std::size_t level;  ///< frames outside of it
    bool is_valid;
  };

  void read_literal();
  void read_conjunction();
  bool enter();
  bool assume_members(std::uint32_t open);
  void forget(const Frame& frame);
  void invalidate(std::uint32_t open);
  [[nodiscard]] bool is_known_empty(std::uint32_t open) const;
  void leave();
  void dissolve(const Frame& frame);
  void drop_empty_conjunction();

  const FormulaIndex* index_ = nullptr;
  std::vector<Token> in_;
  std::vector<Token> out_;
  std::uint32_t at_ = 0;
  bool changed_ = false;
  std::vector<Frame> frames_;
  std::vector<std::uint32_t> known_by_;  ///< by variable: token of the literal that is taken for granted, or k_none
  std::vector<std::uint32_t> literals_;  ///< variables in known_by_, latest last
  std::vector<KnownEmpty> known_;
  std::vector<std::uint32_t> list_head_;  ///< by member code: latest of known_ listed under it, or k_none
  std::vector<std::uint32_t> known_at_;   ///< by opening token: position in known_, or k_none
};

}  // namespace cloud2csg
