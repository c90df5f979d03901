#include "cloud2csg/advanced/refine.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <stop_token>

#include "cloud2csg/error.hpp"
#include "pipeline/refine/slots.hpp"
#include "support/known_solids.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

constexpr double k_noise = 0.01;
constexpr double k_degree = std::numbers::pi / 180;

/// A solid with its values off by up to a share of its size, and turned by an angle.
Primitive shaken(const Primitive& primitive, double share, double angle_deg, RandomStream& random) {
  const LocalFrame frame{.orientation = primitive.pose.orientation, .origin = primitive.pose.position};
  const double size = std::min(2 * oriented_bounds(primitive).half_size.maxCoeff(), 2.0);
  std::vector<double> values;
  for (const Slot& slot : slots_of(primitive, frame)) {
    values.push_back(slot.value + random.uniform(-share, share) * size);
  }
  Primitive result = with_slots(primitive, frame, values).value_or(primitive);
  const Eigen::AngleAxisd turn(angle_deg * k_degree, test::random_direction(random));
  result.pose.orientation = Eigen::Quaterniond(turn) * result.pose.orientation;
  return result;
}

PrimitiveSet all_shaken(const PrimitiveSet& primitives, std::uint64_t seed) {
  RandomStream random(seed);
  PrimitiveSet result;
  for (const Primitive& primitive : primitives) result.push_back(shaken(primitive, 0.01, 1, random));
  return result;
}

/// Of points without noise, from the tree over other primitives.
double rms_distance(const PointCloud& exact, const CsgTree& tree, const PrimitiveSet& primitives) {
  double squares = 0;
  for (const double distance : implicit_value(tree, primitives, exact.positions)) squares += distance * distance;
  return std::sqrt(squares / static_cast<double>(exact.size()));
}

double axis_angle_deg(const Primitive& a, const Primitive& b) {
  const Eigen::Vector3d first = a.pose.orientation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d second = b.pose.orientation * Eigen::Vector3d::UnitZ();
  return std::atan2(first.cross(second).norm(), std::abs(first.dot(second))) / k_degree;
}

/// A plate with a bore through it, whose ends are in the air, and a rod beside the bore.
Model bored_plate() {
  const PrimitiveSet primitives{test::placed("plate", Box{{3, 2, 0.5}}, {0, 0, 0}),
                                test::placed("bore", Cylinder{0.4, 1.1}, {-0.7, 0.2, 0}),
                                test::placed("rod", Cylinder{0.4, 1.5}, {0.8, 0.2, 0.7})};
  return {.primitives = primitives,
          .tree = unite(subtract(CsgTree::leaf(0), CsgTree::leaf(1)), CsgTree::leaf(2)),
          .description = {}};
}

PointCloud cloud_of(const Model& model, double noise = k_noise, std::uint64_t seed = 1) {
  return sample_surface(model, {.count = 4000, .noise = noise, .seed = seed});
}

class ShippedModel : public testing::TestWithParam<const char*> {};

TEST_P(ShippedModel, IsBroughtToAThirdOfTheError) {
  const Model model = test::paper_model(GetParam());
  const PointCloud exact = cloud_of(model, 0, 9);
  const PrimitiveSet given = all_shaken(model.primitives, 1);
  const Refinement result = refine_primitives(cloud_of(model), given, *model.tree);
  EXPECT_TRUE(result.is_better);
  EXPECT_LT(result.rms_after, result.rms_before);
  EXPECT_LT(rms_distance(exact, *model.tree, result.primitives), 0.33 * rms_distance(exact, *model.tree, given));
}

INSTANTIATE_TEST_SUITE_P(Paper, ShippedModel, testing::Values("m0", "m1", "m2", "m3"),
                         [](const auto& name) { return std::string(name.param); });

TEST(RefinePrimitives, EveryTypeFindsItsPlace) {
  const std::vector<Shape> shapes{Box{{1, 0.8, 0.6}},
                                  Sphere{0.6},
                                  Cylinder{0.5, 1.2},
                                  Cone{0.6, 0.3, 1},
                                  Cone{0.7, 0, 1},
                                  Torus{0.7, 0.25},
                                  Polytope{{{{1, 0, 0}, 0.5},
                                            {{-1, 0, 0}, 0.5},
                                            {{0, 1, 0}, 0.5},
                                            {{0, -1, 0}, 0.5},
                                            {{0, 0.6, 0.8}, 0.4},
                                            {{0, 0, -1}, 0.5}}}};
  for (std::uint64_t k = 0; k < shapes.size(); ++k) {
    RandomStream random(k);
    Model model{.primitives = {test::placed("solid", shapes[k], test::random_within(1, random))},
                .tree = CsgTree::leaf(0),
                .description = {}};
    model.primitives[0].pose.orientation = Eigen::AngleAxisd(1, test::random_direction(random));
    const PrimitiveSet given{shaken(model.primitives[0], 0.01, 1, random)};
    const Refinement result = refine_primitives(cloud_of(model), given, *model.tree);
    EXPECT_LT(rms_distance(cloud_of(model, 0, 9), *model.tree, result.primitives), 0.15 * k_noise)
        << type_name(shapes[k]) << " " << k;
    EXPECT_EQ(result.primitives[0].shape.index(), shapes[k].index());
    EXPECT_NO_THROW(validate(result.primitives[0]));
  }
}

TEST(RefinePrimitives, ADisplacedSolidKeepsItsDisplacement) {
  const Model model = test::paper_model("m1");
  const Refinement result = refine_primitives(cloud_of(model), all_shaken(model.primitives, 2), *model.tree);
  for (std::size_t p = 0; p < model.primitives.size(); ++p) {
    ASSERT_EQ(result.primitives[p].displacement.has_value(), model.primitives[p].displacement.has_value());
    if (!model.primitives[p].displacement) continue;
    EXPECT_EQ(result.primitives[p].displacement->frequency, model.primitives[p].displacement->frequency);
  }
}

TEST(RefinePrimitives, WhatNoPointDeterminesStays) {
  const Model model = bored_plate();
  PrimitiveSet given = model.primitives;
  std::get<Cylinder>(given[1].shape).radius = 0.41;
  const Refinement result = refine_primitives(cloud_of(model), given, *model.tree, {.regularise = false});
  const auto& bore = std::get<Cylinder>(result.primitives[1].shape);
  EXPECT_NEAR(bore.radius, 0.4, 0.2 * k_noise);
  EXPECT_NEAR(bore.height, 1.1, 1e-3) << "its ends are in the air";
  EXPECT_NEAR(result.primitives[1].pose.position.z(), 0, 1e-3);
}

TEST(RefinePrimitives, MakesRegularWhatNearlyIs) {
  const Model model = bored_plate();
  const Refinement result = refine_primitives(cloud_of(model), all_shaken(model.primitives, 3), *model.tree);
  ASSERT_TRUE(result.is_better);
  EXPECT_LT(axis_angle_deg(result.primitives[0], result.primitives[1]), 1e-6);
  EXPECT_LT(axis_angle_deg(result.primitives[0], result.primitives[2]), 1e-6);
  EXPECT_EQ(std::get<Cylinder>(result.primitives[1].shape).radius,
            std::get<Cylinder>(result.primitives[2].shape).radius);
  EXPECT_LT(axis_angle_deg(result.primitives[0], model.primitives[0]), 0.1);
  const auto has = [&](RegularityType type, const std::vector<PrimitiveIndex>& primitives) {
    return std::ranges::any_of(result.regularities, [&](const Regularity& regularity) {
      return regularity.type == type && regularity.primitives == primitives;
    });
  };
  EXPECT_TRUE(has(RegularityType::directions, {0, 1, 2}));
  EXPECT_TRUE(has(RegularityType::radii, {1, 2}));
}

TEST(RefinePrimitives, DoesNotMakeRegularWhatIsNot) {
  Model model = bored_plate();
  model.primitives[2].pose.orientation = Eigen::AngleAxisd(4 * k_degree, Eigen::Vector3d::UnitX());
  std::get<Cylinder>(model.primitives[2].shape).radius = 0.43;
  const Refinement result = refine_primitives(cloud_of(model), all_shaken(model.primitives, 4), *model.tree);
  EXPECT_NEAR(axis_angle_deg(result.primitives[0], result.primitives[2]), 4, 0.4);
  EXPECT_NEAR(std::get<Cylinder>(result.primitives[2].shape).radius, 0.43, 0.3 * k_noise);
}

TEST(RefinePrimitives, NeverMakesThemWorse) {
  const Model model = bored_plate();
  const PointCloud exact = cloud_of(model, 0);
  const Refinement result = refine_primitives(exact, model.primitives, *model.tree);
  EXPECT_LE(rms_distance(exact, *model.tree, result.primitives),
            rms_distance(exact, *model.tree, model.primitives) + 1e-9);
}

TEST(RefinePrimitives, LeavesPrimitivesWithoutPointsAlone) {
  Model model = bored_plate();
  model.primitives.push_back(test::placed("elsewhere", Sphere{0.5}, {9, 9, 9}));
  const Refinement result = refine_primitives(cloud_of(model), all_shaken(model.primitives, 5), *model.tree);
  EXPECT_EQ(result.changes[3].points, 0U);
  EXPECT_EQ(result.changes[3].largest_shift, 0);
  EXPECT_GT(result.changes[0].points, 500U);
}

TEST(RefinePrimitives, LeavesExpressionsAlone) {
  const Primitive ball{
      .id = "ball",
      .shape = Expression{.distance = "sqrt(x^2+y^2+z^2)-1",
                          .bounds = AlignedBox(Eigen::Vector3d(-2, -2, -2), Eigen::Vector3d(2, 2, 2))}};
  const PointCloud cloud = cloud_of(
      {.primitives = {test::placed("s", Sphere{1.02}, {0, 0, 0})}, .tree = CsgTree::leaf(0), .description = {}});
  const Refinement result = refine_primitives(cloud, {ball}, CsgTree::leaf(0));
  EXPECT_FALSE(result.is_better);
}

bool are_equal(const PrimitiveSet& a, const PrimitiveSet& b) {
  const Points points = test::lattice(AlignedBox(Eigen::Vector3d(-2, -2, -2), Eigen::Vector3d(2, 2, 2)), 6);
  for (std::size_t p = 0; p < a.size(); ++p) {
    if (signed_distance(a[p], points) != signed_distance(b[p], points)) return false;
  }
  return true;
}

TEST(RefinePrimitives, DoesNotDependOnTheThreads) {
  const Model model = bored_plate();
  const PointCloud cloud = cloud_of(model);
  const PrimitiveSet given = all_shaken(model.primitives, 6);
  EXPECT_TRUE(are_equal(refine_primitives(cloud, given, *model.tree, {}, {.threads = 1}).primitives,
                        refine_primitives(cloud, given, *model.tree, {}, {.threads = 2}).primitives));
}

TEST(RefinePrimitives, StopsWhenAsked) {
  const Model model = bored_plate();
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)refine_primitives(cloud_of(model), model.primitives, *model.tree, {}, {.stop = stop.get_token()}),
               Cancelled);
}

TEST(RefinePrimitives, RefusesOptionsByName) {
  const auto refused = [](const RefineOptions& options) {
    try {
      validate(options);
    } catch (const Error& error) {
      return error.parts().where;
    }
    return std::string();
  };
  EXPECT_EQ(refused({}), "");
  EXPECT_EQ(refused({.noise = 0}), "noise");
  EXPECT_EQ(refused({.angle_tolerance_deg = 91}), "angle_tolerance_deg");
  EXPECT_EQ(refused({.rounds = 0}), "rounds");
  EXPECT_EQ(refused({.most_points = 5}), "most_points");
  EXPECT_EQ(refused({.regularity_angle_deg = -1}), "regularity_angle_deg");
}

/// Reading the slots of what was made from slots gives these slots, in any frame.
RC_GTEST_PROP(Slots, SayWhereTheSolidIs, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint64_t>());
  const Primitive solid{.id = "solid", .shape = test::random_shape(random), .pose = test::random_pose(random)};
  const LocalFrame frame{.orientation = solid.pose.orientation, .origin = test::random_within(1, random)};
  std::vector<double> values;
  for (const Slot& slot : slots_of(solid, frame)) values.push_back(slot.value);
  const auto same = with_slots(solid, frame, values);
  RC_ASSERT(same.has_value());
  Points points;
  for (int i = 0; i < 20; ++i) points.push_back(test::random_within(2, random));
  const std::vector<double> expected = signed_distance(solid, points);
  const std::vector<double> found = signed_distance(*same, points);
  for (std::size_t i = 0; i < points.size(); ++i) RC_ASSERT(std::abs(found[i] - expected[i]) < 1e-9);
  const std::vector<Slot> again = slots_of(*same, frame);
  for (std::size_t k = 0; k < values.size(); ++k) RC_ASSERT(std::abs(again[k].value - values[k]) < 1e-9);
}

}  // namespace
}  // namespace cloud2csg
