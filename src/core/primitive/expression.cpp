#include "core/primitive/expression.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/primitive/refuse.hpp"

namespace cloud2csg {
namespace {

[[noreturn]] void refuse_formula(const std::string& reason) {
  refuse_primitive("distance", fmt::format("a formula in x, y and z: {}", reason),
                   "write it in muParser's syntax, for example sqrt(x^2+y^2+z^2)-1");
}

/// muParser would take `x = 1` as an assignment to a variable.
bool has_assignment(const std::string& formula) {
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (formula[i] != '=') continue;
    const bool is_equality = i + 1 < formula.size() && formula[i + 1] == '=';
    const bool ends_comparison = i > 0 && std::string("<>!").find(formula[i - 1]) != std::string::npos;
    if (is_equality) {
      ++i;
    } else if (!ends_comparison) {
      return true;
    }
  }
  return false;
}

}  // namespace

struct ExpressionEvaluator::Parser {
  double x = 0, y = 0, z = 0;
  mu::Parser parser;
};

ExpressionEvaluator::ExpressionEvaluator(const Expression& expression)
    : parser_(std::make_unique<Parser>()),
      // The cube root of the rounding error balances rounding against the third derivative.
      step_(6e-6 * std::max(0.5 * expression.bounds.diagonal().norm(), 1e-100)) {
  try {
    parser_->parser.DefineVar("x", &parser_->x);
    parser_->parser.DefineVar("y", &parser_->y);
    parser_->parser.DefineVar("z", &parser_->z);
    parser_->parser.SetExpr(expression.distance);
    (void)parser_->parser.Eval();
  } catch (const mu::Parser::exception_type& e) {
    refuse_formula(e.GetMsg());
  }
}

ExpressionEvaluator::~ExpressionEvaluator() = default;

double ExpressionEvaluator::value(const Eigen::Vector3d& local) {
  parser_->x = local.x();
  parser_->y = local.y();
  parser_->z = local.z();
  const double value = parser_->parser.Eval();
  return std::isnan(value) ? k_no_distance : std::clamp(value, -k_no_distance, k_no_distance);
}

Eigen::Vector3d ExpressionEvaluator::gradient(const Eigen::Vector3d& local) {
  Eigen::Vector3d slope;
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d before = local;
    Eigen::Vector3d after = local;
    before[axis] -= step_;
    after[axis] += step_;
    slope[axis] = (value(after) - value(before)) / (after[axis] - before[axis]);
  }
  const double squared = slope.squaredNorm();
  return std::isfinite(squared) && squared > 1e-280 ? slope : Eigen::Vector3d::UnitZ();
}

void validate_formula(const std::string& formula) {
  if (has_assignment(formula)) refuse_formula("assignments are not allowed");
  try {
    mu::Parser parser;
    parser.SetExpr(formula);
    for (const auto& [name, address] : parser.GetUsedVar()) {
      if (name != "x" && name != "y" && name != "z") refuse_formula(fmt::format("unknown name '{}'", name));
    }
    double x = 0;
    double y = 0;
    double z = 0;
    parser.DefineVar("x", &x);
    parser.DefineVar("y", &y);
    parser.DefineVar("z", &z);
    (void)parser.Eval();
    if (parser.GetNumResults() != 1) refuse_formula("it gives more than one value");
  } catch (const mu::Parser::exception_type& e) {
    refuse_formula(e.GetMsg());
  }
}

void evaluate_expression(const Primitive& primitive, PointsView points, const FieldSpans& out) {
  // Each batch has its own parser, because threads cannot share one.
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
