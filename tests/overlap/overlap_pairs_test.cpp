#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numbers>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "overlap/random_solids.hpp"

namespace cloud2csg {
namespace {

using test::random_convex;
using test::random_direction;
using test::random_orientation;
using test::random_solid;

Primitive make(const Shape& shape, const Eigen::Vector3d& position = Eigen::Vector3d::Zero()) {
  return {.id = "p", .shape = shape, .pose = {.position = position}};
}

bool overlap(const Primitive& a, const Primitive& b, double tolerance = 1e-6) {
  const bool forward = build_overlap_graph({a, b}, {.tolerance = tolerance}).has_edge(0, 1);
  EXPECT_EQ(forward, build_overlap_graph({b, a}, {.tolerance = tolerance}).has_edge(0, 1)) << "not symmetric";
  return forward;
}

/// Moves b so that the distance of the two convex solids is `gap`, along `direction`.
Primitive in_contact(const Primitive& a, Primitive b, const Eigen::Vector3d& direction, double gap) {
  b.pose.position += support(a, direction) + gap * direction - support(b, -direction);
  return b;
}

/// The smallest max(f_a, f_b) over a grid, and how far a point can be from the nearest one of the grid.
struct GridSearch {
  double smallest = std::numeric_limits<double>::infinity();
  double reach = 0;
};

GridSearch search_common_bounds(const Primitive& a, const Primitive& b, int steps) {
  GridSearch result;
  const AlignedBox region = bounds(a).intersection(bounds(b));
  if (region.isEmpty()) return result;
  const Eigen::Array3d step = region.sizes().array() / steps;
  Points points;
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < steps; ++j) {
      for (int k = 0; k < steps; ++k) {
        points.push_back(region.min() + (step * Eigen::Array3d(i + 0.5, j + 0.5, k + 0.5)).matrix());
      }
    }
  }
  const std::vector<double> f_a = signed_distance(a, points);
  const std::vector<double> f_b = signed_distance(b, points);
  for (std::size_t i = 0; i < points.size(); ++i) result.smallest = std::min(result.smallest, std::max(f_a[i], f_b[i]));
  result.reach = step.matrix().norm() / 2;
  return result;
}

RC_GTEST_PROP(OverlapPairs, AgreeWithSampling, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint64_t>());
  const Primitive a = random_solid(random);
  const Primitive b = random_solid(random);
  const GridSearch found = search_common_bounds(a, b, 24);
  const bool proven_apart = found.smallest > found.reach + 1e-6 && is_plain(a) && is_plain(b);
  RC_CLASSIFY(found.smallest < 0, "overlap");
  RC_CLASSIFY(proven_apart, "apart");
  if (found.smallest < 0) RC_ASSERT(overlap(a, b));
  if (proven_apart) RC_ASSERT(!overlap(a, b));
}

RC_GTEST_PROP(OverlapPairs, ConvexSolidsInContactDecideByTheTolerance, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint64_t>());
  const double tolerance = std::pow(10.0, random.uniform(-6, -2));
  const Primitive a = random_convex(random);
  const Primitive b = random_convex(random);
  const Eigen::Vector3d direction = random_direction(random);
  for (const double gap : {0.0, 0.5, 0.9}) {
    RC_ASSERT(overlap(a, in_contact(a, b, direction, gap * tolerance), tolerance));
  }
  for (const double gap : {1.1, 2.0, 10.0}) {
    RC_ASSERT(!overlap(a, in_contact(a, b, direction, gap * tolerance), tolerance));
  }
}

RC_GTEST_PROP(OverlapPairs, BoxesThatShareAFaceOverlap, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint64_t>());
  const Eigen::Quaterniond orientation = random_orientation(random);
  Primitive a = make(Box{.size = test::random_vector(random, 0.1, 2.0)});
  Primitive b = make(Box{.size = test::random_vector(random, 0.1, 2.0)});
  a.pose.orientation = b.pose.orientation = orientation;
  const Eigen::Vector3d reach = (std::get<Box>(a.shape).size + std::get<Box>(b.shape).size) / 2;
  Eigen::Vector3d offset = reach.cwiseProduct(test::random_vector(random, -0.95, 0.95));
  // Face, edge or corner contact, by how many axes are at their limit.
  const std::uint32_t contacts = 1 + random.below(3);
  for (std::uint32_t axis = 0; axis < contacts; ++axis) offset[axis] = random.chance(0.5) ? reach[axis] : -reach[axis];
  b.pose.position = orientation * offset;
  RC_ASSERT(overlap(a, b));
  offset[0] += offset[0] > 0 ? 3e-6 : -3e-6;
  b.pose.position = orientation * offset;
  RC_ASSERT(!overlap(a, b));
}

RC_GTEST_PROP(OverlapPairs, OneSolidInsideAnotherOverlapsIt, ()) {
  RandomStream random(*rc::gen::arbitrary<std::uint64_t>());
  const Primitive outer = test::placed(Sphere{.radius = 2.0}, random);
  Primitive inner = random_solid(random);
  inner.pose.position = outer.pose.position + 0.3 * random_direction(random);
  inner.displacement.reset();
  RC_ASSERT(overlap(outer, inner));
}

TEST(OverlapPairs, ConcentricSolidsOverlap) {
  EXPECT_TRUE(overlap(make(Box{.size = {1, 1, 1}}), make(Box{.size = {0.1, 0.1, 0.1}})));
  EXPECT_TRUE(overlap(make(Cylinder{.radius = 1, .height = 1}), make(Cylinder{.radius = 0.5, .height = 2})));
  EXPECT_TRUE(overlap(make(Sphere{.radius = 1}), make(Sphere{.radius = 1})));
  EXPECT_TRUE(overlap(make(Torus{.major_radius = 1, .minor_radius = 0.3}),
                      make(Torus{.major_radius = 1, .minor_radius = 0.1})));
}

TEST(OverlapPairs, BoundsThatMeetAreNotEnough) {
  const double off = 0.9 / std::numbers::sqrt2 + 0.01;  // corner to corner: the bounds overlap, the spheres do not
  EXPECT_FALSE(overlap(make(Sphere{.radius = 0.45}), make(Sphere{.radius = 0.45}, {off, off, 0})));
  Primitive turned = make(Box{.size = {1, 1, 1}}, {1.1, 1.1, 0});
  turned.pose.orientation = Eigen::AngleAxisd(std::numbers::pi / 4, Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(overlap(make(Box{.size = {1, 1, 1}}), turned));
}

TEST(OverlapPairs, HoleOfATorusIsEmpty) {
  const Primitive torus = make(Torus{.major_radius = 1, .minor_radius = 0.25});
  EXPECT_FALSE(overlap(torus, make(Sphere{.radius = 0.7})));
  EXPECT_TRUE(overlap(torus, make(Sphere{.radius = 0.75})));
  EXPECT_TRUE(overlap(torus, make(Sphere{.radius = 0.8})));
  EXPECT_FALSE(overlap(torus, make(Cylinder{.radius = 0.6, .height = 3})));
  Primitive link = make(Torus{.major_radius = 1, .minor_radius = 0.25}, {1, 0, 0});
  link.pose.orientation = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX());
  EXPECT_FALSE(overlap(torus, link));
}

TEST(OverlapPairs, TorusTouchesFromOutside) {
  const Primitive torus = make(Torus{.major_radius = 1, .minor_radius = 0.25});
  for (const double gap : {0.0, 0.9e-6}) {
    EXPECT_TRUE(overlap(torus, make(Sphere{.radius = 0.5}, {1.75 + gap, 0, 0})));
    EXPECT_TRUE(overlap(torus, make(Box{.size = {1, 1, 1}}, {1.2, 0.1, 0.75 + gap})));
  }
  EXPECT_FALSE(overlap(torus, make(Sphere{.radius = 0.5}, {1.77, 0, 0})));
  EXPECT_TRUE(overlap(torus, make(Sphere{.radius = 0.5}, {1.77, 0, 0}), 0.021));
  EXPECT_FALSE(overlap(torus, make(Box{.size = {1, 1, 1}}, {1.2, 0.1, 0.77})));
}

TEST(OverlapPairs, DisplacementMovesTheSurface) {
  // At (0.5, 0.3, -0.3) the sine term is negative: the box bulges by sin(1) sin(0.6)^2 = 0.27 there.
  Primitive box = make(Box{.size = {1, 1, 1}});
  const Primitive ball = make(Sphere{.radius = 0.05}, {0.6, 0.3, -0.3});
  EXPECT_FALSE(overlap(box, ball));
  box.displacement = Displacement{.frequency = 2};
  EXPECT_TRUE(overlap(box, ball));
  EXPECT_FALSE(overlap(box, make(Sphere{.radius = 0.05}, {0.6, 0.3, 0.3})));
}

TEST(OverlapPairs, ExpressionNeedNotBeADistance) {
  const Primitive ball = make(Expression{
      .distance = "100 * (x^2 + y^2 + z^2 - 1)",
      .bounds = {Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1)},
  });
  EXPECT_TRUE(overlap(ball, make(Sphere{.radius = 0.5}, {1.4, 0, 0})));
  EXPECT_TRUE(overlap(ball, make(Sphere{.radius = 0.1})));
  EXPECT_FALSE(overlap(ball, make(Box{.size = {1, 1, 1}}, {1.2, 1.2, 1.2})));
}

TEST(OverlapPairs, HalfSpaceWithBoundedSolids) {
  const Primitive ground = make(HalfSpace{});  // z <= 0
  EXPECT_TRUE(overlap(ground, make(Box{.size = {1, 1, 1}}, {100, 100, -1000})));
  EXPECT_TRUE(overlap(ground, make(Box{.size = {1, 1, 1}}, {5, 5, 0.5})));
  EXPECT_FALSE(overlap(ground, make(Box{.size = {1, 1, 1}}, {5, 5, 0.51})));
  EXPECT_TRUE(overlap(ground, make(Box{.size = {1, 1, 1}}, {5, 5, 0.51}), 0.02));
  EXPECT_TRUE(overlap(ground, make(Torus{.major_radius = 1, .minor_radius = 0.25}, {0, 0, 0.2})));
  EXPECT_FALSE(overlap(ground, make(Torus{.major_radius = 1, .minor_radius = 0.25}, {0, 0, 0.3})));
}

TEST(OverlapPairs, HalfSpacesMeetUnlessOppositeAndApart) {
  const Primitive below = make(HalfSpace{});
  const auto above = [](double height, const Eigen::Vector3d& normal) {
    return Primitive{.id = "h", .shape = HalfSpace{}, .pose = pose_from_axis({0, 0, height}, normal)};
  };
  EXPECT_FALSE(overlap(below, above(0.1, {0, 0, -1})));
  EXPECT_TRUE(overlap(below, above(0.0, {0, 0, -1})));
  EXPECT_TRUE(overlap(below, above(-0.1, {0, 0, -1})));
  EXPECT_TRUE(overlap(below, above(0.1, {0, 0, 1})));
  EXPECT_TRUE(overlap(below, above(0.1, {0, 0.01, -1})));
}

}  // namespace
}  // namespace cloud2csg
