#include "raw/solids/simplest_solid.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.hpp"
#include "support/any_profile.hpp"
#include "support/known_solids.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

/// The simplest solid, after a check that it is the same solid.
Shape simplest_shape(const Shape& shape) {
  RandomStream random(7);
  const Primitive solid{.id = "solid", .shape = shape, .pose = test::random_pose(random)};
  const Primitive simple = simplest(solid);
  validate(simple);
  const AlignedBox box = bounds(solid);
  Points points;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d share(random.uniform(-0.1, 1.1), random.uniform(-0.1, 1.1), random.uniform(-0.1, 1.1));
    points.push_back(box.min() + share.cwiseProduct(box.sizes()));
  }
  const std::vector<double> before = signed_distance(solid, points);
  const std::vector<double> after = signed_distance(simple, points);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_TRUE((before[i] < 0) == (after[i] < 0) || std::abs(before[i]) < 1e-6) << points[i].transpose();
  }
  return simple.shape;
}

Plane plane(const Vector3d& normal, double offset) {
  return {.normal = normal.normalized(), .offset = offset};
}

/// A prism over a regular polygon around (0.3, 0.2), from z = -0.5 to 1.
Polytope prism(int sides) {
  Polytope polytope{.planes = {plane({0, 0, 1}, 1), plane({0, 0, -1}, 0.5)}};
  for (int k = 0; k < sides; ++k) {
    const double angle = 0.4 + 2 * std::acos(-1) * k / sides;
    const Vector3d normal(std::cos(angle), std::sin(angle), 0);
    polytope.planes.push_back(plane(normal, 1 + normal.dot(Vector3d(0.3, 0.2, 0))));
  }
  return polytope;
}

TEST(Simplest, SweptShapesBecomeWhatTheyAre) {
  const auto extruded = [](const ClosedPath& path) { return Extrusion{.profile = {.paths = {path}}, .height = 2}; };
  const auto turned = [](const ClosedPath& path) { return Revolution{{.paths = {path}}}; };
  EXPECT_TRUE(std::holds_alternative<Box>(simplest_shape(extruded(test::regular_path(4, 1)))));
  EXPECT_TRUE(std::holds_alternative<Extrusion>(simplest_shape(extruded(test::regular_path(5, 1)))));
  EXPECT_TRUE(std::holds_alternative<Cylinder>(simplest_shape(extruded(test::circle_path({1, 2}, 0.5)))));
  EXPECT_TRUE(std::holds_alternative<Torus>(simplest_shape(turned(test::circle_path({2, 1}, 0.5)))));
  EXPECT_TRUE(std::holds_alternative<Cylinder>(
      simplest_shape(turned({{.point = {0, 0}}, {.point = {1, 0}}, {.point = {1, 2}}, {.point = {0, 2}}}))));
  EXPECT_TRUE(
      std::holds_alternative<Cone>(simplest_shape(turned({{.point = {0, 0}}, {.point = {1, 0}}, {.point = {0, 2}}}))));
  EXPECT_TRUE(
      std::holds_alternative<Sphere>(simplest_shape(turned({{.point = {0, -1}, .bulge = 1}, {.point = {0, 1}}}))));
  EXPECT_TRUE(std::holds_alternative<Revolution>(
      simplest_shape(turned({{.point = {0, -1}, .bulge = 0.5}, {.point = {0, 1}}}))));
}

TEST(Simplest, PrismsBecomeExtrusions) {
  EXPECT_TRUE(std::holds_alternative<Box>(simplest_shape(prism(4))));
  for (const int sides : {3, 5, 6, 9}) {
    const Shape shape = simplest_shape(prism(sides));
    ASSERT_TRUE(std::holds_alternative<Extrusion>(shape));
    EXPECT_EQ(std::get<Extrusion>(shape).profile.paths.at(0).size(), static_cast<std::size_t>(sides));
  }
}

TEST(Simplest, OtherPolytopesStay) {
  Polytope oblique = prism(5);
  oblique.planes[0] = plane({0.1, 0, 1}, 1);
  EXPECT_TRUE(std::holds_alternative<Polytope>(simplest_shape(oblique)));
  Polytope cut = prism(5);
  cut.planes.push_back(plane({1, 1, 1}, 1));
  EXPECT_TRUE(std::holds_alternative<Polytope>(simplest_shape(cut)));
}

}  // namespace
}  // namespace cloud2csg
