#include "raw/solids/bare_surface.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "cloud2csg/sample.hpp"
#include "core/geometry/subset.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

constexpr double k_near = 0.3;

Model ball_and_block() {
  return {.primitives = {test::placed("ball", Sphere{1}, {0, 0, 0}), test::placed("block", Box{{1, 1, 1}}, {4, 0, 0})},
          .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))};
}

Points points_of(const Model& model, std::size_t primitive) {
  Model alone{.primitives = {model.primitives[primitive]}, .tree = CsgTree::leaf(0)};
  return sample_surface(alone, {.count = 5'000, .seed = 1}).positions;
}

/// The block is bare. Its surface is 6, that of the ball 4 pi.
TEST(BareSurface, IsWhereNoPointsAre) {
  const Model model = ball_and_block();
  Points points = points_of(model, 0);
  const BareSurface bare = find_bare_surface(*model.tree, model.primitives, points, k_near);
  EXPECT_NEAR(bare.share(), 6 / (6 + 4 * std::numbers::pi), 0.02);
  for (std::size_t i = 0; i < bare.shares.size(); ++i) {
    EXPECT_GE(bare.samples.positions[i].x(), 3.49);
    EXPECT_GT(bare.distances[i], k_near);
  }
  append(points, points_of(model, 1));
  EXPECT_EQ(find_bare_surface(*model.tree, model.primitives, points, k_near).share(), 0);
}

/// Where all places around are outside, both sides of the surface are. Where they disagree, nothing is said.
TEST(BareSurface, ItsPlacesHaveTheLabelsAround) {
  const Model model = ball_and_block();
  const Points points = points_of(model, 0);
  const BareSurface bare = find_bare_surface(*model.tree, model.primitives, points, k_near);
  LabelledPlaces places;
  for (double x = -1.5; x < 7; x += 0.25) {
    for (double y = -2; y < 2; y += 0.25) {
      for (double z = -2; z < 2; z += 0.25) {
        const Eigen::Vector3d place(x + 0.11, y + 0.07, z + 0.03);
        places.positions.push_back(place);
        places.weights.push_back(place.norm() < 1 ? 1 : -1);
      }
    }
  }
  const LabelledPlaces outside = places_beside(bare, places, 0.01);
  ASSERT_EQ(outside.positions.size(), 2 * bare.shares.size());
  double sum = 0;
  for (const double weight : outside.weights) sum += weight;
  EXPECT_NEAR(sum, -bare.share(), 1e-9);
  EXPECT_NEAR(wrong_place_share(*model.tree, model.primitives, outside), 0.5 * bare.share(), 1e-9);
  for (std::size_t i = 0; i < places.positions.size(); ++i) {
    if (places.positions[i].z() > 0 && places.positions[i].x() > 2) places.weights[i] = 1;
  }
  EXPECT_LT(places_beside(bare, places, 0.01).positions.size(), outside.positions.size());
}

}  // namespace
}  // namespace cloud2csg
