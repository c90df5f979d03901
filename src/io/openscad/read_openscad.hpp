#pragma once

#include <filesystem>

#include "cloud2csg/model.hpp"

namespace cloud2csg {

/// Reads a .scad file. OpenSCAD flattens what parse_openscad() refuses, and the model says so in a warning.
/// O(n log n), without OpenSCAD's share. @throws Error
[[nodiscard]] Model read_openscad(const std::filesystem::path& file);

}  // namespace cloud2csg
