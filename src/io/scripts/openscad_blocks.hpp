#pragma once

#include <functional>
#include <optional>
#include <string>

#include "io/scripts/script_plan.hpp"

namespace cloud2csg::openscad {

/// How steps are worded.
struct Wording {
  /// The statement for a step that is a primitive or everything.
  std::function<std::string(std::size_t step)> statement_of;
  /// What stands before a step: the head of a loop, or nothing. Absent: another step stands for it.
  std::function<std::optional<std::string>(std::size_t step)> before;
};

/// FreeCAD reads intersections of two only.
enum class Intersections { of_all, in_pairs };

/// The plan as blocks of union(), intersection() and difference(), indented. O(size), no recursion
[[nodiscard]] std::string print_blocks(const script::Plan& plan, const Wording& wording, Intersections intersections);

}  // namespace cloud2csg::openscad
