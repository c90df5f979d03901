#include "core/primitive/polytope_faces.hpp"

#include <algorithm>
#include <cmath>

namespace cloud2csg {
namespace {

/// The corners on one plane, in order around it.
std::vector<std::size_t> corners_on(const Plane& plane, const std::vector<Eigen::Vector3d>& corners, double tolerance) {
  std::vector<std::size_t> on_plane;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (std::abs(plane.normal.dot(corners[i]) - plane.offset) > tolerance) continue;
    on_plane.push_back(i);
    centre += corners[i];
  }
  centre /= std::max(1.0, static_cast<double>(on_plane.size()));
  const Eigen::Vector3d u = plane.normal.unitOrthogonal();
  const Eigen::Vector3d v = plane.normal.cross(u);
  const auto angle = [&](std::size_t i) { return std::atan2(v.dot(corners[i] - centre), u.dot(corners[i] - centre)); };
  std::sort(on_plane.begin(), on_plane.end(), [&](std::size_t a, std::size_t b) { return angle(a) < angle(b); });
  return on_plane;
}

}  // namespace

PolytopeFaces faces_of(const Polytope& polytope) {
  constexpr double k_on_plane = 1e-9;  // as a part of the size
  PolytopeFaces result{.corners = corners(polytope), .faces = {}};
  AlignedBox box;
  for (const Eigen::Vector3d& corner : result.corners) box.extend(corner);
  for (const Plane& plane : polytope.planes) {
    std::vector<std::size_t> face = corners_on(plane, result.corners, k_on_plane * box.diagonal().norm());
    if (face.size() >= 3 && std::find(result.faces.begin(), result.faces.end(), face) == result.faces.end())
      result.faces.push_back(std::move(face));
  }
  return result;
}

}  // namespace cloud2csg
