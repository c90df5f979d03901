#include <variant>

#include "cloud2csg/primitive.hpp"
#include "core/primitive/expression.hpp"
#include "core/primitive/formulas-inl.hpp"

// The plain reference: the formulas for one double at a time, without vector instructions of our own.
namespace cloud2csg {
namespace {

namespace plain = HWY_NAMESPACE;
using plain::PlainTag;
using PlainDisplacement = plain::DisplacementFormula<PlainTag>;

plain::Vector<double> point_at(PointsView points, std::size_t i) {
  return {points.x[i], points.y[i], points.z[i]};
}

struct DistanceLoop {
  PointsView points;
  std::span<double> distance;

  template <class Formula>
  void run(PlainTag /*tag*/, const Formula& formula) const {
    for (std::size_t i = 0; i < points.size(); ++i) distance[i] = formula.at(point_at(points, i)).distance;
  }
};

struct GradientLoop {
  PointsView points;
  Points& slopes;

  template <class Formula>
  void run(PlainTag /*tag*/, const Formula& formula) const {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const plain::Vector<double> slope = formula.at(point_at(points, i)).gradient;
      slopes.x[i] = slope.x, slopes.y[i] = slope.y, slopes.z[i] = slope.z;
    }
  }
};

}  // namespace

std::vector<double> signed_distance(const Primitive& primitive, PointsView points) {
  std::vector<double> distance(points.size());
  const Placement placement = placement_of(primitive.pose);
  if (std::holds_alternative<Expression>(primitive.shape)) {
    evaluate_expression(primitive, points,
                        {.distance = distance, .gradient_x = {}, .gradient_y = {}, .gradient_z = {}});
  } else {
    plain::run_formula(PlainTag(), primitive, placement, DistanceLoop{points, distance});
  }
  if (primitive.displacement) {
    const PlainDisplacement displacement(PlainTag(), primitive.displacement->frequency, placement);
    for (std::size_t i = 0; i < points.size(); ++i) {
      distance[i] = displacement.added_to({distance[i], {0, 0, 0}}, point_at(points, i)).distance;
    }
  }
  return distance;
}

Points gradient(const Primitive& primitive, PointsView points) {
  Points slopes(points.size());
  const Placement placement = placement_of(primitive.pose);
  if (std::holds_alternative<Expression>(primitive.shape)) {
    evaluate_expression(primitive, points,
                        {.distance = {}, .gradient_x = slopes.x, .gradient_y = slopes.y, .gradient_z = slopes.z});
  } else {
    plain::run_formula(PlainTag(), primitive, placement, GradientLoop{points, slopes});
  }
  if (primitive.displacement) {
    const PlainDisplacement displacement(PlainTag(), primitive.displacement->frequency, placement);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const plain::Vector<double> base{slopes.x[i], slopes.y[i], slopes.z[i]};
      const plain::Vector<double> slope = displacement.added_to({0, base}, point_at(points, i)).gradient;
      slopes.x[i] = slope.x, slopes.y[i] = slope.y, slopes.z[i] = slope.z;
    }
  }
  return slopes;
}

}  // namespace cloud2csg
