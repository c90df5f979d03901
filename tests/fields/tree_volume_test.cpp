#include "core/fields/tree_volume.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cloud2csg/mesh.hpp"
#include "core/base/random.hpp"
#include "core/geometry/boxes.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

constexpr double k_pi = std::numbers::pi;

VolumeEstimate volume(const CsgTree& tree, const PrimitiveSet& primitives, int levels = 7, int threads = 1) {
  return tree_volume({.primitives = primitives, .tree = tree}, bounds_of({.primitives = primitives, .tree = tree}),
                     levels, {.threads = threads});
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
  EXPECT_EQ(tree_volume({.primitives = {}, .tree = CsgTree::empty()}, AlignedBox(), 6, {}).volume, 0);
}

/// Waves as high as half of the radius: what a displacement does to the slope must not hide them.
TEST(TreeVolume, CountsWavesThatAreSmallBesideCells) {
  for (const double frequency : {3.0, 30.0}) {
    Primitive waves = test::placed("waves", Sphere{.radius = 2}, {0, 0, 0});
    waves.displacement = Displacement{.frequency = frequency};
    const VolumeEstimate fine = volume(CsgTree::leaf(0), {waves}, 7);
    // The box in cells, none left out.
    const AlignedBox box = bounds(waves);
    RandomStream random(1);
    Points places;
    for (int i = 0; i < 400'000; ++i) places.push_back(random_between(box.min(), box.max(), random));
    const std::vector<double> values = signed_distance(waves, places);
    const auto inside = static_cast<double>(std::ranges::count_if(values, [](double value) { return value < 0; }));
    const double expected = box.volume() * inside / 400'000;
    EXPECT_NEAR(fine.volume / expected, 1, 0.01) << frequency;
  }
}

}  // namespace
}  // namespace cloud2csg
