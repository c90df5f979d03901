#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "cloud2csg/primitive.hpp"
#include "io/openscad/terms.hpp"

/// OpenSCAD calls that make solids and maps. All functions throw Refusal for invalid arguments.
namespace cloud2csg::scad {

/// A solid without children in its own frame, and that frame relative to the call's.
struct LeafSolid {
  Shape shape;
  Eigen::Affine3d frame = Eigen::Affine3d::Identity();
};

/// The solid of cube, sphere, cylinder or (convex) polyhedron; absent for other calls. With $fn from 3 to 8, a cylinder
/// is a prism or pyramid as drawn, otherwise round.
[[nodiscard]] std::optional<LeafSolid> leaf_solid(const Arguments& call);

/// The map of translate, rotate, scale, mirror or multmatrix; absent for other calls.
[[nodiscard]] std::optional<Eigen::Affine3d> map_of(const Arguments& call);

[[nodiscard]] double round_radius(const Arguments& call);

/// 3 to 8 facets for a $fn above 0 and up to 8: so few mean a polygon, not a circle. Absent for all others.
[[nodiscard]] std::optional<int> facets_of(const Arguments& call);

/// Applies an affine map to any solid but half-spaces and expressions, if the result is one of our solids. Boxes
/// and polytopes always allow it, if need be as polytopes. Cylinders and cones must stay round and upright; spheres and
/// tori must keep proportions, as arcs of profiles must. Ignores differences below 1e-4: OpenSCAD writes six digits.
/// `offset`: place in the text.
[[nodiscard]] Primitive place_solid(const Shape& shape, const Eigen::Affine3d& frame, std::size_t offset);

}  // namespace cloud2csg::scad
