#include <fmt/format.h>

#include <cmath>

#include "cloud2csg/primitive.hpp"
#include "core/geometry/boxes.hpp"
#include "core/primitive/expression.hpp"
#include "core/primitive/polytope.hpp"
#include "core/primitive/profile.hpp"
#include "core/primitive/refuse.hpp"
#include "core/primitive/shape.hpp"

namespace cloud2csg {
namespace {

void require_positive(const char* where, double value) {
  if (!std::isfinite(value) || value <= 0) refuse_primitive(where, fmt::format("a positive number, not {}", value));
}

void require_not_negative(const char* where, double value) {
  if (!std::isfinite(value) || value < 0)
    refuse_primitive(where, fmt::format("a number that is not negative, not {}", value));
}

void validate_cone(const Cone& cone) {
  require_not_negative("radius_bottom", cone.radius_bottom);
  require_not_negative("radius_top", cone.radius_top);
  require_positive("height", cone.height);
  if (cone.radius_bottom == 0 && cone.radius_top == 0) {
    refuse_primitive("radius_bottom", "at least one of radius_bottom and radius_top above 0");
  }
}

void validate_torus(const Torus& torus) {
  require_positive("major_radius", torus.major_radius);
  require_positive("minor_radius", torus.minor_radius);
  if (torus.minor_radius > torus.major_radius) {
    refuse_primitive("minor_radius",
                     fmt::format("at most the major radius {}, not {}", torus.major_radius, torus.minor_radius));
  }
}

void require_value_at(ExpressionEvaluator& evaluator, const Eigen::Vector3d& point) {
  if (std::abs(evaluator.value(point)) < k_no_distance) return;
  refuse_primitive("distance", fmt::format("a finite value within the bounds; there is none at ({}, {}, {})", point.x(),
                                           point.y(), point.z()));
}

void validate_expression(const Expression& expression) {
  const AlignedBox& box = expression.bounds;
  if (!is_finite(box) || (box.sizes().array() <= 0).any()) {
    refuse_primitive("bounds", "two finite corners, the first below the second in each coordinate");
  }
  validate_formula(expression.distance);
  ExpressionEvaluator evaluator(expression);
  // Refuse now a formula that has no value somewhere in its bounds, rather than find it in a result.
  const Eigen::Vector3d step = 0.25 * box.sizes();
  for (int x = 0; x <= 4; ++x) {
    for (int y = 0; y <= 4; ++y) {
      for (int z = 0; z <= 4; ++z) require_value_at(evaluator, box.min() + step.cwiseProduct(Eigen::Vector3d(x, y, z)));
    }
  }
}

void validate_pose(const Pose& pose) {
  if (!pose.position.allFinite()) refuse_primitive("pose/position", "three finite numbers");
  const double length = pose.orientation.norm();
  if (!std::isfinite(length) || std::abs(length - 1) > 1e-6) {
    refuse_primitive("pose/quaternion", fmt::format("a quaternion of unit length, not {:.9g}", length),
                     "divide it by that length");
  }
}

}  // namespace

void validate(const Primitive& primitive) {
  std::visit(
      Overloaded{[](const Box& box) {
                   for (const double edge : box.size) require_positive("size", edge);
                 },
                 [](const Sphere& sphere) { require_positive("radius", sphere.radius); },
                 [](const Cylinder& cylinder) {
                   require_positive("radius", cylinder.radius);
                   require_positive("height", cylinder.height);
                 },
                 [](const Cone& cone) { validate_cone(cone); }, [](const Torus& torus) { validate_torus(torus); },
                 [](const HalfSpace&) {}, [](const Polytope& polytope) { validate_polytope(polytope); },
                 [](const Extrusion& extrusion) {
                   validate_profile(extrusion.profile);
                   require_positive("height", extrusion.height);
                 },
                 [](const Revolution& revolution) {
                   validate_turned_profile(revolution.profile);
                   if (!(revolution.angle_deg > 0 && revolution.angle_deg <= 360)) {
                     refuse_primitive("angle_deg",
                                      fmt::format("above 0 and at most 360, not {}", revolution.angle_deg));
                   }
                 },
                 [](const Expression& expression) { validate_expression(expression); }},
      primitive.shape);
  validate_pose(primitive.pose);
  if (primitive.displacement) require_positive("displacement/frequency", primitive.displacement->frequency);
  if (primitive.evidence && !(primitive.evidence->rms >= 0 && std::isfinite(primitive.evidence->rms))) {
    refuse_primitive("evidence/rms", "a finite number of 0 or more");
  }
}

}  // namespace cloud2csg
