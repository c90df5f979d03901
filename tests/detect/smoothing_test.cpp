#include "raw/detect/smoothing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/base/random.hpp"
#include "detect/detected_parts.hpp"
#include "support/smoothed.hpp"

namespace cloud2csg {
namespace {

using test::cloud_of;
using test::count_of;
using test::detect;
using test::smoothed;

const test::Part k_box = test::without_others({test::placed("box", Box{{4, 3, 1}}, {0, 0, 0})});
constexpr double k_box_noise = 0.01;

/// Errors of the means correlate over twice the deviation of the weights. The noise that is left is a fifth.
TEST(Smoothing, LeavesSharpEdges) {
  for (const std::uint64_t seed : {11U, 3U, 9U}) {
    const PointCloud cloud = sample_surface({.primitives = k_box.primitives, .tree = k_box.tree},
                                            {.count = 20'000, .noise = k_box_noise, .seed = seed});
    const double deviation = 1.2 * test::spacing_of(cloud);
    const PointCloud soft = smoothed(cloud, deviation);
    const Detection detection = detect(soft, 0.2 * k_box_noise);
    EXPECT_EQ(detection.surfaces.size(), 6U) << seed;
    EXPECT_EQ(count_of(detection, SurfaceType::plane), 6U) << seed;
    EXPECT_GT(detection.smoothed.size(), 100U) << seed;
    for (const std::uint32_t i : detection.smoothed) {
      const Eigen::Vector3d to_faces = Eigen::Vector3d(2, 1.5, 0.5) - soft.positions[i].cwiseAbs();
      std::array<double, 3> depths{to_faces.x(), to_faces.y(), to_faces.z()};
      std::ranges::sort(depths);
      EXPECT_LT(depths[1], 4 * deviation) << "a point far from all edges";
    }
  }
}

/// Noise of more than the spacing, too, where neighbours in space have similar errors.
TEST(Smoothing, IsNotSeenInIndependentErrorsNorInNone) {
  for (const double noise : {0.0, k_box_noise, 5 * k_box_noise}) {
    EXPECT_TRUE(detect(cloud_of(k_box, noise), noise).smoothed.empty()) << noise;
  }
}

/// Each point comes `copies` times. The copies share its error, and hardly differ.
TEST(Smoothing, IsNotSeenInCopiedPoints) {
  for (const std::size_t copies : {2U, 4U, 8U}) {
    const PointCloud once = cloud_of(k_box, k_box_noise, 12'000 / copies);
    RandomStream random(1);
    PointCloud cloud;
    for (std::size_t i = 0; i < copies * once.size(); ++i) {
      const std::size_t k = i % once.size();
      const Eigen::Vector3d own(random.normal(), random.normal(), random.normal());
      cloud.positions.push_back(once.positions[k] + 0.1 * k_box_noise * own);
      cloud.normals.push_back(once.normals[k]);
    }
    EXPECT_TRUE(detect(cloud, k_box_noise).smoothed.empty()) << copies;
  }
}

/// A scanner that measures line by line. The points of a line share most of their errors.
TEST(Smoothing, IsNotSeenInLinesOfAScanner) {
  for (const double along : {0.02, 0.03}) {
    constexpr double k_across = 0.1;
    RandomStream random(2);
    PointCloud cloud;
    for (const double side : {-1.0, 1.0}) {
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d half(2, 1.5, 0.5);
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        for (double y = -half[v]; y < half[v]; y += k_across) {
          const double of_line = k_box_noise * random.normal();
          for (double x = -half[u]; x < half[u]; x += along) {
            Eigen::Vector3d point;
            point[axis] = side * half[axis] + of_line + 0.3 * k_box_noise * random.normal();
            point[u] = x + along * random.uniform();
            point[v] = y;
            cloud.positions.push_back(point);
            cloud.normals.push_back(side * Eigen::Vector3d::Unit(axis));
          }
        }
      }
    }
    EXPECT_TRUE(detect(cloud, k_box_noise).smoothed.empty()) << along;
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
