#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// A model file (.json), or one of OpenSCAD: .csg as parse_openscad() reads it, .scad too; what is beyond that in a
/// .scad, OpenSCAD flattens, where it is installed, which `warnings` tell. Names and digits beyond six are lost by
/// that.
/// @throws Error naming the file and the path of the field (e.g. "/primitives/3/radius"): not JSON, not the schema
/// (unknown fields are refused), duplicate or dangling id, a parameter that validate() refuses.
[[nodiscard]] Model read_model(const std::filesystem::path& file);
/// The same from JSON text; `name` stands for the file in messages.
[[nodiscard]] Model parse_model(std::string_view json, const std::string& name = "model");

/// The model that a text in OpenSCAD's language makes, of the part of the language that docs/openscad.md lists: cube,
/// sphere, cylinder, convex polyhedron, torus, moved by any affine map after which they are solids of ours; union,
/// difference, intersection; variables, loops, modules without parameters. Solids that are equal become one primitive.
/// Solids are round whatever $fn is, but for cylinders of 3 to 8 facets, which become prisms. Nesting is limited, so
/// no text overflows the stack. O(n log n)
/// @throws Error naming the file, line and column
[[nodiscard]] Model parse_openscad(std::string_view text, const std::string& name = "model");

/// The tree is written n-ary: chains of the same union or intersection become one node with many children.
[[nodiscard]] std::string to_json(const Model& model);
/// Nothing half-written: a temporary file, then a rename. @throws Error
void write_model(const std::filesystem::path& file, const Model& model);

/// The JSON schema that model files are validated against.
[[nodiscard]] std::string_view model_schema();

}  // namespace cloud2csg
