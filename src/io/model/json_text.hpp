#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace cloud2csg {

/// JSON text as a value. @throws Error with line and column (in bytes) for a syntax error; with the path of the field
/// for one that appears twice in an object, for a number that no double holds, for nesting beyond what a tree of
/// k_max_tree_depth levels needs. The error names no file.
[[nodiscard]] nlohmann::json parse_json(std::string_view text);

/// Deepest tree that is read, in levels of the file's n-ary tree.
constexpr int k_max_tree_depth = 10'000;

}  // namespace cloud2csg
