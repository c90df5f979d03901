#include "cloud2csg/segmentation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace cloud2csg {
namespace {

constexpr std::size_t k_noise_sample = 4096;
constexpr double k_noise_floor = 1e-5;  // of the diagonal
constexpr double k_sigmas = 3.0;

double cosine_of_deg(double degrees) {
  return std::cos(degrees * std::numbers::pi / 180.0);
}

/// |cosine| of the angle between each point's normal and the primitive's gradient there.
std::vector<double> normal_agreement(const Primitive& primitive, PointsView positions, PointsView normals) {
  const Points gradients = gradient(primitive, positions);
  std::vector<double> agreement(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    agreement[i] = std::abs(gradients[i].dot(normals[i])) / gradients[i].norm();
  }
  return agreement;
}

struct Sample {
  Points positions, normals;
};

Sample every_nth(const PointCloud& cloud, std::size_t most) {
  Sample sample;
  const std::size_t stride = (cloud.size() + most - 1) / most;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    sample.positions.push_back(cloud.positions[i]);
    sample.normals.push_back(cloud.normals[i]);
  }
  return sample;
}

}  // namespace

double estimate_noise(const PointCloud& cloud, const PrimitiveSet& primitives, double angle_tolerance_deg) {
  assert(cloud.has_normals());
  const Sample sample = every_nth(cloud, k_noise_sample);
  const double least_cosine = cosine_of_deg(angle_tolerance_deg);
  std::vector<double> nearest(sample.positions.size(), std::numeric_limits<double>::infinity());
  for (const Primitive& primitive : primitives) {
    const std::vector<double> distances = signed_distance(primitive, sample.positions);
    const std::vector<double> agreement = normal_agreement(primitive, sample.positions, sample.normals);
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      if (agreement[i] >= least_cosine) nearest[i] = std::min(nearest[i], std::abs(distances[i]));
    }
  }
  std::erase_if(nearest, [](double distance) { return !std::isfinite(distance); });
  const AlignedBox box = bounds_of(sample.positions);
  const double floor = box.isEmpty() ? 0.0 : k_noise_floor * box.diagonal().norm();
  if (nearest.empty()) return floor;
  const auto middle = nearest.begin() + static_cast<std::ptrdiff_t>(nearest.size() / 2);
  std::nth_element(nearest.begin(), middle, nearest.end());
  return std::max(1.4826 * *middle, floor);
}

SegmentationTolerances segmentation_tolerances(const SegmentationOptions& options, double noise) {
  return {.distance = options.distance_tolerance.value_or(k_sigmas * noise),
          .cosine = cosine_of_deg(options.angle_tolerance_deg)};
}

Segmentation segment_points(const PointCloud& cloud, const PrimitiveSet& primitives,
                            const SegmentationTolerances& tolerances, const RunContext& run) {
  assert(cloud.has_normals());
  Segmentation result;
  std::vector<bool> assigned(cloud.size(), false);
  for (const Primitive& primitive : primitives) {
    run.throw_if_stopped();
    const std::vector<double> distances = signed_distance(primitive, cloud.positions);
    const std::vector<double> agreement = normal_agreement(primitive, cloud.positions, cloud.normals);
    std::vector<std::uint32_t>& points = result.points_of.emplace_back();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      if (std::abs(distances[i]) > tolerances.distance || agreement[i] < tolerances.cosine) continue;
      points.push_back(static_cast<std::uint32_t>(i));
      assigned[i] = true;
    }
    run.report("segment", result.points_of.size(), primitives.size());
  }
  result.unassigned = static_cast<std::size_t>(std::ranges::count(assigned, false));
  return result;
}

}  // namespace cloud2csg
