#include "cloud2csg/advanced/objective.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/fields/point_fit.hpp"
#include "core/geometry/spatial_order.hpp"
#include "core/geometry/subset.hpp"
#include "paper/objective/objective.hpp"

namespace cloud2csg {
namespace {

/// A subtree's value at a point, and the primitive that has it.
struct Selected {
  double value;
  PrimitiveIndex primitive;
  bool complemented;
};

/// Zero counts as positive, and so as negative when complemented.
bool has_negative_rank(const Selected& s) {
  return s.value < 0 || (s.value == 0 && s.complemented);
}

/// Whether a's signed rank is below b's: by value, then by the primitive's index, mirrored when negative.
bool ranks_below(const Selected& a, const Selected& b) {
  if (a.value != b.value) return a.value < b.value;
  if (has_negative_rank(a) != has_negative_rank(b)) return has_negative_rank(a);
  return has_negative_rank(a) ? a.primitive > b.primitive : a.primitive < b.primitive;
}

Selected negated(Selected s) {
  return {-s.value, s.primitive, !s.complemented};
}
Selected lower(const Selected& a, const Selected& b) {
  return ranks_below(b, a) ? b : a;
}
Selected upper(const Selected& a, const Selected& b) {
  return ranks_below(a, b) ? b : a;
}

/// The primitives' fields at a block of points, computed once, so that the walk below only reads.
struct BlockFields {
  std::vector<std::vector<double>> distances;  // by primitive, then by point; empty for primitives not in the tree
  std::vector<Points> gradients;
};

BlockFields evaluate_block(const CsgTree& tree, const PrimitiveSet& primitives, PointsView positions) {
  BlockFields fields{std::vector<std::vector<double>>(primitives.size()), std::vector<Points>(primitives.size())};
  for (const PrimitiveIndex p : primitives_of(tree)) {
    fields.distances[p] = signed_distance(primitives[p], positions);
    fields.gradients[p] = gradient(primitives[p], positions);
  }
  return fields;
}

Selected select(const CsgTree& tree, std::size_t node, const BlockFields& fields, std::size_t point) {
  const CsgNode& here = tree.nodes()[node];
  assert(here.operation() != Operation::empty && here.operation() != Operation::full);
  if (here.operation() == Operation::primitive) {
    return {fields.distances[here.primitive()][point], here.primitive(), false};
  }
  const Selected second = select(tree, tree.second_child(node), fields, point);
  if (here.operation() == Operation::complement) return negated(second);
  const Selected first = select(tree, tree.first_child(node), fields, point);
  switch (here.operation()) {
    case Operation::union_of:
      return lower(first, second);
    case Operation::intersection:
      return upper(first, second);
    default:
      return upper(first, negated(second));
  }
}

constexpr std::size_t k_block = 1024;

/// Whether a tree explains a point that has this distance and angle to it.
class Explanation {
 public:
  explicit Explanation(const SegmentationTolerances& tolerances)
      : largest_distance_(tolerances.distance), largest_angle_(std::acos(tolerances.cosine)) {}

  [[nodiscard]] bool holds(double distance, double angle) const {
    return std::abs(distance) <= largest_distance_ && angle <= largest_angle_;
  }

 private:
  double largest_distance_, largest_angle_;
};

}  // namespace

Objective resolve(const ObjectiveOptions& options, std::size_t points, double noise) {
  return {.alpha = options.alpha.value_or(std::log(static_cast<double>(std::max<std::size_t>(points, 1)))),
          .beta = options.beta.value_or(1.0 / noise),
          .gamma = options.gamma};
}

double point_score(double distance, double angle, const Objective& objective) {
  const double d = objective.beta * distance;
  const double theta = objective.gamma * angle;
  return std::exp(-d * d) + std::exp(-theta * theta);
}

double reference_objective(const CsgTree& tree, const PrimitiveSet& primitives, const PointCloud& cloud,
                           std::span<const std::uint32_t> points, const Objective& objective) {
  double sum = 0;
  for (std::size_t begin = 0; begin < points.size(); begin += k_block) {
    const std::span<const std::uint32_t> block = points.subspan(begin, std::min(k_block, points.size() - begin));
    const Points positions = select_points(cloud.positions, block);
    const BlockFields fields = evaluate_block(tree, primitives, positions);
    for (std::size_t i = 0; i < block.size(); ++i) {
      const Selected selected = select(tree, tree.root(), fields, i);
      const Eigen::Vector3d slope = fields.gradients[selected.primitive][i].normalized();
      const double cosine = (selected.complemented ? -slope : slope).dot(cloud.normals[block[i]]);
      sum += point_score(selected.value, std::acos(std::clamp(cosine, -1.0, 1.0)), objective);
    }
  }
  return sum - objective.alpha * static_cast<double>(tree.size());
}

std::vector<std::uint32_t> unexplained_points(const Model& model, const PointCloud& cloud,
                                              const SegmentationTolerances& tolerances, const RunContext& run) {
  const std::vector<std::uint32_t> order = spatial_order(cloud.positions, bounds_of(cloud.positions), run);
  const PointFit points = measure_points(model, cloud, tolerances.distance, {.order = order}, run);
  const Explanation explanation(tolerances);
  std::vector<std::uint32_t> unexplained;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (!explanation.holds(points.signed_distances[i], points.angles[i])) unexplained.push_back(i);
  }
  return unexplained;
}

FitStatistics measure_fit(const Model& model, const PointCloud& cloud, double noise, const ExtractOptions& options,
                          const RunContext& run, std::span<const std::uint32_t> order) {
  const Objective objective = resolve(options.objective, cloud.size(), noise);
  PointFit points = measure_points(model, cloud, noise, {.order = order}, run);
  FitStatistics fit;
  fit.objective = -objective.alpha * static_cast<double>(tree_of(model).size());
  fit.tolerances = segmentation_tolerances(options.segmentation, noise);
  const Explanation explanation(fit.tolerances);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!explanation.holds(points.signed_distances[i], points.angles[i])) ++fit.unexplained_points;
    if (std::abs(points.signed_distances[i]) > fit.tolerances.distance)
      fit.far_points.push_back(static_cast<std::uint32_t>(i));
    fit.objective += point_score(points.values[i], points.angles[i], objective);
  }
  fit.rms_distance = root_mean_square(points.signed_distances);
  fit.rms_angle_deg = root_mean_square(points.angles) * 180.0 / std::numbers::pi;
  for (double& distance : points.signed_distances) distance = std::abs(distance);
  fit.p95_distance = quantile_95(points.signed_distances);
  fit.p95_angle_deg = quantile_95(points.angles) * 180.0 / std::numbers::pi;
  return fit;
}

}  // namespace cloud2csg
