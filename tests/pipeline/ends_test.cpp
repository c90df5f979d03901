#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "cloud2csg/reconstruct.hpp"
#include "cloud2csg/sample.hpp"
#include "core/base/random.hpp"
#include "core/geometry/boxes.hpp"
#include "pipeline/reconstructed.hpp"
#include "support/known_solids.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

Primitive angle_bar() {
  const Profile profile{{{{{-1, -0.6}}, {{1, -0.6}}, {{1, -0.2}}, {{-0.5, -0.2}, -0.4}, {{-0.6, 0.8}}, {{-1, 0.8}}}}};
  return {.id = "bar", .shape = Extrusion{profile, 5}, .pose = {}};
}

/// Where points are missing.
using IsMissing = std::function<bool(const Eigen::Vector3d&)>;

struct OpenPart {
  Primitive solid;
  IsMissing is_missing;
};

/// Without the missing points.
PointCloud cloud_of(const OpenPart& part, double noise) {
  const PointCloud whole = sample_surface({.primitives = {part.solid}, .tree = CsgTree::leaf(0)},
                                          {.count = 15'000, .noise = noise, .seed = 7});
  PointCloud cloud;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (part.is_missing(whole.positions[i])) continue;
    cloud.positions.push_back(whole.positions[i]);
    cloud.normals.push_back(whole.normals[i]);
  }
  return cloud;
}

/// Nothing shows the ends of a rod, or the oblique cut of a bar, and strays say nothing.
TEST(Reconstruct, EndsWhereThePointsEnd) {
  const IsMissing ends = [](const Eigen::Vector3d& p) { return std::abs(p.z()) > 2.2; };
  const IsMissing half = [](const Eigen::Vector3d& p) { return p.x() + 0.3 * p.z() > 0.4; };
  const Primitive rod{.id = "rod", .shape = Cylinder{.radius = 0.7, .height = 5}, .pose = {}};
  const Primitive block{.id = "block", .shape = Box{{2, 1.5, 5}}, .pose = {}};
  constexpr std::size_t k_strays = 20;
  for (const OpenPart& part : {OpenPart{angle_bar(), ends}, OpenPart{angle_bar(), half}, OpenPart{rod, ends},
                               OpenPart{block, ends}, OpenPart{block, half}}) {
    for (const double noise : {0.0, 0.01}) {
      PointCloud cloud = cloud_of(part, noise);
      const AlignedBox seen = bounds_of(cloud.positions);
      RandomStream random(3);
      for (std::size_t k = 0; k < k_strays; ++k) {
        cloud.positions.push_back(seen.center() + 0.8 * seen.diagonal().norm() * test::random_direction(random));
        cloud.normals.push_back(test::random_direction(random));
      }
      // Cleaning would remove the strays.
      const Extraction result = reconstruct(cloud, {.preparation = {.clean = {.remove_outliers = false}}});
      const AlignedBox allowed = grown(seen, 2 * result.statistics.finding->tolerance);
      const Points places = sample_surface(result.model, {.count = 5'000}).positions;
      const AlignedBox reached = bounds_of(places);
      EXPECT_TRUE(allowed.contains(reached))
          << part.solid.id << " noise " << noise << ": " << (reached.min() - allowed.min()).transpose() << " and "
          << (allowed.max() - reached.max()).transpose();
      EXPECT_TRUE(grown(reached, 2 * result.statistics.finding->tolerance).contains(seen))
          << part.solid.id << " noise " << noise << " ends too early";
    }
  }
}

/// From one view, a block shows three sides. The part stands on one of the others, and ends where the points end.
TEST(Reconstruct, ClosesNothingBeyondThePoints) {
  const OpenPart part{.solid = {.id = "block", .shape = Box{{1, 1, 1}}, .pose = {}},
                      .is_missing = [](const Eigen::Vector3d& p) { return p.minCoeff() < -0.498; }};
  const PointCloud cloud = cloud_of(part, 0.0005);
  const Extraction result = reconstruct(cloud);
  EXPECT_EQ(result.statistics.finding->closed.size(), 1U);
  const double allowed = 2 * result.statistics.finding->tolerance;
  const Points places = sample_surface(result.model, {.count = 5'000}).positions;
  EXPECT_TRUE(grown(bounds_of(cloud.positions), allowed).contains(bounds_of(places)));
}

/// Without evidence for the absence of points, chips stay at the corners of the cube: they are too small for a leaf.
TEST(Reconstruct, LeavesNothingWhereNoPointsAre) {
  const auto bore = [](const Eigen::Vector3d& axis) {
    return Primitive{.id = "bore",
                     .shape = Cylinder{.radius = 3.3, .height = 12},
                     .pose = pose_from_axis(Eigen::Vector3d::Zero(), axis)};
  };
  const Model truth{
      .primitives = {test::placed("ball", Sphere{6.8}, {0, 0, 0}), test::placed("cube", Box{{10, 10, 10}}, {0, 0, 0}),
                     bore(Eigen::Vector3d::UnitX()), bore(Eigen::Vector3d::UnitY()), bore(Eigen::Vector3d::UnitZ())},
      .tree = subtract(intersect(CsgTree::leaf(0), CsgTree::leaf(1)),
                       unite_all(std::vector{CsgTree::leaf(2), CsgTree::leaf(3), CsgTree::leaf(4)}))};
  const Extraction result = reconstruct(sample_surface(truth, {.count = 40'000, .seed = 1}));
  EXPECT_EQ(result.statistics.verdict.bare_surface, 0.0);
  EXPECT_GT(test::iou(result, truth), 0.999);
}

}  // namespace
}  // namespace cloud2csg
