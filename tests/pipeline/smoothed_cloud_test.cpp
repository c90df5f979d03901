#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "cloud2csg/reconstruct.hpp"
#include "cloud2csg/sample.hpp"
#include "pipeline/reconstructed.hpp"
#include "support/known_solids.hpp"
#include "support/smoothed.hpp"
#include "support/warnings.hpp"

namespace cloud2csg {
namespace {

constexpr std::size_t k_points = 20'000;

/// A block on a plate.
Model steps() {
  return {.primitives = {test::placed("plate", Box{{4, 3, 0.6}}, {0, 0, 0}),
                         test::placed("block", Box{{2, 2, 1}}, {0.3, 0.2, 0.8})},
          .tree = unite_all(std::vector{CsgTree::leaf(0), CsgTree::leaf(1)})};
}

/// As if joined from the views of a scanner, over somewhat more than a spacing. The area is 40.
PointCloud smoothed_cloud(const Model& model) {
  const PointCloud cloud = sample_surface(model, {.count = k_points, .noise = 0.01, .seed = 5});
  return test::smoothed(cloud, 1.2 * std::sqrt(40.0 / k_points));
}

TEST(SmoothedCloud, GetsSharpEdges) {
  const Model truth{.primitives = {test::placed("block", Box{{4, 3, 1.2}}, {0, 0, 0})}, .tree = CsgTree::leaf(0)};
  const Extraction result = reconstruct(smoothed_cloud(truth));
  EXPECT_GT(test::iou(result, truth), 0.98);
  EXPECT_EQ(leaf_count(result.tree()), 1U);
  EXPECT_TRUE(test::mentions(result.statistics.warnings, "the cloud was smoothed"));
  EXPECT_GT(result.statistics.finding->smoothed_points, 100U);
  EXPECT_LE(result.statistics.finding->smoothed_points + result.cloud.size(), k_points);
}

TEST(SmoothedCloud, KeepsAllPointsWhenAskedTo) {
  ReconstructOptions options;
  options.preparation.clean.remove_outliers = false;
  const Extraction result = reconstruct(smoothed_cloud(steps()), options);
  EXPECT_FALSE(test::mentions(result.statistics.warnings, "the cloud was smoothed"));
  EXPECT_EQ(result.statistics.finding->smoothed_points, 0U);
  EXPECT_EQ(result.cloud.size(), k_points);
}

TEST(SmoothedCloud, GetsSharpEdgesBesideAKnownPrimitive) {
  const Model truth = steps();
  const Extraction result = reconstruct(smoothed_cloud(truth), {.known = {truth.primitives[0]}});
  EXPECT_GT(test::iou(result, truth), 0.98);
  EXPECT_GT(result.statistics.finding->smoothed_points, 0U);
}

}  // namespace
}  // namespace cloud2csg
