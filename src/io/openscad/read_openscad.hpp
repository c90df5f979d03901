#pragma once

#include <filesystem>

#include "cloud2csg/model.hpp"

namespace cloud2csg {

/// The model of a .scad file. Where it has more in it than parse_openscad() reads, OpenSCAD flattens it, which a
/// warning of the model tells. O(n log n), without OpenSCAD's share @throws Error
[[nodiscard]] Model read_openscad(const std::filesystem::path& file);

}  // namespace cloud2csg
