#include "core/primitive/placement.hpp"

namespace cloud2csg {
namespace {

std::array<double, 3> to_array(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

Placement placement_of(const Pose& pose) {
  // Poses from files have unit length to about six digits only.
  const Eigen::Matrix3d rotation = pose.orientation.normalized().toRotationMatrix();
  return {.x_axis = to_array(rotation.col(0)),
          .y_axis = to_array(rotation.col(1)),
          .z_axis = to_array(rotation.col(2)),
          .position = to_array(pose.position),
          .is_unrotated = rotation == Eigen::Matrix3d::Identity()};
}

std::vector<WorldPlane> world_planes(const Polytope& polytope, const Pose& pose) {
  const Eigen::Quaterniond orientation = pose.orientation.normalized();
  std::vector<WorldPlane> planes;
  planes.reserve(polytope.planes.size());
  for (const Plane& plane : polytope.planes) {
    const Eigen::Vector3d normal = orientation * plane.normal;
    planes.push_back({.normal_x = normal.x(),
                      .normal_y = normal.y(),
                      .normal_z = normal.z(),
                      .offset = plane.offset + normal.dot(pose.position)});
  }
  return planes;
}

}  // namespace cloud2csg
