#include "core/primitive/placement.hpp"

#include <cmath>
#include <numbers>

#include "core/primitive/profile.hpp"

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

std::vector<ProfileEdge> profile_edges(const Profile& profile, bool is_revolved) {
  std::vector<ProfileEdge> edges;
  for (const ProfileSegment& s : segments_of(profile)) {
    const Eigen::Vector2d along = s.end - s.start;
    const Eigen::Vector2d middle = s.normal(0.5);
    ProfileEdge edge{.start_x = s.start.x(),
                     .start_y = s.start.y(),
                     .end_y = s.end.y(),
                     .along_x = along.x(),
                     .along_y = along.y(),
                     .inverse_square = 1 / along.squaredNorm(),
                     .up = along.y() > 0 ? 1.0 : -1.0,
                     .is_left_on_chord = s.is_left(s.start),
                     .normal_x = middle.x(),
                     .normal_y = middle.y(),
                     .is_arc = s.is_arc(),
                     .has_surface = !is_revolved || !s.is_on_axis()};
    if (s.is_arc()) {
      edge.turn = std::copysign(1.0, s.bulge);
      const Eigen::Vector2d outward = edge.turn * s.normal(0);
      const Eigen::Vector2d first = to_the_left(s.normal(0));
      const Eigen::Vector2d last = to_the_left(s.normal(1));
      edge.centre_x = s.centre.x(), edge.centre_y = s.centre.y(), edge.radius = s.radius;
      edge.outward_x = outward.x(), edge.outward_y = outward.y();
      edge.first_x = first.x(), edge.first_y = first.y();
      edge.last_x = last.x(), edge.last_y = last.y();
      edge.is_long_arc = std::abs(s.angle) > std::numbers::pi;
    }
    edges.push_back(edge);
  }
  return edges;
}

}  // namespace cloud2csg
