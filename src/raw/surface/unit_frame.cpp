#include "raw/surface/unit_frame.hpp"

#include <cassert>
#include <cmath>

namespace cloud2csg {

UnitFrame unit_frame(std::span<const Eigen::Vector3d> points) {
  assert(!points.empty());
  const auto count = static_cast<double>(points.size());
  // Relative to one point: a sum of coordinates around 1e6 would lose digits.
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point - points.front();
  const Eigen::Vector3d origin = points.front() + sum / count;
  double squares = 0;
  for (const Eigen::Vector3d& point : points) squares += (point - origin).squaredNorm();
  const double scale = std::sqrt(squares / count);
  return {.origin = origin, .scale = scale > 0 ? scale : 1.0};
}

std::vector<Eigen::Vector3d> to_frame(const UnitFrame& frame, std::span<const Eigen::Vector3d> points) {
  std::vector<Eigen::Vector3d> result;
  result.reserve(points.size());
  for (const Eigen::Vector3d& point : points) result.emplace_back((point - frame.origin) / frame.scale);
  return result;
}

Surface to_frame(const UnitFrame& frame, Surface surface) {
  surface.position = (surface.position - frame.origin) / frame.scale;
  surface.radius /= frame.scale;
  surface.minor_radius /= frame.scale;
  return surface;
}

Surface from_frame(const UnitFrame& frame, Surface surface) {
  surface.position = frame.origin + frame.scale * surface.position;
  surface.radius *= frame.scale;
  surface.minor_radius *= frame.scale;
  return surface;
}

}  // namespace cloud2csg
