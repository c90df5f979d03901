#include "pipeline/fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_chunk = 16'384;

struct PointFit {
  std::vector<double> distances;  // unsigned
  std::vector<double> angles;     // radians
};

PointFit measure_points(const CsgTree& tree, const PrimitiveSet& primitives, const PointCloud& cloud,
                        const RunContext& run) {
  PointFit fit{std::vector<double>(cloud.size()), std::vector<double>(cloud.size())};
  const auto measure = [&](std::size_t chunk) {
    const std::size_t begin = chunk * k_chunk;
    const std::size_t count = std::min(k_chunk, cloud.size() - begin);
    const PointsView positions = cloud.positions.view().subview(begin, count);
    const std::vector<double> values = implicit_value(tree, primitives, positions);
    const Points gradients = implicit_gradient(tree, primitives, positions);
    for (std::size_t i = 0; i < count; ++i) {
      const double length = gradients[i].norm();
      const double cosine = length > 0 ? gradients[i].dot(cloud.normals[begin + i]) / length : 0.0;
      fit.distances[begin + i] = std::abs(values[i]);
      fit.angles[begin + i] = std::acos(std::clamp(cosine, -1.0, 1.0));
    }
  };
  for_each_index((cloud.size() + k_chunk - 1) / k_chunk, run, measure);
  return fit;
}

double root_mean_square(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// What 95 % are below. Reorders them.
double quantile_95(std::vector<double>& values) {
  const auto at_95 = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 95 / 100);
  std::nth_element(values.begin(), at_95, values.end());
  return *at_95;
}

}  // namespace

FitStatistics measure_fit(const CsgTree& tree, const PrimitiveSet& primitives, const PointCloud& cloud,
                          const Objective& objective, const RunContext& run) {
  PointFit points = measure_points(tree, primitives, cloud, run);
  FitStatistics fit;
  fit.objective = -objective.alpha * static_cast<double>(tree.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    fit.objective += point_score(points.distances[i], points.angles[i], objective);
  }
  fit.rms_distance = root_mean_square(points.distances);
  fit.rms_angle_deg = root_mean_square(points.angles) * 180.0 / std::numbers::pi;
  fit.p95_distance = quantile_95(points.distances);
  fit.p95_angle_deg = quantile_95(points.angles) * 180.0 / std::numbers::pi;
  return fit;
}

}  // namespace cloud2csg
