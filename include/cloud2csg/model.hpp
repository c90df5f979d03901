#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "cloud2csg/csg_tree.hpp"

namespace cloud2csg {

/// Reads a model file (.json) or OpenSCAD's language (.csg, .scad) as parse_openscad() does. OpenSCAD, if installed,
/// flattens a .scad beyond that; names and digits beyond six are then lost (see `warnings`).
/// @throws Error naming the file and the path of the field (e.g. "/primitives/3/radius"): not JSON, against the schema
/// (unknown fields are refused), duplicate or unknown id, a parameter that validate() refuses.
[[nodiscard]] Model read_model(const std::filesystem::path& file);
/// The same from JSON text; messages use `name` as the file name.
[[nodiscard]] Model parse_model(std::string_view json, const std::string& name = "model");

/// The model of a text in OpenSCAD's language. docs/openscad.md lists the supported part: cube, sphere, cylinder,
/// convex polyhedron, torus, under any affine map that keeps them among our solids; union, difference, intersection;
/// variables, loops, modules without parameters. Equal solids become one primitive. $fn is ignored and solids are
/// round, except that cylinders of 3 to 8 facets become prisms. Nesting is limited to protect the stack. O(n log n)
/// @throws Error naming the file, line and column
[[nodiscard]] Model parse_openscad(std::string_view text, const std::string& name = "model");

/// Writes the tree n-ary: a chain of one union or intersection becomes a node with many children.
[[nodiscard]] std::string to_json(const Model& model);
/// Never leaves a partial file: writes a temporary file, then renames it. @throws Error
void write_model(const std::filesystem::path& file, const Model& model);

/// The JSON schema of model files.
[[nodiscard]] std::string_view model_schema();

}  // namespace cloud2csg
