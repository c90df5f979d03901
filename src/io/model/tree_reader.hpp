#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// Throws Error, with a place relative to the node, when a node violates the definition. Ignores children.
using NodeCheck = std::function<void(const char* definition, const nlohmann::json& node)>;

/// Reads the n-ary tree as a binary one: `a, b, c` under one union become `(a | b) | c`. O(size), no recursion. @throws
/// Error for an unknown primitive id, and whatever `check` throws.
[[nodiscard]] CsgTree read_tree(const nlohmann::json& root,
                                const std::map<std::string, PrimitiveIndex, std::less<>>& index_of_id,
                                const NodeCheck& check);

}  // namespace cloud2csg
