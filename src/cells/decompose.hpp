#pragma once

#include <cstdint>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// An assignment of up to 64 variables, a bit each.
using Assignment = std::uint64_t;
inline constexpr std::size_t k_most_variables = 64;

/// Where a function of up to 64 variables is known to be true, and to be false. No assignment is in both.
struct KnownRows {
  std::vector<Assignment> on, off;
};

struct DecompositionOptions {
  /// Rows looked at, times variables, before choices are no longer tried but taken as they come.
  std::size_t budget = 100'000;
};

/// A small formula that is true in all rows that are on and false in all that are off, by taking the function apart:
/// - variables that nothing depends on are left out;
/// - a variable that decides alone where it is true, or where it is false, is split off (`v | f`, `f - v`, `v & f`,
///   `~v | f`);
/// - a function that is a union or an intersection of functions of disjoint sets of variables is cut there
///   (bi-decomposition; Mishchenko, Steinbach, Perkowski 2001), any number of them at once;
/// - else it is branched on a variable, which then appears more than once; of several, the one that gives the smallest
///   formula, as long as the budget lasts.
/// Where a formula exists that has each variable at most once and enough rows are known, it is found. Deterministic; a
/// triggered run.stop ends the budget.
[[nodiscard]] CsgTree decompose(const KnownRows& rows, const DecompositionOptions& options = {},
                                const RunContext& run = {});

/// Variables such that two rows differ in nothing but them and have different values: each formula needs them.
[[nodiscard]] Assignment essential_variables(const KnownRows& rows);

}  // namespace cloud2csg
