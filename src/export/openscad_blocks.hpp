#pragma once

#include <functional>
#include <string>

#include "export/script_plan.hpp"

namespace cloud2csg::openscad {

/// The statement for a step that is a primitive or everything. Empty: another statement stands for it.
using StatementOf = std::function<std::string(std::size_t step)>;

/// FreeCAD reads intersections of two only.
enum class Intersections { of_all, in_pairs };

/// The plan as blocks of union(), intersection() and difference(), indented. O(size), no recursion
[[nodiscard]] std::string print_blocks(const script::Plan& plan, const StatementOf& statement_of,
                                       Intersections intersections);

}  // namespace cloud2csg::openscad
