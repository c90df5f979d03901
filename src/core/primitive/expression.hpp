#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// The distance where a formula has no value: far outside. It is finite, so that values computed from it are finite.
inline constexpr double k_no_distance = 1e30;

/// A parsed formula of x, y and z. Its parser reads its variables by address, so it cannot move. It serves one thread.
class ExpressionEvaluator {
 public:
  /// @throws Error (where = "distance") when the formula does not parse.
  explicit ExpressionEvaluator(const Expression& expression);
  ~ExpressionEvaluator();
  ExpressionEvaluator(const ExpressionEvaluator&) = delete;
  ExpressionEvaluator& operator=(const ExpressionEvaluator&) = delete;
  ExpressionEvaluator(ExpressionEvaluator&&) = delete;
  ExpressionEvaluator& operator=(ExpressionEvaluator&&) = delete;

  /// Clamped to +-k_no_distance; k_no_distance where the formula is not a number.
  [[nodiscard]] double value(const Eigen::Vector3d& local);

  /// Central differences; local z where they vanish or are not finite.
  [[nodiscard]] Eigen::Vector3d gradient(const Eigen::Vector3d& local);

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
  double step_;
};

/// @throws Error (where = "distance") when the formula does not parse, uses other names than x, y and z, assigns, or
/// gives more than one value.
void validate_formula(const std::string& formula);

/// Evaluates an Expression without displacement, one point at a time. Spans have the size of `points`; empty ones are
/// not computed. The plain and the fast path share this, because a formula that is only known as text has no vectors.
/// Precondition: the shape is an Expression. @throws Error when the formula does not parse.
void evaluate_expression(const Primitive& primitive, PointsView points, const FieldSpans& out);

}  // namespace cloud2csg
