#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "export/openscad_parameters.hpp"
#include "export/patterns.hpp"
#include "export/script_plan.hpp"

namespace cloud2csg::openscad {

/// Which primitives of a plan are written as loops.
struct Loops {
  std::map<PrimitiveIndex, script::Pattern> first = {};  ///< by the primitive that is written
  std::set<PrimitiveIndex> replaced = {};                ///< those that the loops make of it
};

/// The patterns among what is united or taken away together. Primitives that the tree has twice stay alone.
[[nodiscard]] Loops loops_of(const script::Plan& plan, const PrimitiveSet& primitives);

/// `for (...) translate(...) `, to stand before the first member; adds counts and steps to its parameters.
[[nodiscard]] std::string loop_over(const script::Pattern& pattern, const std::vector<std::string>& names,
                                    const script::NumberFormat& number, Parameters& parameters);

}  // namespace cloud2csg::openscad
