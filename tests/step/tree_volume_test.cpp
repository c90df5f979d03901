#include "io/step/tree_volume.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cloud2csg/mesh.hpp"
#include "io/step/balance_facets.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg::brep {
namespace {

constexpr double k_pi = std::numbers::pi;

VolumeEstimate volume(const CsgTree& tree, const PrimitiveSet& primitives, int levels = 7, int threads = 1) {
  return tree_volume(tree, primitives, bounds_of(tree, primitives), levels, {.threads = threads});
}

void expect_volume(const VolumeEstimate& found, double expected) {
  EXPECT_LT(found.error, 1e-3 * expected);
  EXPECT_NEAR(found.volume, expected, 5 * found.error + 1e-9 * expected);
}

TEST(TreeVolume, IsThatOfKnownSolids) {
  const PrimitiveSet primitives{test::placed("ball", Sphere{.radius = 2}, {1, 2, 3}),
                                test::placed("bore", Cylinder{.radius = 0.5, .height = 1}, {1, 2, 3}),
                                test::placed("ring", Torus{.major_radius = 3, .minor_radius = 0.5}, {40, 0, 0})};
  expect_volume(volume(CsgTree::leaf(0), primitives), 32 * k_pi / 3);
  expect_volume(volume(CsgTree::leaf(2), primitives), 2 * k_pi * k_pi * 3 * 0.25);
  expect_volume(volume(subtract(CsgTree::leaf(0), CsgTree::leaf(1)), primitives), 32 * k_pi / 3 - 0.25 * k_pi);
}

TEST(TreeVolume, JudgesExpressionsWithinTheirBounds) {
  const Expression half_ball{.distance = "x^2 + y^2 + z^2 - 1",
                             .bounds = AlignedBox(Eigen::Vector3d(-2, -2, -2), Eigen::Vector3d(2, 2, 0))};
  expect_volume(volume(CsgTree::leaf(0), {test::placed("e", half_ball, {5, 5, 5})}, 8), 2 * k_pi / 3);
}

TEST(TreeVolume, DoesNotDependOnThreads) {
  const PrimitiveSet primitives{test::placed("ball", Sphere{.radius = 1}, {0, 0, 0})};
  const VolumeEstimate one = volume(CsgTree::leaf(0), primitives, 7, 1);
  const VolumeEstimate many = volume(CsgTree::leaf(0), primitives, 7, 4);
  EXPECT_EQ(one.volume, many.volume);
  EXPECT_EQ(one.error, many.error);
}

TEST(TreeVolume, OfNothingIsNothing) {
  EXPECT_EQ(tree_volume(CsgTree::empty(), {}, AlignedBox(), 6, {}).volume, 0);
}

TEST(BalanceFacets, BringsTheVolumeOfFewFacetsNearTheTruth) {
  const PrimitiveSet primitives{test::placed("ball", Sphere{.radius = 1}, {0.1, 0.2, 0.3})};
  const CsgTree ball = CsgTree::leaf(0);
  TriangleMesh mesh = mesh_surface(ball, primitives, bounds_of(ball, primitives), {.resolution = 12});
  const double expected = 4 * k_pi / 3;
  ASSERT_GT(std::abs(volume_of(mesh) / expected - 1), 0.005);
  balance_facets(mesh, ball, primitives);
  EXPECT_NEAR(volume_of(mesh) / expected, 1, 0.001);
  EXPECT_TRUE(is_watertight(mesh));
}

TEST(BalanceFacets, LeavesFlatFacesAsTheyAre) {
  const PrimitiveSet primitives{test::placed("box", Box{.size = {1, 2, 3}}, {0, 0, 0})};
  const CsgTree box = CsgTree::leaf(0);
  TriangleMesh mesh = mesh_surface(box, primitives, bounds_of(box, primitives), {.resolution = 12});
  balance_facets(mesh, box, primitives);
  EXPECT_NEAR(volume_of(mesh), 6, 1e-9);
}

}  // namespace
}  // namespace cloud2csg::brep
