#pragma once

#include <array>
#include <vector>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// A pose as the kernels read it: the solid's own axes as unit vectors of the world. Plain arrays, because the kernels
/// are compiled once per instruction set and Eigen is not.
struct Placement {
  std::array<double, 3> x_axis, y_axis, z_axis, position;
  bool is_unrotated;  ///< the axes are exactly the world's: kernels skip the rotation
};

[[nodiscard]] Placement placement_of(const Pose& pose);

/// The half-space normal . x <= offset in the world, as the kernels read it.
struct WorldPlane {
  double normal_x, normal_y, normal_z, offset;
};

[[nodiscard]] std::vector<WorldPlane> world_planes(const Polytope& polytope, const Pose& pose);

/// A segment of a profile, as the kernels read it.
struct ProfileEdge {
  double start_x, start_y, end_y;
  double along_x, along_y, inverse_square;  ///< from start to end, and 1 over its squared length
  double up;                                ///< 1 if the end is above the start, else -1
  bool is_left_on_chord;                    ///< as of ProfileSegment::is_left()
  double normal_x, normal_y;                ///< outward, in the middle
  bool is_arc, has_surface;
  double centre_x = 0, centre_y = 0, radius = 0;
  double outward_x = 0, outward_y = 0;                      ///< unit, from the centre to the start
  double first_x = 0, first_y = 0, last_x = 0, last_y = 0;  ///< directions of an arc at its ends
  double turn = 0;                                          ///< 1 if the arc turns left, and so is convex; else -1
  bool is_long_arc = false;                                 ///< by more than half a turn
};

/// Lines on the axis of a revolved profile have no surface.
[[nodiscard]] std::vector<ProfileEdge> profile_edges(const Profile& profile, bool is_revolved);

}  // namespace cloud2csg
