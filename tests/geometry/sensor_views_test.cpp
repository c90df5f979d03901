#include "core/geometry/sensor_views.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "core/base/random.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// A table at z = 0 under a block of 2 x 2 x 1 that stands 1 above it, from a sensor high above.
class BlockOverTable : public ::testing::Test {
 protected:
  BlockOverTable() {
    RandomStream random(1);
    while (cloud_.size() < 40'000) {
      // Rays that are even in angle, nearly.
      const Vector3d way = Vector3d(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), -1).normalized();
      const Vector3d on_block = sensor_ + way * (sensor_.z() - 2) / -way.z();
      const bool hits_block = on_block.head<2>().cwiseAbs().maxCoeff() < 1;
      cloud_.positions.push_back(hits_block ? on_block : Vector3d(sensor_ + way * sensor_.z() / -way.z()));
      cloud_.normals.push_back(Vector3d::UnitZ());
      cloud_.sensor_positions.push_back(sensor_);
    }
  }

  [[nodiscard]] double density_at(const Vector3d& place, const Vector3d& normal = Vector3d::UnitZ()) const {
    return SensorViews(cloud_).density_at(place, normal);
  }

  /// Points a unit of area around a place of a horizontal surface.
  [[nodiscard]] double counted_at(const Vector3d& place) const {
    constexpr double k_edge = 0.5;
    double count = 0;
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      const Vector3d apart = (cloud_.positions[i] - place).cwiseAbs();
      if (apart.z() < 0.1 && apart.head<2>().maxCoeff() < k_edge / 2) ++count;
    }
    return count / (k_edge * k_edge);
  }

  const Vector3d sensor_{0, 0, 10};
  PointCloud cloud_;
};

TEST_F(BlockOverTable, IsSeenAsDenselyAsThereArePoints) {
  for (const Vector3d& place :
       {Vector3d(0.3, 0.2, 2), Vector3d(-0.5, 0.5, 2), Vector3d(2.5, 0, 0), Vector3d(-3, 2, 0)}) {
    EXPECT_NEAR(density_at(place) / counted_at(place), 1, 0.35) << place.transpose();
  }
}

TEST_F(BlockOverTable, HidesWhatIsBehindIt) {
  EXPECT_EQ(density_at({0, 0, 1}), 0);
  EXPECT_EQ(density_at({0.4, -0.3, 0}), 0);
  EXPECT_EQ(density_at({0.4, -0.3, -1}), 0);
}

TEST_F(BlockOverTable, WouldBeSeenWhereTheSensorSawThrough) {
  EXPECT_GT(density_at({2.5, 0, 1}), 0);
  EXPECT_GT(density_at({0, 0, 4}), 0);
  EXPECT_GT(density_at({9, 0, 0}), 0) << "nothing was seen in this direction";
}

TEST_F(BlockOverTable, DoesNotTakeNearReturnsForThoseOfABarePlace) {
  const Vector3d below(2.5, 0, -0.1);
  const Vector3d way = (below - sensor_).normalized();
  const Vector3d across = way.cross(Vector3d::UnitY());
  const Vector3d steep = 0.25 * way + std::sqrt(1 - 0.25 * 0.25) * across;
  const SensorViews views(cloud_);
  EXPECT_GT(views.density_at(below, steep), 0) << "a steep surface may have these returns";
  EXPECT_EQ(views.density_at_bare(below, steep), 0);
  EXPECT_GT(views.density_at_bare({2.5, 0, 1}, steep), 0) << "the table is behind it";
}

TEST_F(BlockOverTable, IsHardlySeenEdgeOn) {
  EXPECT_LT(density_at({0, 0, 4}, Vector3d::UnitX()), 1e-9);
}

TEST_F(BlockOverTable, HasSamplesThatAreSeenOnlyWhereNothingIsBefore) {
  PointCloud samples;
  RandomStream random(2);
  for (int i = 0; i < 1000; ++i) {
    const double x = random.uniform(-0.9, 0.9);
    for (const double z : {2.0, 1.0}) samples.positions.push_back({x, 0, z});
    for (const double z : {1.0, -1.0}) samples.normals.push_back(z * Vector3d::UnitZ());
  }
  std::vector<std::uint32_t> order(cloud_.size());
  std::iota(order.begin(), order.end(), 0U);
  const std::vector<bool> seen = are_seen(samples, cloud_, order, {});
  EXPECT_EQ(are_seen(samples, cloud_, order, {.threads = 3}), seen);
  std::size_t above = 0;
  for (std::size_t i = 0; i < seen.size(); i += 2) {
    above += seen[i] ? 1 : 0;
    EXPECT_FALSE(seen[i + 1]);
  }
  EXPECT_GT(above, 700U);
  cloud_.sensor_positions = {};
  EXPECT_EQ(are_seen(samples, cloud_, order, {}), std::vector<bool>(samples.size(), true));
}

/// As of a scanner that is moved by hand: each point has a sensor of its own.
TEST_F(BlockOverTable, MayBeSeenFromSensorsThatMove) {
  RandomStream random(3);
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    const Vector3d off(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), 0);
    const Vector3d sensor = cloud_.sensor_positions[i] + off;
    cloud_.sensor_positions.x[i] = sensor.x();
    cloud_.sensor_positions.y[i] = sensor.y();
  }
  EXPECT_EQ(density_at({0, 0, 0}), 0);
  EXPECT_NEAR(density_at({0.3, 0.2, 2}) / counted_at({0.3, 0.2, 2}), 1, 0.35);
}

}  // namespace
}  // namespace cloud2csg
