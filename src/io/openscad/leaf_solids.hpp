#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "cloud2csg/primitive.hpp"
#include "io/openscad/values.hpp"

namespace cloud2csg::scad {

/// A solid without children, in its own frame, and where that is in the frame of the call.
struct LeafSolid {
  Shape shape;
  Eigen::Affine3d frame = Eigen::Affine3d::Identity();
};

/// The solid of a call of cube, sphere, cylinder or polyhedron; absent for any other call. Arguments are those of
/// OpenSCAD's manual. Where $fn is 3 to 8, a cylinder is a prism, as it is drawn; else it is round.
/// @throws Error for arguments that make no solid, and a polyhedron that is not convex.
[[nodiscard]] std::optional<LeafSolid> leaf_solid(const Statement& call, const Scope& scope, std::string_view text);

/// The radius of a call of circle or sphere. @throws Error
[[nodiscard]] double round_radius(const Statement& call, const Scope& scope, std::string_view text);

/// The sides of a call of square, which begins at the origin. @throws Error
[[nodiscard]] Eigen::Vector2d square_size(const Statement& call, const Scope& scope, std::string_view text);

}  // namespace cloud2csg::scad
