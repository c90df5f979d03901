#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "cloud2csg/primitive.hpp"
#include "io/openscad/terms.hpp"

/// The calls of OpenSCAD that make solids and maps. All functions throw Refusal for arguments that make none.
namespace cloud2csg::scad {

/// A solid without children, in its own frame, and where that is in the frame of the call.
struct LeafSolid {
  Shape shape;
  Eigen::Affine3d frame = Eigen::Affine3d::Identity();
};

/// Of cube, sphere, cylinder or polyhedron, which must be convex; absent for any other call. Where $fn is 3 to 8, a
/// cylinder is a prism or pyramid, as it is drawn; else it is round.
[[nodiscard]] std::optional<LeafSolid> leaf_solid(const Arguments& call);

/// Of translate, rotate, scale, mirror or multmatrix; absent for any other call.
[[nodiscard]] std::optional<Eigen::Affine3d> map_of(const Arguments& call);

/// Of circle or sphere.
[[nodiscard]] double round_radius(const Arguments& call);

/// A solid of any type but half-space and expression, moved by any affine map: scaled, mirrored and sheared as far as
/// it stays one of our solids. Boxes and polytopes do always, as polytopes where need be; cylinders and cones must
/// stay round and upright, spheres and tori keep their proportions. What differs by less than 1e-4 is the same, since
/// OpenSCAD writes six digits. `offset` is where the text asks for it.
[[nodiscard]] Primitive place_solid(const Shape& shape, const Eigen::Affine3d& frame, std::size_t offset);

}  // namespace cloud2csg::scad
