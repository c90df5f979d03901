#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "io/scripts/openscad_solids.hpp"
#include "io/scripts/patterns.hpp"
#include "io/scripts/script_plan.hpp"

namespace cloud2csg::openscad {

/// One step of a plan that is written as a loop around its first member. Members are steps.
struct Loop {
  script::Pattern pattern;
  bool is_intersection = false;  ///< members are not united, but what they have in common is meant
};

/// Which steps of a plan are written as loops.
struct Loops {
  std::map<std::size_t, Loop> first = {};   ///< by the step that is written
  std::set<std::size_t> replaced = {};      ///< those that the loops make of it, without what they are made of
  std::set<PrimitiveIndex> unwritten = {};  ///< primitives of replaced steps
};

/// The patterns among what is united, taken away together or intersected. What has a primitive that the tree has twice
/// stays alone, and so does what has more than 64 solids.
[[nodiscard]] Loops loops_of(const script::Plan& plan, const PrimitiveSet& primitives);

/// The primitives of a step, in their order in the plan.
[[nodiscard]] std::vector<PrimitiveIndex> primitives_of_step(const script::Plan& plan, std::size_t step);

/// `for (...) translate(...) `, to stand before the first member; adds counts and steps to its parameters. `names` are
/// those of the members, in their order.
[[nodiscard]] std::string loop_over(const Loop& loop, const std::vector<std::string>& names,
                                    const script::NumberFormat& number, Parameters& parameters);

}  // namespace cloud2csg::openscad
