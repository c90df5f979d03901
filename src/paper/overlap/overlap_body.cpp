#include "paper/overlap/overlap_body.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace cloud2csg {
namespace {

/// Gradients are sampled at this many places along each axis of an expression's bounds...
constexpr int k_gradient_samples = 9;
/// ...and the steepest one found is multiplied by this, since the steepest place lies between samples.
constexpr double k_gradient_safety = 2.0;

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

Points sample_grid(const AlignedBox& box, const Pose& pose) {
  Points points;
  const auto coordinate = [&box](int axis, int step) {
    return box.min()[axis] + box.sizes()[axis] * (step + 0.5) / k_gradient_samples;
  };
  for (int i = 0; i < k_gradient_samples; ++i) {
    for (int j = 0; j < k_gradient_samples; ++j) {
      for (int k = 0; k < k_gradient_samples; ++k) {
        points.push_back(pose.to_world({coordinate(0, i), coordinate(1, j), coordinate(2, k)}));
      }
    }
  }
  return points;
}

double sampled_lipschitz(const Primitive& solid, const Expression& expression) {
  const Points gradients = gradient(solid, sample_grid(expression.bounds, solid.pose));
  double steepest = 0;
  for (std::size_t i = 0; i < gradients.size(); ++i) {
    const double slope = gradients[i].norm();
    if (std::isfinite(slope)) steepest = std::max(steepest, slope);
  }
  // A field that is flat wherever it was sampled says nothing: take it for a distance.
  return steepest > 0 ? k_gradient_safety * steepest : 1.0;
}

double lipschitz_of(const Primitive& solid) {
  // The samples of an expression include its displacement. For the others: every distance has slope 1, and the
  // gradient of sin(kx) sin(ky) sin(kz) has at most the length k.
  if (const auto* expression = std::get_if<Expression>(&solid.shape)) return sampled_lipschitz(solid, *expression);
  return 1.0 + (solid.displacement ? std::abs(solid.displacement->frequency) : 0.0);
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
  body.lipschitz = lipschitz_of(body.solid);
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
