#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "io/scripts/openscad_solids.hpp"
#include "io/scripts/patterns.hpp"
#include "io/scripts/script_plan.hpp"

namespace cloud2csg::openscad {

/// A loop around the first member of a pattern. Members are steps of the plan.
struct Loop {
  script::Pattern pattern;
  bool is_intersection = false;  ///< intersects its members instead of uniting them
};

struct Loops {
  std::map<std::size_t, Loop> first = {};   ///< by the step that is written
  std::set<std::size_t> replaced = {};      ///< other members of the loops, and the operands of all replaced steps
  std::set<PrimitiveIndex> unwritten = {};  ///< primitives of replaced steps
};

/// Finds patterns among operands that are united, removed or intersected together. Leaves out steps of more than 64
/// solids and steps with a primitive that occurs twice in the tree.
[[nodiscard]] Loops loops_of(const script::Plan& plan, const PrimitiveSet& primitives);

/// The primitives of a step, in their order in the plan.
[[nodiscard]] std::vector<PrimitiveIndex> primitives_of_step(const script::Plan& plan, std::size_t step);

/// `for (...) translate(...) ` before the first member. Adds counts and steps to its parameters. `names`: the members'.
[[nodiscard]] std::string loop_over(const Loop& loop, const std::vector<std::string>& names,
                                    const script::NumberFormat& number, Parameters& parameters);

}  // namespace cloud2csg::openscad
