#include "raw/solids/unseen_side.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "cloud2csg/advanced/prepare.hpp"
#include "cloud2csg/advanced/winding_number.hpp"
#include "cloud2csg/sample.hpp"
#include "solids/known_surfaces.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// A block, turned, with a bore from above: its ground is in the plane of `down`.
class BoredBlock : public ::testing::Test {
 protected:
  BoredBlock() {
    for (Primitive& solid : solids_) solid.pose = compose(turn_, solid.pose);
    for (const Primitive& solid : solids_) {
      for (const Surface& surface : test::surfaces_of(solid)) surfaces_.push_back({.surface = surface, .points = {}});
    }
  }

  /// Its points, without those of some sides.
  template <class IsMissing>
  [[nodiscard]] PointCloud cloud_without(IsMissing is_missing) const {
    const CsgTree tree = subtract(CsgTree::leaf(0), CsgTree::leaf(1));
    const PointCloud whole =
        sample_surface({.primitives = solids_, .tree = tree}, {.count = 20'000, .noise = 0.002, .seed = 3});
    std::vector<std::uint32_t> kept;
    for (std::uint32_t i = 0; i < whole.size(); ++i) {
      const Vector3d normal = turn_.orientation.conjugate() * whole.normals[i];
      if (!is_missing(turn_.to_local(whole.positions[i]), normal)) kept.push_back(i);
    }
    return select_points(whole, kept);
  }
  [[nodiscard]] PointCloud cloud_without_ground() const {
    return cloud_without([](const Vector3d&, const Vector3d& normal) { return normal.z() < -0.9; });
  }
  [[nodiscard]] std::optional<UnseenSide> find(const PointCloud& cloud) const {
    return find_unseen_side(cloud, point_areas(cloud), surfaces_, estimate_scale(cloud));
  }
  [[nodiscard]] Vector3d down() const { return turn_.orientation * Vector3d(0, 0, -1); }

  Pose turn_{.position = {5, -3, 2}, .orientation = Eigen::Quaterniond(0.8, 0.4, -0.2, 0.3).normalized()};
  PrimitiveSet solids_{test::placed("block", Box{{4, 3, 1}}, {0, 0, 0}),
                       test::placed("bore", Cylinder{0.8, 1}, {0.5, 0, 0.3})};
  std::vector<DetectedSurface> surfaces_;
};

TEST_F(BoredBlock, StandsOnThePlaneOnWhichItsWallsEnd) {
  const Pose tilted = compose(turn_, {.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.05, Vector3d::UnitX()))});
  const DetectedSurface skew{.surface = {.axis = tilted.orientation * Vector3d::UnitZ()}, .points = {}};
  const std::vector<DetectedSurface> others = surfaces_;
  for (const std::size_t place : {std::size_t{0}, others.size()}) {
    surfaces_ = others;
    surfaces_.insert(surfaces_.begin() + static_cast<std::ptrdiff_t>(place), skew);
    const auto side = find(cloud_without_ground());
    ASSERT_TRUE(side);
    EXPECT_GT(side->normal.dot(down()), 0.9999) << place;
  }
}

TEST_F(BoredBlock, GetsItsGround) {
  const PointCloud cloud = cloud_without_ground();
  const auto side = find(cloud);
  ASSERT_TRUE(side);
  EXPECT_GT(side->normal.dot(down()), 0.9999);
  const double whole_surface = 2 * (12 + 4 + 3) + 2 * std::numbers::pi * 0.8 * 0.7;
  EXPECT_NEAR(side->share, 12 / whole_surface, 0.02);
  // As dense as the rest, under the bore, too, and where the ground is.
  EXPECT_NEAR(static_cast<double>(side->points.size()), 20'000 * 12 / whole_surface,
              0.06 * 20'000 * 12 / whole_surface);
  for (std::size_t i = 0; i < side->points.size(); ++i) {
    const Vector3d place = turn_.to_local(side->points.positions[i]);
    EXPECT_NEAR(place.z(), -0.5, 0.02);
    EXPECT_LT(std::abs(place.x()), 2.1);
    EXPECT_LT(std::abs(place.y()), 1.6);
    EXPECT_EQ(side->points.normals[i], side->normal);
  }
  EXPECT_TRUE(side->points.sensor_positions.empty());
}

TEST_F(BoredBlock, GetsItsGroundAlsoWithoutSurfacesToSayWhereUpIs) {
  surfaces_.clear();
  const auto side = find(cloud_without_ground());
  ASSERT_TRUE(side);
  EXPECT_GT(side->normal.dot(down()), 0.999);
}

TEST_F(BoredBlock, NeedsNothingWhereItIsClosed) {
  EXPECT_FALSE(find(cloud_without([](const Vector3d&, const Vector3d&) { return false; })));
}

TEST_F(BoredBlock, IsNotClosedWhereHolesAreOnAllSides) {
  EXPECT_FALSE(find(cloud_without([](const Vector3d& place, const Vector3d&) {
    return std::sin(5 * place.x()) * std::sin(5 * place.y()) * std::sin(5 * place.z()) > 0.2;
  })));
}

TEST_F(BoredBlock, IsNotClosedWhereASensorLooked) {
  PointCloud cloud = cloud_without_ground();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.sensor_positions.push_back(turn_.to_world({0, 0, i % 100 == 0 ? -9.0 : 9.0}));
  }
  EXPECT_FALSE(find(cloud));
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.sensor_positions.set(i, turn_.to_world({0, 0, 9}));
  const auto side = find(cloud);
  ASSERT_TRUE(side);
  for (std::size_t i = 0; i < side->points.size(); ++i) {
    const Vector3d way = side->points.sensor_positions[i] - side->points.positions[i];
    EXPECT_GT(way.normalized().dot(side->normal), 0.9999);
  }
}

TEST_F(BoredBlock, OfWhichOnlyTheTopIsLeftIsASheet) {
  EXPECT_FALSE(find(cloud_without(
      [](const Vector3d& place, const Vector3d& normal) { return normal.z() < 0.9 || place.z() < 0.3; })));
}

}  // namespace
}  // namespace cloud2csg
