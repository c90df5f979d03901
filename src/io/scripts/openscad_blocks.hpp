#pragma once

#include <functional>
#include <optional>
#include <string>

#include "io/scripts/script_plan.hpp"

namespace cloud2csg::openscad {

struct Wording {
  /// The statement for a primitive or everything.
  std::function<std::string(std::size_t step)> statement_of;
  /// A loop head or nothing before a step; absent if another step's loop replaces this step.
  std::function<std::optional<std::string>(std::size_t step)> before;
};

/// FreeCAD reads only intersections of two.
enum class Intersections { of_all, in_pairs };

/// Prints the plan as indented blocks of union(), intersection() and difference(). O(size), no recursion
[[nodiscard]] std::string print_blocks(const script::Plan& plan, const Wording& wording, Intersections intersections);

}  // namespace cloud2csg::openscad
