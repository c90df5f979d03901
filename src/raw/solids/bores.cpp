#include "raw/solids/bores.hpp"

#include <algorithm>
#include <cmath>

namespace cloud2csg {

using Eigen::Vector3d;

std::optional<Vector3d> tangent_place(const Surface& cylinder, const Surface& torus, double tolerance) {
  constexpr double k_most_cosine = 0.1;  // 6 degrees
  if (cylinder.type != SurfaceType::cylinder || torus.type != SurfaceType::torus) return std::nullopt;
  const Vector3d offset = cylinder.position - torus.position;
  const Vector3d foot = offset - offset.dot(cylinder.axis) * cylinder.axis;
  const double height = foot.dot(torus.axis);
  const double off = std::hypot(height, (foot - height * torus.axis).norm() - torus.radius);
  const bool touches = std::abs(cylinder.axis.dot(torus.axis)) < k_most_cosine && off < tolerance;
  return touches ? std::optional<Vector3d>(torus.position + foot) : std::nullopt;
}

bool is_blind(const Surface& bore, const Vector3d& place, const PointCloud& cloud,
              std::span<const DetectedSurface> surfaces) {
  const double length = (place - bore.position).dot(bore.axis);
  return std::ranges::any_of(surfaces, [&](const DetectedSurface& floor) {
    const SurfaceType type = floor.surface.type;
    if (type != SurfaceType::plane && type != SurfaceType::cone && type != SurfaceType::sphere) return false;
    const auto within = std::ranges::count_if(floor.points, [&](std::uint32_t i) {
      const Vector3d point = cloud.positions[i];
      const double share = (point - bore.position).dot(bore.axis) / length;
      return share > 0 && share < 1 && signed_distance(bore, point) > 0.1 * bore.radius;
    });
    return within >= k_least_floor_points;
  });
}

}  // namespace cloud2csg
