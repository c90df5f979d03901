#include <gtest/gtest.h>

#include "cloud2csg/advanced/prepare.hpp"
#include "core/geometry/cubes.hpp"
#include "detect/detected_parts.hpp"

namespace cloud2csg {
namespace {

using test::cloud_of;
using test::detect;

/// A block whose points are off by the same amount as others in the same cube, as in a smoothed mesh.
PointCloud block_with_shared_noise(double noise, double cube) {
  PointCloud cloud =
      cloud_of({.primitives = {test::placed("block", Box{{4, 3, 2}}, {0, 0, 0})}, .tree = CsgTree::leaf(0)}, 0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d place = cloud.positions[i];
    RandomStream of_cube(1, cube_of(place, cube));
    cloud.positions.set(i, place + noise * of_cube.normal() * cloud.normals[i]);
  }
  return cloud;
}

TEST(NoiseOfDetection, IsThatWhichLocalFitsFollow) {
  constexpr double k_noise = 0.02;
  const PointCloud cloud = block_with_shared_noise(k_noise, 0.1);
  const PreparedCloud prepared = prepare_cloud(cloud);
  EXPECT_LT(prepared.scale.noise, 0.6 * k_noise);
  const Detection detection = detect_surfaces(prepared.cloud, prepared.scale);
  EXPECT_GT(detection.noise, 0.7 * k_noise);
  EXPECT_LT(detection.noise, 1.1 * k_noise);
  EXPECT_EQ(detection.surfaces.size(), 6U);
}

TEST(NoiseOfDetection, IsMeasuredByPlanes) {
  constexpr double k_noise = 0.01;
  const PointCloud cloud = cloud_of(test::plate_with_holes(), k_noise);
  for (const double assumed : {0.3 * k_noise, k_noise, 2 * k_noise}) {
    EXPECT_NEAR(detect(cloud, assumed).noise, k_noise, 0.05 * k_noise) << assumed;
  }
  EXPECT_EQ(detect(cloud, 0.3 * k_noise, {.distance_tolerance = 0.03}).noise, 0.3 * k_noise) << "a given value holds";
}

}  // namespace
}  // namespace cloud2csg
