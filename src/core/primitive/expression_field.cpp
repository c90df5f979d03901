#include "core/primitive/expression_field.hpp"

#include <variant>

#include "core/primitive/expression.hpp"

namespace cloud2csg {

void evaluate_expression(const Primitive& primitive, PointsView points, const FieldSpans& out) {
  // A parser of its own for each batch: parsers are not shared between threads.
  ExpressionEvaluator evaluator(std::get<Expression>(primitive.shape));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d local = primitive.pose.to_local(points[i]);
    if (!out.distance.empty()) out.distance[i] = evaluator.value(local);
    if (out.gradient_x.empty()) continue;
    const Eigen::Vector3d slope = primitive.pose.orientation * evaluator.gradient(local);
    out.gradient_x[i] = slope.x();
    out.gradient_y[i] = slope.y();
    out.gradient_z[i] = slope.z();
  }
}

}  // namespace cloud2csg
