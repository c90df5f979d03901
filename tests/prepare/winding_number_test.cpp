#include "cloud2csg/advanced/winding_number.hpp"

#include <gtest/gtest.h>

#include "prepare/clouds.hpp"

namespace cloud2csg {
namespace {

using namespace testing_support;

TEST(WindingField, AgreesWithThePlainSum) {
  const PointCloud cloud = model_cloud("m1", 3000);
  const WindingField field(cloud.positions, cloud.normals, point_areas(cloud));
  const AlignedBox box = bounds_of(cloud.positions);
  for (std::uint64_t i = 0; i < 100; ++i) {
    RandomStream random(1, 0, i);
    const Vector3d share(random.uniform(-0.5, 1.5), random.uniform(-0.5, 1.5), random.uniform(-0.5, 1.5));
    const Vector3d place = box.min() + share.cwiseProduct(box.sizes());
    EXPECT_NEAR(field.at(place), field.exact(place), 0.04);
  }
}

TEST(WindingNumbers, TellInsideFromOutside) {
  PointCloud cloud;
  RandomStream random(1);
  add_box(cloud, {0, 0, 0}, {1, 1, 1}, 1500, false, random);
  add_box(cloud, {0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}, 1500, true, random);
  Points places;
  places.push_back({0.15, 0.5, 0.5});
  places.push_back({0.5, 0.5, 0.5});
  places.push_back({1.5, 0.5, 0.5});
  const std::vector<double> far =
      winding_numbers(moved(cloud, 100.0, {1e6, 0, 0}), moved({places, {}}, 100.0, {1e6, 0, 0}).positions);
  const std::vector<double> near = winding_numbers(cloud, places, {.threads = 2});
  const std::vector<double> expected{1.0, 0.0, 0.0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(near[i], expected[i], 0.1) << i;
    EXPECT_NEAR(far[i], near[i], 1e-4) << i;
  }
}

TEST(WindingNumbers, OfNoPointsAreZero) {
  const WindingField field({}, {}, {});
  EXPECT_EQ(field.at({1, 2, 3}), 0.0);
}

}  // namespace
}  // namespace cloud2csg
