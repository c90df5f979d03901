#include "raw/solids/surfaces_of_known.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// Collects the surfaces of one solid.
class SurfaceList {
 public:
  explicit SurfaceList(const Pose& pose) : pose_(pose), axis_(pose.orientation * Vector3d::UnitZ()) {}

  void operator()(const Box& box) {
    for (int side = 0; side < 3; ++side) {
      for (const double sign : {-1.0, 1.0}) add_plane(sign * Vector3d::Unit(side), 0.5 * box.size[side]);
    }
  }
  void operator()(const Sphere& sphere) {
    surfaces.push_back({.type = SurfaceType::sphere, .position = pose_.position, .radius = sphere.radius});
  }
  void operator()(const Cylinder& cylinder) {
    add_cylinder(cylinder.radius);
    add_ends(cylinder.height);
  }
  void operator()(const Cone& cone) {
    add_ends(cone.height);
    const double slope = (cone.radius_top - cone.radius_bottom) / cone.height;
    const double to_apex = -0.5 * cone.height - cone.radius_bottom / slope;
    if (!std::isfinite(to_apex)) {
      add_cylinder(cone.radius_top);
      return;
    }
    surfaces.push_back({.type = SurfaceType::cone,
                        .position = pose_.to_world(to_apex * Vector3d::UnitZ()),
                        .axis = slope > 0 ? axis_ : Vector3d(-axis_),
                        .half_angle = std::atan(std::abs(slope))});
  }
  void operator()(const Torus& torus) {
    surfaces.push_back({.type = SurfaceType::torus,
                        .position = pose_.position,
                        .axis = axis_,
                        .radius = torus.major_radius,
                        .minor_radius = torus.minor_radius});
  }
  void operator()(const HalfSpace& /*half_space*/) { add_plane(Vector3d::UnitZ(), 0); }
  void operator()(const Polytope& polytope) {
    for (const Plane& plane : polytope.planes) add_plane(plane.normal, plane.offset);
  }
  void operator()(const Expression& /*expression*/) {}

  std::vector<Surface> surfaces;

 private:
  /// In the solid's own frame.
  void add_plane(const Vector3d& normal, double offset) {
    surfaces.push_back({.type = SurfaceType::plane,
                        .position = pose_.to_world(offset * normal),
                        .axis = (pose_.orientation * normal).normalized()});
  }
  void add_ends(double height) {
    add_plane(Vector3d::UnitZ(), 0.5 * height);
    add_plane(-Vector3d::UnitZ(), 0.5 * height);
  }
  void add_cylinder(double radius) {
    surfaces.push_back({.type = SurfaceType::cylinder, .position = pose_.position, .axis = axis_, .radius = radius});
  }

  const Pose& pose_;
  Vector3d axis_;
};

std::vector<Surface> surfaces_of(const Primitive& solid) {
  if (!is_plain(solid)) return {};
  SurfaceList list(solid.pose);
  std::visit(list, solid.shape);
  return std::move(list.surfaces);
}

/// Deals the solid's points out to its surfaces.
std::vector<DetectedSurface> with_points(const std::vector<Surface>& surfaces, const PointCloud& cloud,
                                         const KnownSolid& known) {
  std::vector<DetectedSurface> found;
  found.reserve(surfaces.size());
  for (const Surface& surface : surfaces) found.push_back({.surface = surface, .points = {}, .rms = known.own.rms});
  for (const std::uint32_t i : known.own.points) {
    const auto distance = [&](const DetectedSurface& one) {
      return std::abs(signed_distance(one.surface, cloud.positions[i]));
    };
    std::ranges::min_element(found, {}, distance)->points.push_back(i);
  }
  std::erase_if(found, [](const DetectedSurface& one) { return one.points.empty(); });
  return found;
}

}  // namespace

std::vector<DetectedSurface> surfaces_of_known(const PointCloud& cloud, std::span<const KnownSolid> known) {
  std::vector<DetectedSurface> all;
  for (const KnownSolid& one : known) {
    const std::vector<Surface> surfaces = surfaces_of(one.solid);
    if (surfaces.empty()) continue;
    const std::vector<DetectedSurface> found = with_points(surfaces, cloud, one);
    all.insert(all.end(), found.begin(), found.end());
  }
  return all;
}

}  // namespace cloud2csg
