#include "raw/solids/separators.hpp"

#include <gtest/gtest.h>

#include "core/base/random.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

/// Places in a bar from -2 to 2. Those beyond 1 should be out.
LabelledPlaces places_in_a_bar() {
  LabelledPlaces places;
  RandomStream random(1, 0);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d place(4 * random.uniform() - 2, random.uniform() - 0.5, random.uniform() - 0.5);
    if (place.x() > 0.8 && place.x() < 1.2) continue;
    places.positions.push_back(place);
    places.weights.push_back(place.x() > 1 ? -0.001 : 0.001);
  }
  return places;
}

const WrittenSolids k_bar{.solids = {test::placed("bar", Box{{4, 1, 1}}, {0, 0, 0})}, .tree = CsgTree::leaf(0)};

TEST(SeparatingPlanes, LieBetweenALumpAndTheRest) {
  const std::vector<Surface> planes = separating_planes(k_bar, places_in_a_bar(), 0.1);
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_GT(planes[0].axis.x(), 0.99);
  const LabelledPlaces places = places_in_a_bar();
  for (std::size_t i = 0; i < places.weights.size(); ++i) {
    const double height = planes[0].axis.dot(places.positions[i] - planes[0].position);
    EXPECT_EQ(height > 0, places.weights[i] < 0) << places.positions[i].transpose();
  }
}

TEST(SeparatingPlanes, AreLeftOutForLightLumps) {
  EXPECT_TRUE(separating_planes(k_bar, places_in_a_bar(), 10).empty());
}

TEST(SeparatingPlanes, NeedPlacesOnBothSides) {
  LabelledPlaces places = places_in_a_bar();
  for (double& weight : places.weights) weight = -0.001;
  EXPECT_TRUE(separating_planes(k_bar, places, 0.1).empty()) << "nothing is right";
  for (double& weight : places.weights) weight = 0.001;
  EXPECT_TRUE(separating_planes(k_bar, places, 0.1).empty()) << "nothing is wrong";
}

}  // namespace
}  // namespace cloud2csg
