#include "cloud2csg/advanced/segmentation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/base/parallel.hpp"
#include "core/base/robust_deviation.hpp"
#include "core/geometry/subset.hpp"
#include "core/primitive/sampled_field.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_noise_sample = 4096;
constexpr std::size_t k_noise_block = 1024;
constexpr double k_noise_floor = 1e-5;  // share of the diagonal
constexpr double k_noise_ceiling = 0.1;
constexpr double k_outlier_sigmas = 5.0;
constexpr double k_sigmas = 3.0;
constexpr std::uint64_t k_sampling_stage = 0x6e6f'6973;  // names its random stream

double cosine_of_deg(double degrees) {
  return std::cos(degrees * std::numbers::pi / 180.0);
}

/// Whether a normal is along the slope or against it, within an angle of this cosine. False where the slope is zero.
bool agrees(const Eigen::Vector3d& slope, const Eigen::Vector3d& normal, double least_cosine) {
  const double length = slope.norm();
  return length > 0 && std::abs(slope.dot(normal)) / length >= least_cosine;
}

/// Lowers `nearest` to the distances from the primitives whose slope agrees with the normal.
void find_nearest(PointsView positions, PointsView normals, const PrimitiveSet& primitives, double least_cosine,
                  std::span<double> nearest) {
  const double least_square = least_cosine * least_cosine;
  for (const Primitive& primitive : primitives) {
    const SampledField field = sample_field(primitive, positions);
    // agrees(), without roots and branches
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      const double gx = field.slopes.x[i];
      const double gy = field.slopes.y[i];
      const double gz = field.slopes.z[i];
      const double dot = gx * normals.x[i] + gy * normals.y[i] + gz * normals.z[i];
      const double square = gx * gx + gy * gy + gz * gz;
      const bool is_along = (dot * dot >= least_square * square) & (square > 0);
      const double distance = std::abs(field.distances[i]);
      nearest[i] = (is_along & (distance < nearest[i])) ? distance : nearest[i];
    }
  }
}

constexpr std::size_t k_block = 1024;

/// The nearest primitive of each point of a block, and its distance.
struct NearestInBlock {
  std::vector<std::uint32_t> owners;  ///< the number of primitives stands for none
  std::vector<double> distances;
};

/// The points of a block that may be within the tolerance; all where the field is no distance.
std::vector<std::uint32_t> candidates_of(const Primitive& primitive, PointsView points, double tolerance) {
  std::vector<std::uint32_t> candidates(points.size());
  std::iota(candidates.begin(), candidates.end(), 0U);
  if (!is_plain(primitive)) return candidates;
  std::vector<double> distances(points.size());
  evaluate_distance(primitive, points, distances);
  std::erase_if(candidates, [&](std::uint32_t i) { return std::abs(distances[i]) > tolerance; });
  return candidates;
}

/// Gives the primitive the points on it that are farther from all primitives before it.
void claim(std::uint32_t index, const Primitive& primitive, PointsView positions, PointsView normals,
           const SegmentationTolerances& tolerances, NearestInBlock& nearest) {
  const std::vector<std::uint32_t> candidates = candidates_of(primitive, positions, tolerances.distance);
  const SampledField field = sample_field(primitive, select_points(positions, candidates));
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const std::uint32_t i = candidates[k];
    const double slope = field.slopes[k].norm();
    if (!(slope > 0)) continue;
    const double distance = std::abs(field.distances[k]) / slope;
    const double cosine = std::abs(field.slopes[k].dot(normals[i])) / slope;
    if (distance > tolerances.distance || cosine < tolerances.cosine || distance >= nearest.distances[i]) continue;
    nearest.distances[i] = distance;
    nearest.owners[i] = index;
  }
}

}  // namespace

double estimate_noise(const PointCloud& cloud, const PrimitiveSet& primitives, double angle_tolerance_deg,
                      const RunContext& run) {
  assert(cloud.has_normals());
  const PointCloud sample =
      select_points(cloud, one_of_every_few(cloud.size(), k_noise_sample, RandomStream(0, k_sampling_stage)));
  std::vector<double> nearest(sample.positions.size(), std::numeric_limits<double>::infinity());
  for_each_index((nearest.size() + k_noise_block - 1) / k_noise_block, run, [&](std::size_t block) {
    const std::size_t begin = block * k_noise_block;
    const std::size_t count = std::min(k_noise_block, nearest.size() - begin);
    find_nearest(sample.positions.view().subview(begin, count), sample.normals.view().subview(begin, count), primitives,
                 cosine_of_deg(angle_tolerance_deg), std::span(nearest).subspan(begin, count));
  });
  std::erase_if(nearest, [](double distance) { return !std::isfinite(distance); });
  const AlignedBox box = bounds_of(sample.positions);
  const double diagonal = box.isEmpty() ? 0.0 : box.diagonal().norm();
  // Points in one place have no scale, but others divide by it, so it must not be zero.
  const double scale = diagonal > 0 ? diagonal : 1.0;
  if (nearest.empty()) return k_noise_floor * scale;
  const double with_outliers = robust_deviation(nearest);
  std::erase_if(nearest, [&](double distance) { return distance > k_outlier_sigmas * with_outliers; });
  return std::clamp(robust_deviation(nearest), k_noise_floor * scale, k_noise_ceiling * scale);
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
    const SampledField field = sample_field(primitive, cloud.positions);
    std::vector<std::uint32_t>& points = result.points_of.emplace_back();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const bool is_near = std::abs(field.distances[i]) <= tolerances.distance;
      if (!is_near || !agrees(field.slopes[i], cloud.normals[i], tolerances.cosine)) continue;
      points.push_back(static_cast<std::uint32_t>(i));
      assigned[i] = true;
    }
    run.report("segment", result.points_of.size(), primitives.size(), "primitives");
  }
  result.unassigned = static_cast<std::size_t>(std::ranges::count(assigned, false));
  return result;
}

std::vector<SurfacePoints> deal_points(const PointCloud& cloud, const PrimitiveSet& primitives,
                                       const SegmentationTolerances& tolerances, const RunContext& run) {
  assert(cloud.has_normals());
  const auto none = static_cast<std::uint32_t>(primitives.size());
  std::vector<NearestInBlock> blocks((cloud.size() + k_block - 1) / k_block);
  for_each_index(blocks.size(), run, [&](std::size_t b) {
    const std::size_t begin = b * k_block;
    const std::size_t count = std::min(k_block, cloud.size() - begin);
    NearestInBlock& nearest = blocks[b];
    nearest.owners.assign(count, none);
    nearest.distances.assign(count, std::numeric_limits<double>::infinity());
    for (std::uint32_t p = 0; p < none; ++p) {
      claim(p, primitives[p], cloud.positions.view().subview(begin, count), cloud.normals.view().subview(begin, count),
            tolerances, nearest);
    }
  });
  std::vector<SurfacePoints> dealt(primitives.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const NearestInBlock& block = blocks[i / k_block];
    const std::uint32_t owner = block.owners[i % k_block];
    if (owner == none) continue;
    const double distance = block.distances[i % k_block];
    dealt[owner].points.push_back(static_cast<std::uint32_t>(i));
    dealt[owner].rms += distance * distance;
  }
  for (SurfacePoints& own : dealt) {
    if (!own.points.empty()) own.rms = std::sqrt(own.rms / static_cast<double>(own.points.size()));
  }
  return dealt;
}

}  // namespace cloud2csg
