#include "pipeline/fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fitness/spatial_order.hpp"
#include "pipeline/point_fit.hpp"

namespace cloud2csg {
std::vector<std::uint32_t> unexplained_points(const CsgTree& tree, const PrimitiveSet& primitives,
                                              const PointCloud& cloud, const SegmentationTolerances& tolerances,
                                              const RunContext& run) {
  const std::vector<std::uint32_t> order = spatial_order(cloud.positions, bounds_of(cloud.positions), run);
  const PointFit points = measure_points(tree, primitives, cloud, tolerances.distance, {.order = order}, run);
  const double largest_angle = std::acos(tolerances.cosine);
  std::vector<std::uint32_t> unexplained;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (!(std::abs(points.signed_distances[i]) <= tolerances.distance) || !(points.angles[i] <= largest_angle))
      unexplained.push_back(i);
  }
  return unexplained;
}

FitStatistics measure_fit(const CsgTree& tree, const PrimitiveSet& primitives, const PointCloud& cloud,
                          const Objective& objective, double noise, const RunContext& run,
                          std::span<const std::uint32_t> order) {
  PointFit points = measure_points(tree, primitives, cloud, noise, {.order = order}, run);
  FitStatistics fit;
  fit.objective = -objective.alpha * static_cast<double>(tree.size());
  for (double& distance : points.signed_distances) distance = std::abs(distance);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    fit.objective += point_score(points.signed_distances[i], points.angles[i], objective);
  }
  fit.rms_distance = root_mean_square(points.signed_distances);
  fit.rms_angle_deg = root_mean_square(points.angles) * 180.0 / std::numbers::pi;
  fit.p95_distance = quantile_95(points.signed_distances);
  fit.p95_angle_deg = quantile_95(points.angles) * 180.0 / std::numbers::pi;
  return fit;
}

}  // namespace cloud2csg
