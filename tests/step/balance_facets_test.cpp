#include "io/step/balance_facets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cloud2csg/mesh.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg::brep {
namespace {

constexpr double k_pi = std::numbers::pi;

TEST(BalanceFacets, BringsTheVolumeOfFewFacetsNearTheTruth) {
  const PrimitiveSet primitives{test::placed("ball", Sphere{.radius = 1}, {0.1, 0.2, 0.3})};
  const CsgTree ball = CsgTree::leaf(0);
  TriangleMesh mesh = mesh_surface({.primitives = primitives, .tree = ball},
                                   bounds_of({.primitives = primitives, .tree = ball}), {.resolution = 12});
  const double expected = 4 * k_pi / 3;
  ASSERT_GT(std::abs(volume_of(mesh) / expected - 1), 0.005);
  balance_facets(mesh, {.primitives = primitives, .tree = ball});
  EXPECT_NEAR(volume_of(mesh) / expected, 1, 0.001);
  EXPECT_TRUE(is_watertight(mesh));
}

TEST(BalanceFacets, LeavesFlatFacesAsTheyAre) {
  const PrimitiveSet primitives{test::placed("box", Box{.size = {1, 2, 3}}, {0, 0, 0})};
  const CsgTree box = CsgTree::leaf(0);
  TriangleMesh mesh = mesh_surface({.primitives = primitives, .tree = box},
                                   bounds_of({.primitives = primitives, .tree = box}), {.resolution = 12});
  balance_facets(mesh, {.primitives = primitives, .tree = box});
  EXPECT_NEAR(volume_of(mesh), 6, 1e-9);
}

}  // namespace
}  // namespace cloud2csg::brep
