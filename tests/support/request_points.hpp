#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "core/fields/point_blocks.hpp"
#include "core/geometry/spatial_order.hpp"
#include "support/scene.hpp"

/// The tables of build_rank_classes() held against plain definitions: which points a request takes, and what trees
/// score on them.
namespace cloud2csg::test {

/// The points in the order in which strides are counted.
inline std::vector<std::uint32_t> order_of_points(const Scene& scene) {
  return spatial_order(scene.cloud.positions, bounds_of(scene.cloud.positions));
}

/// The plain segmentation and membership of a scene's points, to choose those of many requests.
class PlainPoints {
 public:
  explicit PlainPoints(const Scene& scene)
      : order_(order_of_points(scene)),
        positions_(scene.cloud.positions),
        segmentation_(segment_points(scene.cloud, scene.primitives, scene_tolerances())) {
    for (const Primitive& primitive : scene.primitives) {
      distances_.push_back(signed_distance(primitive, scene.cloud.positions));
    }
  }

  [[nodiscard]] const Segmentation& segmentation() const { return segmentation_; }

  /// The indices of the points that a request's table is judged by, ascending.
  [[nodiscard]] std::vector<std::uint32_t> of(const RankClassesRequest& request) const {
    std::vector<bool> is_taken(order_.size(), request.all_points);
    const std::vector<PrimitiveIndex>& owners = request.owners.empty() ? request.primitives : request.owners;
    for (const PrimitiveIndex p : owners) {
      for (const std::uint32_t point : segmentation_.points_of[p]) is_taken[point] = true;
    }
    std::vector<std::uint32_t> points;
    for (std::size_t k = 0; k < order_.size(); k += request.stride) {
      const std::uint32_t point = order_[k];
      if (is_taken[point] && is_in_region(request, point) &&
          !(request.without_strangers && is_in_stranger(request, point))) {
        points.push_back(point);
      }
    }
    std::ranges::sort(points);
    return points;
  }

 private:
  [[nodiscard]] bool is_in_region(const RankClassesRequest& request, std::uint32_t point) const {
    if (!request.region) return true;
    const Eigen::Array3d position = positions_[point].array();
    return (position >= request.region->min().array()).all() && (position < request.region->max().array()).all();
  }

  [[nodiscard]] bool is_in_stranger(const RankClassesRequest& request, std::uint32_t point) const {
    for (PrimitiveIndex p = 0; p < distances_.size(); ++p) {
      if (distances_[p][point] < 0 && !std::ranges::binary_search(request.primitives, p)) return true;
    }
    return false;
  }

  std::vector<std::uint32_t> order_;
  Points positions_;
  Segmentation segmentation_;
  std::vector<std::vector<double>> distances_;  // by primitive
};

/// Holds random trees on one table against the walk over each point. Scores are relative to their sum, not to E(t),
/// which may cancel; a point is never asked for more than the 2^-22 that contributions are rounded to.
inline void expect_scores_of(const RankClasses& table, const std::vector<std::uint32_t>& points, const Scene& scene,
                             std::size_t trees, RandomStream& random) {
  ASSERT_EQ(table.point_count(), points.size());
  Objective geometry_only = table.objective();
  geometry_only.alpha = 0;
  RankScratch scratch;
  for (const CsgTree& local : random_formulas(table.primitive_count(), trees, random)) {
    const CsgTree tree = renumber(local, table.primitives());
    const double reference = reference_objective(tree, scene.primitives, scene.cloud, points, geometry_only);
    const double rounding = std::ldexp(static_cast<double>(points.size()), -22);
    ASSERT_NEAR(table.geometry(local, scratch), reference, 1e-6 * reference + rounding)
        << to_text(tree, scene.primitives);
  }
}

}  // namespace cloud2csg::test
