#pragma once

#include <cstdint>
#include <span>

#include "raw/solids/term_space.hpp"

namespace cloud2csg {

struct TermCosts {
  double leaf = 0.001;
  double plane = 0.2;  ///< of a polytope's beyond the sixth, in leaves
  double known = 0.5;  ///< of a solid that is known, in leaves: of two terms that are as good it is preferred
};

enum class TermKinds : std::uint8_t {
  simple,  ///< boxes and curved surfaces: quick to price
  all,
};

struct PricedTerm {
  Term term = {};  ///< without parts where none was found
  double net = 0;  ///< what its places gain less what it costs
};

/// What a term's leaves cost.
[[nodiscard]] double cost_of(const Term& term, const TermCosts& costs);

/// The term that gains most: over the boxes of all frames, the curved surfaces and their intervals, what a box or an
/// interval has in common with the inside or outside of a curved surface or known solid, exactly; over polytopes by
/// greedy cuts around the places that gain most. `gains` has one a place: what is gained by having it in the term. Only
/// terms whose net is above `least`.
[[nodiscard]] PricedTerm best_term(const TermSpace& space, std::span<const double> gains, const TermCosts& costs,
                                   double least = 0, TermKinds kinds = TermKinds::all);

/// The best of one family's boxes alone, for tests.
[[nodiscard]] PricedTerm best_box(const TermSpace& space, std::uint32_t family, std::span<const double> gains,
                                  const TermCosts& costs, double least);

}  // namespace cloud2csg
