#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "cloud2csg/advanced/segmentation.hpp"
#include "core/base/parallel.hpp"
#include "core/geometry/subset.hpp"
#include "core/primitive/sampled_field.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_block = 1024;

/// Points of a block, by primitive, with their distances.
struct NearestInBlock {
  std::vector<std::uint32_t> owners;  ///< as many as there are primitives for none
  std::vector<double> distances;
};

/// The points of a block that may be within the tolerance: all where the field is no distance.
std::vector<std::uint32_t> candidates_of(const Primitive& primitive, PointsView points, double tolerance) {
  std::vector<std::uint32_t> candidates(points.size());
  std::iota(candidates.begin(), candidates.end(), 0U);
  if (!is_plain(primitive)) return candidates;
  std::vector<double> distances(points.size());
  evaluate_distance(primitive, points, distances);
  std::erase_if(candidates, [&](std::uint32_t i) { return std::abs(distances[i]) > tolerance; });
  return candidates;
}

/// Gives the primitive the points that lie on it and are farther from those before it.
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
