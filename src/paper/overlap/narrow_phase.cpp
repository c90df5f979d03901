#include "paper/overlap/narrow_phase.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

namespace cloud2csg {
namespace {

/// Half-spaces whose normals are this close to opposite (as a distance of unit vectors) count as parallel: otherwise
/// they meet more than 10^9 units away.
constexpr double k_opposite_tolerance = 1e-9;

bool spheres_overlap(const OverlapBody& a, const OverlapBody& b, double tolerance) {
  const double reach = std::get<Sphere>(a.solid.shape).radius + std::get<Sphere>(b.solid.shape).radius;
  return (a.center - b.center).norm() <= reach + tolerance;
}

Eigen::Vector3d outward_normal(const OverlapBody& half_space) {
  return half_space.solid.pose.orientation * Eigen::Vector3d::UnitZ();
}

/// How far a displacement can move a surface that is given by a distance.
double amplitude(const OverlapBody& body) {
  return body.solid.displacement ? 1.0 : 0.0;
}

/// Two unbounded half-spaces, displaced or not. Parallel displaced ones that may touch count as overlapping.
bool half_spaces_overlap(const OverlapBody& a, const OverlapBody& b, double tolerance) {
  const Eigen::Vector3d normal = outward_normal(a);
  if ((normal + outward_normal(b)).norm() > k_opposite_tolerance) return true;
  const double gap = normal.dot(b.center - a.center);
  return gap <= tolerance + amplitude(a) + amplitude(b);
}

bool half_space_overlaps(const OverlapBody& half_space, const OverlapBody& convex, double tolerance) {
  const Eigen::Vector3d normal = outward_normal(half_space);
  const Eigen::Vector3d deepest = support_point(convex, -normal);
  return normal.dot(deepest - half_space.center) <= tolerance;
}

bool is_any_half_space(const OverlapBody& body) {
  return std::holds_alternative<HalfSpace>(body.solid.shape);
}

}  // namespace

bool bodies_overlap(const OverlapBody& a, const OverlapBody& b, double tolerance, const RunContext& run) {
  if (is_any_half_space(a) && is_any_half_space(b)) return half_spaces_overlap(a, b, tolerance);
  if (a.kind == BodyKind::field || b.kind == BodyKind::field) return fields_overlap(a, b, tolerance, run);
  if (a.kind == BodyKind::half_space) return half_space_overlaps(a, b, tolerance);
  if (b.kind == BodyKind::half_space) return half_space_overlaps(b, a, tolerance);
  if (a.kind == BodyKind::sphere && b.kind == BodyKind::sphere) return spheres_overlap(a, b, tolerance);
  return convex_bodies_overlap(a, b, tolerance);
}

}  // namespace cloud2csg
