#include "raw/detect/smoothing.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/neighbour_tree.hpp"
#include "detect/detected_parts.hpp"

namespace cloud2csg {
namespace {

using test::cloud_of;
using test::count_of;
using test::detect;

/// Each point and normal is a Gaussian mean of those around it, as in a mesh that joins the views of a scanner.
PointCloud smoothed(const PointCloud& cloud, double deviation) {
  const NeighbourTree tree(cloud.positions);
  PointCloud result = cloud;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double weights = 0;
    for (const std::uint32_t k : tree.within(cloud.positions[i], 3 * deviation)) {
      const double distance = (cloud.positions[k] - cloud.positions[i]).norm() / deviation;
      const double weight = std::exp(-0.5 * distance * distance);
      position += weight * cloud.positions[k];
      normal += weight * cloud.normals[k];
      weights += weight;
    }
    result.positions.set(i, position / weights);
    result.normals.set(i, normal.normalized());
  }
  return result;
}

const test::Part k_box = test::without_others({test::placed("box", Box{{4, 3, 1}}, {0, 0, 0})});
constexpr double k_box_noise = 0.01;

/// Errors of the means correlate over twice the deviation of the weights. The noise that is left is a fifth.
TEST(Smoothing, LeavesSharpEdges) {
  const PointCloud cloud = cloud_of(k_box, k_box_noise);
  const double deviation = 1.2 * test::spacing_of(cloud);
  const PointCloud soft = smoothed(cloud, deviation);
  const Detection detection = detect(soft, 0.2 * k_box_noise);
  EXPECT_EQ(detection.surfaces.size(), 6U);
  EXPECT_EQ(count_of(detection, SurfaceType::plane), 6U);
  EXPECT_GT(detection.smoothed.size(), 100U);
  for (const std::uint32_t i : detection.smoothed) {
    const Eigen::Vector3d to_faces = Eigen::Vector3d(2, 1.5, 0.5) - soft.positions[i].cwiseAbs();
    std::array<double, 3> depths{to_faces.x(), to_faces.y(), to_faces.z()};
    std::ranges::sort(depths);
    EXPECT_LT(depths[1], 4 * deviation) << "a point far from all edges";
  }
}

/// Noise of more than the spacing, too, where neighbours in space have similar errors.
TEST(Smoothing, IsNotSeenInIndependentErrorsNorInNone) {
  for (const double noise : {0.0, k_box_noise, 5 * k_box_noise}) {
    EXPECT_TRUE(detect(cloud_of(k_box, noise), noise).smoothed.empty()) << noise;
  }
}

/// A chamfer that is wider than the smoothing is a face.
TEST(Smoothing, LeavesWideChamfers) {
  Polytope chamfered;
  for (int axis = 0; axis < 3; ++axis) {
    const double half = std::array{2.0, 1.5, 0.5}[static_cast<std::size_t>(axis)];
    for (const double sign : {-1.0, 1.0}) {
      chamfered.planes.push_back({.normal = sign * Eigen::Vector3d::Unit(axis), .offset = half});
    }
  }
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 0, 1).normalized();
  chamfered.planes.push_back({.normal = normal, .offset = normal.dot(Eigen::Vector3d(1.8, 0, 0.5))});
  const PointCloud cloud = cloud_of(test::without_others({test::placed("part", chamfered, {0, 0, 0})}), k_box_noise);
  const Detection detection = detect(smoothed(cloud, 1.2 * test::spacing_of(cloud)), 0.2 * k_box_noise);
  EXPECT_EQ(detection.surfaces.size(), 7U);
  EXPECT_FALSE(detection.smoothed.empty());
}

}  // namespace
}  // namespace cloud2csg
