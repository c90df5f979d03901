#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <string>

#include "cloud2csg/error.hpp"
#include "cloud2csg/primitive.hpp"
#include "primitive/random_primitives.hpp"
#include "support/any_profile.hpp"

namespace cloud2csg {
namespace {

constexpr double k_infinity = std::numeric_limits<double>::infinity();
constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

/// The field that validate() refuses, or "" when it takes the solid.
std::string refused_field(const Primitive& primitive) {
  try {
    validate(primitive);
  } catch (const Error& error) {
    EXPECT_FALSE(error.parts().expected.empty());
    return error.parts().where;
  }
  return "";
}

std::string refused_field(const Shape& shape) {
  return refused_field(Primitive{.id = "p", .shape = shape});
}

Expression formula(const std::string& text) {
  return {.distance = text, .bounds = AlignedBox(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1))};
}

Polytope cube() {
  Polytope polytope;
  for (int axis = 0; axis < 3; ++axis) {
    polytope.planes.push_back({Eigen::Vector3d::Unit(axis), 1});
    polytope.planes.push_back({-Eigen::Vector3d::Unit(axis), 1});
  }
  return polytope;
}

RC_GTEST_PROP(Validate, TakesEveryGoodSolid, ()) {
  RC_ASSERT(refused_field(testing::any_primitive()).empty());
}

TEST(Validate, RefusesLengthsThatAreNotPositive) {
  for (const double bad : {0.0, -1.0, k_infinity, k_nan}) {
    EXPECT_EQ(refused_field(Box{{1, bad, 1}}), "size");
    EXPECT_EQ(refused_field(Sphere{bad}), "radius");
    EXPECT_EQ(refused_field(Cylinder{bad, 1}), "radius");
    EXPECT_EQ(refused_field(Cylinder{1, bad}), "height");
    EXPECT_EQ(refused_field(Cone{1, 1, bad}), "height");
    EXPECT_EQ(refused_field(Torus{bad, 1}), "major_radius");
    EXPECT_EQ(refused_field(Torus{1, bad}), "minor_radius");
    const Primitive displaced{.id = "p", .shape = Sphere{1}, .displacement = Displacement{bad}};
    EXPECT_EQ(refused_field(displaced), "displacement/frequency");
  }
}

TEST(Validate, TakesAConeWithATipButNotWithTwo) {
  EXPECT_EQ(refused_field(Cone{1, 0, 1}), "");
  EXPECT_EQ(refused_field(Cone{0, 1, 1}), "");
  EXPECT_EQ(refused_field(Cone{0, 0, 1}), "radius_bottom");
  EXPECT_EQ(refused_field(Cone{-1, 1, 1}), "radius_bottom");
  EXPECT_EQ(refused_field(Cone{1, k_nan, 1}), "radius_top");
}

TEST(Validate, RefusesATorusThatCrossesItself) {
  EXPECT_EQ(refused_field(Torus{1, 1}), "");
  EXPECT_EQ(refused_field(Torus{1, 1.001}), "minor_radius");
}

TEST(Validate, RefusesPolytopesWithoutVolumeOrEnd) {
  EXPECT_EQ(refused_field(cube()), "");

  Polytope open = cube();
  open.planes.pop_back();
  EXPECT_EQ(refused_field(open), "planes");
  EXPECT_EQ(refused_field(Polytope{}), "planes");

  Polytope slab = cube();  // open along z, though every normal has its opposite
  slab.planes.resize(4);
  EXPECT_EQ(refused_field(slab), "planes");

  Polytope empty = cube();
  empty.planes[0].offset = -2;
  EXPECT_EQ(refused_field(empty), "planes");

  Polytope flat = cube();
  flat.planes[0].offset = -1;
  EXPECT_EQ(refused_field(flat), "planes");
}

TEST(Validate, RefusesPlanesThatAreNotNormalised) {
  Polytope scaled = cube();
  scaled.planes[3].normal *= 2;
  EXPECT_EQ(refused_field(scaled), "planes/3");
  Polytope infinite = cube();
  infinite.planes[5].offset = k_infinity;
  EXPECT_EQ(refused_field(infinite), "planes/5");
}

TEST(Validate, TakesAPolytopeFarFromItsOrigin) {
  Polytope far = cube();
  for (Plane& plane : far.planes) plane.offset += plane.normal.dot(Eigen::Vector3d(1000, -2000, 500));
  EXPECT_EQ(refused_field(far), "");
  EXPECT_EQ(corners(far).size(), 8U);
}

Extrusion plate(const std::vector<ClosedPath>& paths) {
  return {.profile = {paths}, .height = 1};
}

ClosedPath square(double low, double high) {
  return {{.point = {low, low}}, {.point = {high, low}}, {.point = {high, high}}, {.point = {low, high}}};
}

TEST(Validate, TakesPathsOfLinesAndArcs) {
  EXPECT_EQ(refused_field(plate({square(0, 3)})), "");
  EXPECT_EQ(refused_field(plate({square(3, 0)})), "") << "in the other direction";
  EXPECT_EQ(refused_field(plate({test::circle_path({1, 1}, 1)})), "");
  EXPECT_EQ(refused_field(plate({square(0, 3), square(1, 2)})), "");
  EXPECT_EQ(refused_field(plate({square(0, 3), square(4, 5)})), "");
  ClosedPath slot = square(0, 3);
  slot[1].bulge = slot[3].bulge = 1;
  EXPECT_EQ(refused_field(plate({slot})), "");
  EXPECT_EQ(refused_field(plate({{{.point = {0, 0}, .bulge = 0.5}, {.point = {1, 0}}}})), "") << "an arc and its chord";
}

TEST(Validate, NamesTheSegmentThatCrossesOrTouchesAnother) {
  EXPECT_EQ(refused_field(plate({})), "profile");
  EXPECT_EQ(refused_field(plate({{}})), "profile/0");
  EXPECT_EQ(refused_field(plate({square(0, 3), {{.point = {1, 1}}}})), "profile/1");
  EXPECT_EQ(refused_field(plate({{{.point = {0, 0}}, {.point = {1, 0}}}})), "profile/0/1") << "back on itself";
  EXPECT_EQ(refused_field(plate({{{.point = {0, 0}, .bulge = 1}, {.point = {1, 0}, .bulge = -1}}})), "profile/0/1");
  const ClosedPath bow{{.point = {0, 0}}, {.point = {1, 1}}, {.point = {1, 0}}, {.point = {0, 1}}};
  EXPECT_EQ(refused_field(plate({bow})), "profile/0/2");
  ClosedPath bulging = square(0, 3);
  bulging[0].bulge = -1.9;  // out through the sides
  EXPECT_EQ(refused_field(plate({bulging})), "profile/0/1");
  EXPECT_EQ(refused_field(plate({square(0, 3), square(2, 5)})), "profile/1/0");
  EXPECT_EQ(refused_field(plate({square(0, 3), square(3, 5)})), "profile/1/0") << "a common corner";
  EXPECT_EQ(refused_field(plate({square(0, 3), test::circle_path({1, 1}, 1)})), "profile/1/0") << "tangent";
  ClosedPath repeated = square(0, 3);
  repeated[2] = repeated[1];
  EXPECT_EQ(refused_field(plate({repeated})), "profile/0/1");
  ClosedPath endless = square(0, 3);
  endless[2].bulge = k_nan;
  EXPECT_EQ(refused_field(plate({endless})), "profile/0/2");
  ClosedPath full = square(0, 3);
  full[2].bulge = 1e10;
  EXPECT_EQ(refused_field(plate({full})), "profile/0/2");
  EXPECT_EQ(refused_field(Extrusion{.profile = {{square(0, 3)}}, .height = 0}), "height");
}

TEST(Validate, TakesProfilesOnOneSideOfTheAxisOnly) {
  EXPECT_EQ(refused_field(Revolution{{{square(0, 3)}}}), "");
  EXPECT_EQ(refused_field(Revolution{{{{{.point = {0, -1}, .bulge = 1}, {.point = {0, 1}}}}}}), "") << "a ball";
  EXPECT_EQ(refused_field(Revolution{{{{{.point = {0, -1}, .bulge = 0.5}, {.point = {0, 1}}}}}}), "") << "a lemon";
  EXPECT_EQ(refused_field(Revolution{{{square(-0.1, 3)}}}), "profile/0/0");
  EXPECT_EQ(refused_field(Revolution{{{test::circle_path({1, 0}, 1.001)}}}), "profile/0/0");
  EXPECT_EQ(refused_field(Revolution{{{test::circle_path({1, 0}, 1)}}}), "profile/0/0") << "touches the axis";
  const ClosedPath tip{{.point = {0, 0}}, {.point = {1, -1}}, {.point = {1, 1}}};
  EXPECT_EQ(refused_field(Revolution{{{tip}}}), "profile/0/0") << "touches the axis";
}

TEST(Validate, RefusesSectorsOfNoOrMoreThanAFullTurn) {
  for (const double angle : {0.0, -90.0, 360.001, k_nan}) {
    EXPECT_EQ(refused_field(Revolution{{{square(0, 3)}}, angle}), "angle_deg") << angle;
  }
  EXPECT_EQ(refused_field(Revolution{{{square(0, 3)}}, 0.001}), "");
}

TEST(Validate, RefusesFormulasThatAreNotOfXYZ) {
  EXPECT_EQ(refused_field(formula("x^2 + y^2 + z^2 - 1")), "");
  EXPECT_EQ(refused_field(formula("(x <= 0.5) ? x : 2 * x - 0.5")), "");
  for (const char* bad : {"", "x +", "x + w", "f(x)", "x = 2", "x, y", "\"text\"", "((x)"}) {
    EXPECT_EQ(refused_field(formula(bad)), "distance") << bad;
  }
  EXPECT_EQ(refused_field(formula("sqrt(x)")), "distance") << "no value where x is negative";
}

TEST(Validate, RefusesBoundsThatEncloseNothing) {
  Expression expression = formula("x");
  expression.bounds.max().y() = k_infinity;
  EXPECT_EQ(refused_field(expression), "bounds");
  expression.bounds.max().y() = -1;
  EXPECT_EQ(refused_field(expression), "bounds");
  expression.bounds = AlignedBox();
  EXPECT_EQ(refused_field(expression), "bounds");
}

TEST(Validate, RefusesPosesThatAreNotRigid) {
  Primitive primitive{.id = "p", .shape = Sphere{1}};
  primitive.pose.position.z() = k_nan;
  EXPECT_EQ(refused_field(primitive), "pose/position");
  primitive.pose = {.position = {1, 2, 3}, .orientation = {1, 0.01, 0, 0}};
  EXPECT_EQ(refused_field(primitive), "pose/quaternion");
  primitive.pose.orientation = {k_nan, 0, 0, 0};
  EXPECT_EQ(refused_field(primitive), "pose/quaternion");
  primitive.pose.orientation = {1 + 5e-7, 0, 0, 0};
  EXPECT_EQ(refused_field(primitive), "");
}

}  // namespace
}  // namespace cloud2csg
