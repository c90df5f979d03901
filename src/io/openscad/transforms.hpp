#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "io/openscad/values.hpp"

namespace cloud2csg::scad {

/// The map of a call of translate, rotate, scale, mirror or multmatrix; absent for any other call.
/// @throws Error for arguments that are not as OpenSCAD's manual has them.
[[nodiscard]] std::optional<Eigen::Affine3d> transform_of(const Statement& call, const Scope& scope,
                                                          std::string_view text);

}  // namespace cloud2csg::scad
