#include <gtest/gtest.h>

#include "cloud2csg/primitive.hpp"
#include "support/any_profile.hpp"

namespace cloud2csg {
namespace {

double price_of_shape(const Shape& shape) {
  return price_of({.id = "p", .shape = shape});
}

TEST(Price, IsThatOfABoxForWhatIsAsSimple) {
  EXPECT_EQ(price_of_shape(Box{{1, 2, 3}}), 1);
  EXPECT_EQ(price_of_shape(Torus{.major_radius = 2, .minor_radius = 1}), 1);
  EXPECT_EQ(price_of_shape(Extrusion{.profile = {.paths = {test::regular_path(4, 1)}}, .height = 1}), 1);
  EXPECT_EQ(price_of_shape(Revolution{{.paths = {test::circle_path({3, 0}, 1)}}}), 1);
}

TEST(Price, CountsSegmentsBeyondTheFourth) {
  EXPECT_NEAR(price_of_shape(Extrusion{.profile = {.paths = {test::regular_path(10, 1)}}, .height = 1}), 1.6, 1e-12);
  const Profile with_bores{
      .paths = {test::regular_path(4, 5), test::circle_path({1, 0}, 0.5), test::circle_path({-1, 0}, 0.5)}};
  EXPECT_NEAR(price_of_shape(Extrusion{.profile = with_bores, .height = 1}), 1.2, 1e-12) << "a circle is one segment";
  EXPECT_NEAR(
      price_of_shape(Revolution{
          {.paths =
               {{{.point = {0, 0}}, {.point = {1, 0}}, {.point = {2, 1}}, {.point = {1, 2}}, {.point = {0, 2}}}}}}),
      1.1, 1e-12);
}

TEST(Price, CountsPlanesBeyondTheSixth) {
  Polytope polytope;
  for (int k = 0; k < 9; ++k) polytope.planes.push_back({.normal = Eigen::Vector3d::UnitZ(), .offset = 1.0 * k});
  EXPECT_NEAR(price_of_shape(polytope), 1.6, 1e-12);
}

}  // namespace
}  // namespace cloud2csg
