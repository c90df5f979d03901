#pragma once

#include <cstdint>
#include <span>

#include "raw/solids/term_space.hpp"

namespace cloud2csg {

struct TermCosts {
  double leaf = 0.001;
  double plane = 0.2;  ///< a polytope's plane beyond the sixth, in leaves
  double known = 0.5;  ///< a known solid, in leaves; it wins over an equally good term
};

enum class TermKinds : std::uint8_t {
  simple,  ///< boxes and curved surfaces: quick to price
  all,
};

struct PricedTerm {
  Term term = {};  ///< without parts if none was found
  double net = 0;  ///< gain of its places minus its cost
};

[[nodiscard]] double cost_of(const Term& term, const TermCosts& costs);

/// The term with the largest net gain above `least`. Exact over boxes of all frames, curved surfaces and their
/// intervals, and intersections of a box or interval with the inside or outside of a curved surface or known solid.
/// Over polytopes, greedy cuts around the places with the largest gains. `gains`: by place, from having it in the term.
[[nodiscard]] PricedTerm best_term(const TermSpace& space, std::span<const double> gains, const TermCosts& costs,
                                   double least = 0, TermKinds kinds = TermKinds::all);

/// The best box of one family, for tests.
[[nodiscard]] PricedTerm best_box(const TermSpace& space, std::uint32_t family, std::span<const double> gains,
                                  const TermCosts& costs, double least);

}  // namespace cloud2csg
