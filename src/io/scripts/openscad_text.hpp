#pragma once

#include <set>
#include <string>

#include "cloud2csg/export.hpp"
#include "io/scripts/script_text.hpp"

/// Small parts of an OpenSCAD program.
namespace cloud2csg::openscad {

/// Words of the language, its modules, and the modules that every file of ours may define.
[[nodiscard]] const std::set<std::string>& reserved_words();

/// [x, y, z]
[[nodiscard]] std::string list(const Eigen::Vector3d& vector, const script::NumberFormat& number);

/// Angles for rotate() that turn the solid as its pose does. A solid of revolution about z is turned about two axes
/// only.
[[nodiscard]] Eigen::Vector3d rotation_angles(const Primitive& primitive);

}  // namespace cloud2csg::openscad
