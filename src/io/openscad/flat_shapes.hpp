#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/primitive.hpp"
#include "io/openscad/solids.hpp"
#include "io/openscad/terms.hpp"

/// OpenSCAD's flat shapes and what sweeps them. All functions throw Refusal for invalid arguments.
namespace cloud2csg::scad {

/// A shape in the plane, and its place in the text.
struct FlatShape {
  Profile profile;
  std::size_t offset;
};

/// A tree over flat shapes, in postfix order like CsgTree. Empty if there is no shape.
struct FlatTree {
  std::vector<FlatShape> shapes = {};
  std::vector<CsgNode> nodes = {};
};

/// How linear_extrude or rotate_extrude makes solids.
struct Sweep {
  std::optional<double> height;  ///< of an extrusion
  double angle_deg = 360;        ///< of a revolution, above 0
  Eigen::Affine3d frame = Eigen::Affine3d::Identity();
};

/// @throws Refusal also for a taper, a twist or an angle of 0
[[nodiscard]] Sweep sweep_of(const Arguments& call);

/// The profile of circle, square or polygon; absent for other calls. A circle is round. In an extrusion, $fn up to 8
/// makes it a polygon.
[[nodiscard]] std::optional<Profile> flat_profile(const Arguments& call, bool is_turned);

/// The shape under a map of the plane, which must keep arcs round.
[[nodiscard]] FlatShape placed_in_plane(const FlatShape& shape, const Eigen::Affine3d& frame);

/// The solid of a turned circle beside the axis, perhaps cut by a square that leaves a pinhole; absent for other trees.
[[nodiscard]] std::optional<LeafSolid> torus_of(const FlatTree& tree);

/// The solid of one shape, in the sweep's frame.
[[nodiscard]] Shape swept(FlatShape shape, const Sweep& sweep);

}  // namespace cloud2csg::scad
