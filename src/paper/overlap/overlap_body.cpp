#include "paper/overlap/overlap_body.hpp"

#include <algorithm>
#include <variant>

#include "core/fields/lipschitz.hpp"

namespace cloud2csg {
namespace {

Primitive solid_of(const Primitive& primitive, const std::optional<OrientedBox>& extent) {
  if (!extent || bounds(primitive).sizes().allFinite()) return primitive;
  return {.id = primitive.id, .shape = Box{.size = 2.0 * extent->half_size}, .pose = extent->pose};
}

BodyKind kind_of(const Primitive& solid) {
  if (!is_convex(solid)) return BodyKind::field;
  if (std::holds_alternative<Sphere>(solid.shape)) return BodyKind::sphere;
  if (std::holds_alternative<HalfSpace>(solid.shape)) return BodyKind::half_space;
  return BodyKind::convex;
}

Eigen::Vector3d mean(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

OverlapBody make_overlap_body(const Primitive& primitive, const std::optional<OrientedBox>& extent) {
  OverlapBody body{.solid = solid_of(primitive, extent), .bounds = {}};
  body.bounds = bounds(body.solid);
  body.kind = kind_of(body.solid);
  body.center = body.solid.pose.position;
  body.lipschitz = lipschitz_estimate(body.solid);
  if (const auto* polytope = std::get_if<Polytope>(&body.solid.shape); polytope != nullptr && is_convex(body.solid)) {
    body.corners = corners(*polytope);
    for (Eigen::Vector3d& corner : body.corners) corner = body.solid.pose.to_world(corner);
    body.center = mean(body.corners);
  }
  return body;
}

Eigen::Vector3d support_point(const OverlapBody& body, const Eigen::Vector3d& direction) {
  if (body.corners.empty()) return support(body.solid, direction);
  return *std::max_element(body.corners.begin(), body.corners.end(),
                           [&direction](const auto& a, const auto& b) { return a.dot(direction) < b.dot(direction); });
}

}  // namespace cloud2csg
