#include "core/fields/lipschitz.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "core/geometry/octree.hpp"

namespace cloud2csg {
namespace {

/// The steepest sampled slope of an expression within its bounds, with its displacement.
double sampled_slope(const Primitive& primitive, const Expression& expression) {
  constexpr int k_samples = 9;  // along each axis
  Points samples = lattice(expression.bounds, Eigen::Vector3i::Constant(k_samples)).centres;
  for (std::size_t i = 0; i < samples.size(); ++i) samples.set(i, primitive.pose.to_world(samples[i]));
  const Points gradients = gradient(primitive, samples);
  double steepest = 0;
  for (std::size_t i = 0; i < gradients.size(); ++i) {
    const double slope = gradients[i].norm();
    if (std::isfinite(slope)) steepest = std::max(steepest, slope);
  }
  return steepest;
}

template <typename Bound>
double steepest_of(const CsgTree& tree, const PrimitiveSet& primitives, const Bound& bound) {
  double steepest = 1;
  for (const PrimitiveIndex index : primitives_of(tree)) steepest = std::max(steepest, bound(primitives[index]));
  return steepest;
}

}  // namespace

double lipschitz_bound(const Primitive& primitive) {
  if (std::holds_alternative<Expression>(primitive.shape)) return std::numeric_limits<double>::infinity();
  // A distance has slope 1, and so has the maximum of distances of a polytope. The squared slope of sin(kx) sin(ky)
  // sin(kz) is k^2 (bc + ac + ab - 3 abc), where a, b and c are the squared sines. It is multilinear, so it is largest
  // where each square is 0 or 1, and there it is 0 or k^2. It is k^2 where one square is 0 and two are 1. Both slopes
  // add up where the distance grows in the same direction.
  return primitive.displacement ? 1.0 + std::abs(primitive.displacement->frequency) : 1.0;
}

double lipschitz_bound(const CsgTree& tree, const PrimitiveSet& primitives) {
  return steepest_of(tree, primitives, [](const Primitive& primitive) { return lipschitz_bound(primitive); });
}

double lipschitz_estimate(const Primitive& primitive) {
  constexpr double k_safety = 2.0;
  const auto* expression = std::get_if<Expression>(&primitive.shape);
  if (expression == nullptr) return lipschitz_bound(primitive);
  const double steepest = sampled_slope(primitive, *expression);
  // A field that is flat at all samples says nothing. Take it for a distance.
  return steepest > 0 ? k_safety * steepest : 1.0;
}

double lipschitz_estimate(const CsgTree& tree, const PrimitiveSet& primitives) {
  return steepest_of(tree, primitives, [](const Primitive& primitive) { return lipschitz_estimate(primitive); });
}

}  // namespace cloud2csg
