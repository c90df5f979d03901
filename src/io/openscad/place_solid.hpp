#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg::scad {

/// Why something cannot be one of our solids, for a message.
struct Misfit {
  std::string expected;
};

/// A solid of any type but half-space and expression, moved by any affine map: scaled, mirrored and sheared as far as
/// it stays one of our solids. Boxes and polytopes do always, as polytopes where need be; cylinders and cones must
/// stay round and upright, spheres and tori keep their proportions. What differs by less than 1e-4 is the same, since
/// OpenSCAD writes six digits.
[[nodiscard]] std::variant<Primitive, Misfit> place_solid(const Shape& shape, const Eigen::Affine3d& frame);

/// The polytope that a polyhedron with these faces (corner numbers, in either direction all around) encloses. It must
/// be closed and convex; faces in one plane become one. O(faces x corners)
[[nodiscard]] std::variant<Polytope, Misfit> convex_polytope(std::span<const Eigen::Vector3d> corners,
                                                             std::span<const std::vector<std::size_t>> faces);

/// A frustum with few corners around: the polyhedron that OpenSCAD makes of a cylinder with $fn = `facets`. Centred,
/// axis z; one of the radii may be 0.
[[nodiscard]] std::variant<Polytope, Misfit> faceted_frustum(double radius_bottom, double radius_top, double height,
                                                             int facets);

}  // namespace cloud2csg::scad
