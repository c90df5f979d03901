#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// Throws Error, its place counted from the node, when a node breaks the definition; children are not looked at.
using NodeCheck = std::function<void(const char* definition, const nlohmann::json& node)>;

/// The file's n-ary tree as a binary one: `a, b, c` under one union become `(a | b) | c`. O(size), no recursion.
/// @throws Error for an id that is no primitive's, and whatever `check` throws.
[[nodiscard]] CsgTree read_tree(const nlohmann::json& root,
                                const std::map<std::string, PrimitiveIndex, std::less<>>& index_of_id,
                                const NodeCheck& check);

}  // namespace cloud2csg
