#include "io/openscad/profile_maps.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace cloud2csg::scad {

bool has_arcs(const Profile& profile) {
  return std::ranges::any_of(profile.paths, [](const ClosedPath& path) {
    return std::ranges::any_of(path, [](const PathCorner& corner) { return corner.bulge != 0; });
  });
}

Profile mapped(Profile profile, const Eigen::Matrix2d& linear, const Eigen::Vector2d& shift) {
  const bool is_mirrored = linear.determinant() < 0;
  for (ClosedPath& path : profile.paths) {
    for (PathCorner& corner : path) {
      corner.point = linear * corner.point + shift;
      if (is_mirrored) corner.bulge = -corner.bulge;
    }
  }
  return profile;
}

}  // namespace cloud2csg::scad
