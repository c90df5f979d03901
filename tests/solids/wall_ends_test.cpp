#include "raw/solids/wall_ends.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "cloud2csg/sample.hpp"
#include "core/geometry/subset.hpp"
#include "solids/known_surfaces.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// A scan from above without outliers, with the true surfaces and their normals.
struct SeenFromAbove {
  explicit SeenFromAbove(const Model& model) {
    const PointCloud scan = scan_model(model, {.on_table = true, .count = 40'000});
    const std::vector<double> distances = implicit_value(*model.tree, model.primitives, scan.positions);
    std::vector<std::uint32_t> near;
    for (std::uint32_t i = 0; i < scan.size(); ++i) {
      if (std::abs(distances[i]) < 0.02) near.push_back(i);
    }
    cloud = select_points(scan, near);
    cloud.normals = {};
    for (const Primitive& solid : model.primitives) {
      for (const Surface& surface : test::surfaces_of(solid)) surfaces.push_back({.surface = surface, .points = {}});
    }
    for (std::uint32_t i = 0; i < cloud.size(); ++i) {
      const auto distance = [&](const DetectedSurface& s) {
        return std::abs(signed_distance(s.surface, cloud.positions[i]));
      };
      DetectedSurface& nearest = *std::ranges::min_element(surfaces, {}, distance);
      nearest.points.push_back(i);
      const Vector3d across = normal(nearest.surface, cloud.positions[i]);
      const bool is_outward = across.dot(cloud.sensor_positions[i] - cloud.positions[i]) > 0;
      cloud.normals.push_back(is_outward ? across : Vector3d(-across));
    }
  }

  [[nodiscard]] std::vector<bool> behind(double foot) const {
    std::vector<bool> result(bins().count(), false);
    std::vector<std::uint32_t> all(bins().count());
    std::iota(all.begin(), all.end(), 0U);
    for (const std::uint32_t bin : bins_behind(wall_ends(cloud, surfaces, bins(), foot), bins(), foot, all)) {
      result[bin] = true;
    }
    return result;
  }
  [[nodiscard]] FloorBins bins() const { return {cloud, Vector3d::Zero(), Vector3d::UnitZ(), 0.03}; }

  PointCloud cloud;
  std::vector<DetectedSurface> surfaces;
};

Model plate_on_a_foot() {
  return {.primitives = {test::placed("plate", Box{{3, 2, 0.3}}, {0, 0, 1}),
                         test::placed("foot", Box{{1, 1, 1}}, {-0.7, 0, 0.35})},
          .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))};
}

TEST(WallEnds, AreWhereAPlateEndsAboveItsFoot) {
  const SeenFromAbove scan(plate_on_a_foot());
  std::vector<double> heights;
  for (const WallEnd& end : wall_ends(scan.cloud, scan.surfaces, scan.bins(), 0)) {
    if (end.place.z() > 0) heights.push_back(end.place.z());
  }
  const std::optional<double> height = common_end(heights, 0.03);
  ASSERT_TRUE(height);
  EXPECT_NEAR(*height, 0.85, 0.02);
  const std::vector<bool> behind = scan.behind(0);
  EXPECT_TRUE(behind[scan.bins().number_of({1.2, 0.7, 0})]);
  EXPECT_TRUE(behind[scan.bins().number_of({0.5, -0.9, 0})]);
}

/// Nobody sees how deep the bore is, but the block's own walls end at the table.
TEST(WallEnds, AreNotWhereNobodyCouldSeeTheWallGoOn) {
  const SeenFromAbove scan({.primitives = {test::placed("block", Box{{2, 2, 2}}, {0, 0, 0}),
                                           test::placed("bore", Cylinder{.radius = 0.3, .height = 3}, {0, 0, 0})},
                            .tree = subtract(CsgTree::leaf(0), CsgTree::leaf(1))});
  const std::vector<WallEnd> ends = wall_ends(scan.cloud, scan.surfaces, scan.bins(), -0.85);
  EXPECT_GT(ends.size(), 200U);
  EXPECT_LT(std::ranges::count_if(ends, [](const WallEnd& end) { return end.place.z() > -0.85; }), 5) << "strays";
}

/// The side that nobody sees of a lying rod is no end of its own.
TEST(WallEnds, AreNotWhereASurfaceTurnsBelow) {
  Primitive rod = test::placed("rod", Cylinder{.radius = 0.8, .height = 3}, {0, 0, 0});
  rod.pose.orientation = Eigen::AngleAxisd(std::acos(0.0), Vector3d::UnitY());
  const SeenFromAbove scan({.primitives = {rod}, .tree = CsgTree::leaf(0)});
  for (const WallEnd& end : wall_ends(scan.cloud, scan.surfaces, scan.bins(), -0.8)) {
    EXPECT_GT(std::abs(end.outward.x()), 0.9) << "only its ends stand upright";
  }
}

TEST(CommonEnd, IsThatOfMostHeights) {
  std::vector<double> heights(30, 2.0);
  for (std::size_t k = 0; k < heights.size(); ++k) heights[k] += 0.001 * static_cast<double>(k);
  for (int k = 0; k < 20; ++k) heights.push_back(4 + 0.5 * k);
  EXPECT_NEAR(common_end(heights, 0.1).value(), 2.0, 0.03);
  for (int k = 20; k < 40; ++k) heights.push_back(4 + 0.5 * k);
  EXPECT_FALSE(common_end(heights, 0.1)) << "fewer than half";
  EXPECT_FALSE(common_end(std::vector<double>(11, 2.0), 0.1)) << "too few";
}

}  // namespace
}  // namespace cloud2csg
