#include "paper/objective/fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/fields/point_fit.hpp"
#include "core/geometry/spatial_order.hpp"

namespace cloud2csg {
namespace {

/// Whether a tree explains a point, which has a distance and an angle to it.
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
  for (double& distance : points.signed_distances) distance = std::abs(distance);
  const Explanation explanation(segmentation_tolerances(options.segmentation, noise));
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!explanation.holds(points.signed_distances[i], points.angles[i])) ++fit.unexplained_points;
    fit.objective += point_score(points.signed_distances[i], points.angles[i], objective);
  }
  fit.rms_distance = root_mean_square(points.signed_distances);
  fit.rms_angle_deg = root_mean_square(points.angles) * 180.0 / std::numbers::pi;
  fit.p95_distance = quantile_95(points.signed_distances);
  fit.p95_angle_deg = quantile_95(points.angles) * 180.0 / std::numbers::pi;
  return fit;
}

}  // namespace cloud2csg
