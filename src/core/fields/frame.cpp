#include "core/fields/frame.hpp"

#include <algorithm>

namespace cloud2csg {
namespace {

/// Rounding of single precision is 6e-8 of the largest length involved: a five-thousandth of this.
constexpr double k_single_precision_noise = 3e-4;

/// Whether its pose may be moved along its plane, which says nothing of the solid but is rounded.
bool is_plain_half_space(const Primitive& primitive) {
  return std::holds_alternative<HalfSpace>(primitive.shape) && !primitive.displacement;
}

Eigen::Vector3d foot_of_origin(const Pose& pose) {
  const Eigen::Vector3d normal = pose.orientation * Eigen::Vector3d::UnitZ();
  return normal * normal.dot(pose.position);
}

/// The largest length that goes into a primitive's distances, seen from a point.
double reach_from(const Eigen::Vector3d& centre, const Primitive& primitive) {
  Pose pose = primitive.pose;
  pose.position -= centre;
  if (is_plain_half_space(primitive)) return foot_of_origin(pose).norm();
  // Of a displaced solid its own size will do: to search for how far it really reaches takes longer than the rest.
  Primitive plain = primitive;
  plain.displacement.reset();
  const Eigen::Vector3d half_size = oriented_bounds(plain).half_size;
  return pose.position.norm() + (half_size.allFinite() ? 2 * half_size.norm() : 0.0);
}

}  // namespace

bool is_single_enough(const AlignedBox& points, const PrimitiveSet& primitives, double noise) {
  double length = points.diagonal().norm();
  for (const Primitive& primitive : primitives) length = std::max(length, reach_from(points.center(), primitive));
  return noise >= k_single_precision_noise * length;
}

template <class Real>
void move_to_frame(PrimitiveSet& primitives, const Eigen::Vector3d& origin) {
  for (Primitive& primitive : primitives) {
    primitive.pose.position -= origin;
    if (sizeof(Real) < sizeof(double) && is_plain_half_space(primitive)) {
      primitive.pose.position = foot_of_origin(primitive.pose);
    }
  }
}

template void move_to_frame<double>(PrimitiveSet&, const Eigen::Vector3d&);
template void move_to_frame<float>(PrimitiveSet&, const Eigen::Vector3d&);

}  // namespace cloud2csg
