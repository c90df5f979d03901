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

}  // namespace cloud2csg
