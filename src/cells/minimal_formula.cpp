#include <algorithm>

#include "cells/formula_search.hpp"
#include "cells/reduced_function.hpp"
#include "cloud2csg/advanced/formula.hpp"
#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {
namespace {
template <std::size_t Words>
MinimalFormula solve(const ReducedFunction& function, const MinimalFormulaOptions& options, const RunContext& run) {
  FormulaSearch<Words> search(function, options, run);
  return search.solve();
}
}  // namespace

std::optional<MinimalFormula> minimal_formula(const PartialFunction& function, const MinimalFormulaOptions& options,
                                              const RunContext& run) {
  const ReducedFunction reduced = reduce(function);
  if (std::ranges::count(reduced.values, true) == 0) return MinimalFormula{CsgTree::empty(), true, 0};
  if (std::ranges::count(reduced.values, false) == 0) return MinimalFormula{CsgTree::full(), true, 0};
  const std::size_t words = (reduced.values.size() + 63) / 64;
  if (words <= 1) return solve<1>(reduced, options, run);
  if (words <= 2) return solve<2>(reduced, options, run);
  if (words <= 4) return solve<4>(reduced, options, run);
  if (words <= 8) return solve<8>(reduced, options, run);
  return {};
}

}  // namespace cloud2csg
