#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "cloud2csg/advanced/solids.hpp"
#include "cloud2csg/advanced/winding_number.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/sample.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

/// A block with a thin wall on it and a hole through it.
const PrimitiveSet k_solids{test::placed("block", Box{{4, 3, 1}}, {0, 0, 0}),
                            test::placed("wall", Box{{4, 0.15, 2}}, {0, 1, 1}),
                            test::placed("hole", Cylinder{0.5, 3}, {0, -0.5, 0})};

CsgTree tree() {
  return parse_tree("(block | wall) - hole", k_solids);
}

LabelledPlaces places_of(const CsgTree& of, double noise) {
  const PointCloud cloud =
      sample_surface({.primitives = k_solids, .tree = of}, {.count = 10'000, .noise = noise, .seed = 7});
  return label_places(cloud, {.noise = noise, .volume_places = 8000, .surface_points = 2000});
}

double total_weight(const LabelledPlaces& places) {
  double sum = 0;
  for (const double weight : places.weights) sum += std::abs(weight);
  return sum;
}

TEST(LabelPlaces, AgreesWithTheSolid) {
  for (const double noise : {0.0, 0.005, 0.01}) {
    const LabelledPlaces places = places_of(tree(), noise);
    EXPECT_EQ(places.positions.size(), places.weights.size());
    EXPECT_LT(wrong_place_share(tree(), k_solids, places), 0.01) << noise;
  }
}

TEST(LabelPlaces, KnowsThinWallsAndHoles) {
  const LabelledPlaces places = places_of(tree(), 0.005);
  EXPECT_GT(wrong_place_share(parse_tree("block - hole", k_solids), k_solids, places), 0.1);
  EXPECT_GT(wrong_place_share(parse_tree("block | wall", k_solids), k_solids, places), 0.05);
}

TEST(LabelPlaces, TellsTheWorstPlace) {
  const LabelledPlaces places = places_of(tree(), 0.005);
  // On the axis of the hole, and in the wall.
  const Eigen::Vector3d unbored = worst_place(parse_tree("block | wall", k_solids), k_solids, places);
  EXPECT_LT((unbored - Eigen::Vector3d(0, -0.5, unbored.z())).norm(), 0.5);
  EXPECT_LT(std::abs(unbored.z()), 0.5);
  const Eigen::Vector3d wanting = worst_place(parse_tree("block - hole", k_solids), k_solids, places);
  EXPECT_LT(std::abs(wanting.y() - 1), 0.075);
  EXPECT_GT(wanting.z(), 0.5);
}

TEST(LabelPlaces, WeighsTheVolumeOfTheSolidAsOne) {
  const LabelledPlaces places = places_of(CsgTree::leaf(0), 0.0);
  // Nothing in the solid: its volume, and half of what is beside its surface, is wrong.
  EXPECT_NEAR(wrong_place_share(CsgTree::empty(), k_solids, places), 1.5, 0.05);
  EXPECT_GT(total_weight(places), 2.0);
}

std::string refusal_of(const PointCloud& cloud) {
  try {
    (void)label_places(cloud, {.noise = 0.0, .volume_places = 1000, .surface_points = 500});
    return {};
  } catch (const NoInside& error) {
    return error.what();
  }
}

TEST(LabelPlaces, TellsWhatToDoWithARoom) {
  PointCloud room = sample_surface({.primitives = k_solids, .tree = CsgTree::leaf(0)}, {.count = 2000, .noise = 0});
  for (std::size_t i = 0; i < room.size(); ++i) room.normals.set(i, -Eigen::Vector3d(room.normals[i]));
  EXPECT_NE(refusal_of(room).find("outward normals or sensor positions"), std::string::npos);
  for (std::size_t i = 0; i < room.size(); ++i) room.sensor_positions.push_back({0, 0, 0});
  EXPECT_NE(refusal_of(room).find("for the space in a room, leave out the sensor positions"), std::string::npos);
}

/// Share of the places in a shaft that are labelled as in the solid.
double share_in_shaft(const LabelledPlaces& places) {
  double in = 0;
  double all = 0;
  for (std::size_t i = 0; i < places.weights.size(); ++i) {
    const Eigen::Vector3d place = places.positions[i];
    if (place.head<2>().cwiseAbs().maxCoeff() > 0.15 || place.z() < -0.2 || place.z() > 0.4) continue;
    all += 1;
    in += places.weights[i] > 0 ? 1 : 0;
  }
  EXPECT_GT(all, 20);
  return in / all;
}

TEST(LabelPlaces, SeesTheSpaceAlongLinesOfSight) {
  const PrimitiveSet solids{test::placed("block", Box{{1, 1, 1}}, {0, 0, 0}),
                            test::placed("shaft", Box{{0.4, 0.4, 0.8}}, {0, 0, 0.2})};
  const PointCloud all = sample_surface({.primitives = solids, .tree = parse_tree("block - shaft", solids)},
                                        {.count = 20'000, .noise = 0, .seed = 3});
  PointCloud seen;  // all but the walls of the shaft
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Eigen::Vector3d position = all.positions[i];
    const bool is_floor = position.head<2>().cwiseAbs().maxCoeff() < 0.19 && position.z() < 0.4;
    const bool is_outer = position.cwiseAbs().maxCoeff() > 0.499;
    if (!is_floor && !is_outer) continue;
    seen.positions.push_back(position);
    seen.normals.push_back(all.normals[i]);
  }
  const PlaceOptions options{.volume_places = 8000, .surface_points = 2000};
  EXPECT_GT(share_in_shaft(label_places(seen, options)), 0.5);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    seen.sensor_positions.push_back(seen.positions[i] + 5 * seen.normals[i]);
  }
  EXPECT_LT(share_in_shaft(label_places(seen, options)), 0.02);
}

TEST(LabelPlaces, TakesAreasThatAreKnown) {
  const PointCloud cloud =
      sample_surface({.primitives = k_solids, .tree = tree()}, {.count = 3000, .noise = 0.005, .seed = 2});
  const PlaceOptions options{.noise = 0.005, .volume_places = 2000, .surface_points = 500};
  const LabelledPlaces measured = label_places(cloud, options);
  std::vector<double> areas = point_areas(cloud);
  const LabelledPlaces taken = label_places(cloud, options, {}, areas);
  EXPECT_EQ(taken.positions.x, measured.positions.x);
  EXPECT_EQ(taken.weights, measured.weights);
  for (double& area : areas) area *= 4;
  EXPECT_NE(label_places(cloud, options, {}, areas).weights, measured.weights);
  areas.pop_back();
  EXPECT_THROW((void)label_places(cloud, options, {}, areas), Error);
}

TEST(LabelPlaces, RefusesACloudWithoutAnInside) {
  PointCloud cloud = sample_surface({.primitives = k_solids, .tree = tree()}, {.count = 2000, .seed = 1});
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.normals.set(i, -cloud.normals[i]);
  EXPECT_THROW((void)label_places(cloud), Error);
  EXPECT_THROW((void)label_places({}), Error);
  EXPECT_THROW((void)label_places(cloud, {.margin = -1}), Error);
}

}  // namespace
}  // namespace cloud2csg
