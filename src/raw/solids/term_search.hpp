#pragma once

#include <cstdint>
#include <span>

#include "cloud2csg/run_context.hpp"
#include "raw/solids/term_space.hpp"

namespace cloud2csg {

struct TermCosts {
  double leaf = 0.001;
  double known = 0.05;  ///< a known solid, in leaves: it wins over a profile of its and other surfaces
};

enum class TermKinds : std::uint8_t {
  known,   ///< known solids only
  simple,  ///< single curved surfaces and profiles: quick to price
  all,
};

struct PricedTerm {
  Term term = {};  ///< without parts if none was found
  double net = 0;  ///< gain of its places minus its cost
};

[[nodiscard]] double cost_of(const Term& term, const TermCosts& costs);

/// The term with the largest net gain above `least`. Exact over curved surfaces and their intervals, and known solids.
/// Over extrusions and revolutions, and their intersections with the inside or outside of a curved surface or known
/// solid, it is the best that choose_faces() finds between the most promising ends. Over polytopes, greedy cuts around
/// the places with the largest gains. `gains`: by place, from having it in the term. A stop leaves the best so far.
[[nodiscard]] PricedTerm best_term(const TermSpace& space, std::span<const double> gains, const TermCosts& costs,
                                   double least = 0, TermKinds kinds = TermKinds::all, const RunContext& run = {});

}  // namespace cloud2csg
