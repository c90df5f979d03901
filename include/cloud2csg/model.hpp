#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// What a model file holds: primitives and, where known, the tree over them.
struct Model {
  PrimitiveSet primitives;
  std::optional<CsgTree> tree = {};
  /// Free text about where the model comes from; kept when a file is read and written again.
  std::string description = {};
};

/// @throws Error naming the file and the path of the field (e.g. "/primitives/3/radius"): not JSON, not the schema
/// (unknown fields are refused), duplicate or dangling id, a parameter that validate() refuses.
[[nodiscard]] Model read_model(const std::filesystem::path& file);
/// The same from text; `name` stands for the file in messages.
[[nodiscard]] Model parse_model(std::string_view json, const std::string& name = "model");

/// The tree is written n-ary: chains of the same union or intersection become one node with many children.
[[nodiscard]] std::string to_json(const Model& model);
/// Nothing half-written: a temporary file, then a rename. @throws Error
void write_model(const std::filesystem::path& file, const Model& model);

/// The JSON schema that model files are validated against.
[[nodiscard]] std::string_view model_schema();

}  // namespace cloud2csg
