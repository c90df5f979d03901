#pragma once

#include <cstdint>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/run_context.hpp"

namespace cloud2csg {

/// An assignment of up to 64 variables, a bit each.
using Assignment = std::uint64_t;
inline constexpr std::size_t k_most_variables = 64;

/// Assignments at which a function is known to be true, and to be false. None is in both.
struct KnownRows {
  std::vector<Assignment> on, off;
};

struct DecompositionOptions {
  /// Rows looked at, times variables, before choices are taken as they come instead of tried.
  std::size_t budget = 100'000;
};

/// A small formula that is true in all rows that are on and false in all that are off. Takes the function apart:
/// - leaves out variables that nothing depends on;
/// - splits off a variable that decides alone where it is true, or false (`v | f`, `f - v`, `v & f`, `~v | f`);
/// - cuts a union or an intersection of functions of disjoint sets of variables, any number of them at once
///   (bi-decomposition; Mishchenko, Steinbach, Perkowski 2001);
/// - else branches on a variable, which then appears more than once: the one with the smallest formula, while the
///   budget lasts.
/// Finds a formula that has each variable at most once, if there is one and enough rows are known. Deterministic; a
/// triggered run.stop ends the budget.
[[nodiscard]] CsgTree decompose(const KnownRows& rows, const DecompositionOptions& options = {},
                                const RunContext& run = {});

/// Variables that every formula needs: two rows of different values differ in nothing else.
[[nodiscard]] Assignment essential_variables(const KnownRows& rows);

}  // namespace cloud2csg
