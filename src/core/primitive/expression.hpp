#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cloud2csg/primitive.hpp"

namespace cloud2csg {

/// What a formula without a value at a point counts as there: far outside. Finite, so that what is computed from it is.
inline constexpr double k_no_distance = 1e30;

/// A parsed formula of x, y and z. It holds the variables that its parser reads, so it stays where it was made and
/// serves one thread.
class ExpressionEvaluator {
 public:
  /// @throws Error (where = "distance") when the formula does not parse.
  explicit ExpressionEvaluator(const Expression& expression);
  ~ExpressionEvaluator();
  ExpressionEvaluator(const ExpressionEvaluator&) = delete;
  ExpressionEvaluator& operator=(const ExpressionEvaluator&) = delete;
  ExpressionEvaluator(ExpressionEvaluator&&) = delete;
  ExpressionEvaluator& operator=(ExpressionEvaluator&&) = delete;

  /// Within +-k_no_distance; that itself where the formula is not a number.
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

/// The fields of an Expression, without displacement, a point at a time. Spans have the size of `points`; an empty
/// gradient is not computed. Shared by the plain and the fast path: a formula that is only known as text has no
/// vectors. Precondition: the shape is an Expression. @throws Error when the formula does not parse.
void evaluate_expression(const Primitive& primitive, PointsView points, const FieldSpans& out);

}  // namespace cloud2csg
