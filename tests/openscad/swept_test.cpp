#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"
#include "cloud2csg/export.hpp"
#include "cloud2csg/model.hpp"
#include "core/base/random.hpp"
#include "core/primitive/profile.hpp"
#include "openscad/refusal.hpp"
#include "support/any_profile.hpp"
#include "support/random_scene.hpp"

/// Extrusions and revolutions in OpenSCAD files.
namespace cloud2csg {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const Profile& profile_of(const Primitive& primitive) {
  return *profile_of(primitive.shape);
}

void expect_same_path(const std::vector<ProfileSegment>& expected, const std::vector<ProfileSegment>& found) {
  constexpr double k_digits = 1e-9;  // files have ten
  if (is_circle(expected)) {
    ASSERT_TRUE(is_circle(found));
    EXPECT_LT((expected[0].centre - found[0].centre).norm(), k_digits);
    EXPECT_NEAR(expected[0].radius, found[0].radius, k_digits);
    return;
  }
  ASSERT_EQ(expected.size(), found.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_LT((expected[i].start - found[i].start).norm(), k_digits);
    EXPECT_NEAR(expected[i].bulge, found[i].bulge, k_digits);
  }
}

void expect_same_profile(const Profile& expected, const Profile& found) {
  const std::vector<ProfileRegion> left = regions_of(expected);
  const std::vector<ProfileRegion> right = regions_of(found);
  ASSERT_EQ(left.size(), right.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    expect_same_path(left[i].outline, right[i].outline);
    ASSERT_EQ(left[i].holes.size(), right[i].holes.size());
    for (std::size_t k = 0; k < left[i].holes.size(); ++k) expect_same_path(left[i].holes[k], right[i].holes[k]);
  }
}

void move_paths(Profile& profile, const Vector2d& by) {
  for (ClosedPath& path : profile.paths) {
    for (PathCorner& corner : path) corner.point += by;
  }
}

/// Up to three stars with or without holes, next to each other, and an island in a hole.
Profile parts(RandomStream& random) {
  const auto draw = [&random](double low, double high) { return random.uniform(low, high); };
  Profile all;
  for (std::size_t count = 1 + random.below(3); count > 0; --count) {
    Profile part = test::any_profile(draw);
    move_paths(part, Vector2d(-bounds_of(part).min().x(), draw(-1, 1)));
    const double right = all.paths.empty() ? 0.5 : bounds_of(all).max().x() + 0.1;
    move_paths(part, Vector2d(right, 0));
    all.paths.insert(all.paths.end(), part.paths.begin(), part.paths.end());
    if (part.paths.size() > 1) {
      const ProfileSegment hole = segments_of(part.paths[1]).front();
      all.paths.push_back(test::circle_path(hole.centre, 0.5 * hole.radius));
    }
  }
  return all;
}

TEST(OpenScadSweep, OurFilesComeBackWithTheirProfiles) {
  int arcs = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomStream random(seed);
    const Profile profile = parts(random);
    Primitive primitive{.id = "part", .shape = Revolution{profile}, .pose = test::random_pose(random)};
    if (random.chance(0.5)) std::get<Revolution>(primitive.shape).angle_deg = random.uniform(1, 359);
    if (random.chance(0.5)) primitive.shape = Extrusion{.profile = profile, .height = random.uniform(0.1, 2)};
    const std::string text = to_openscad({.primitives = {primitive}, .tree = CsgTree::leaf(0)});
    SCOPED_TRACE(text);
    if (text.find("path(part_") != std::string::npos) ++arcs;
    const Model again = parse_openscad(text);
    ASSERT_EQ(again.primitives.size(), 1U);
    ASSERT_EQ(leaf_count(*again.tree), 1U);
    const Primitive& found = again.primitives[0];
    if (std::holds_alternative<Torus>(found.shape)) continue;  // a single circle beside the axis
    EXPECT_EQ(found.id, "part");
    ASSERT_EQ(found.shape.index(), primitive.shape.index());
    expect_same_profile(profile, profile_of(found));
    Points places;
    for (int i = 0; i < 100; ++i) places.push_back(primitive.pose.position + test::random_within(3, random));
    const std::vector<double> left = signed_distance(primitive, places);
    const std::vector<double> right = signed_distance(found, places);
    for (std::size_t i = 0; i < left.size(); ++i) ASSERT_NEAR(left[i], right[i], 1e-7);
  }
  EXPECT_GT(arcs, 50);
}

TEST(OpenScadSweep, RandomRevolutionsAtTheAxisComeBack) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    RandomStream random(seed);
    const Revolution solid = test::any_revolution([&](double low, double high) { return random.uniform(low, high); });
    const std::string text = to_openscad({.primitives = {{.id = "knob", .shape = solid}}, .tree = CsgTree::leaf(0)});
    SCOPED_TRACE(text);
    const Model again = parse_openscad(text);
    ASSERT_EQ(again.primitives.size(), 1U);
    expect_same_profile(solid.profile, profile_of(again.primitives[0]));
    EXPECT_NEAR(std::get<Revolution>(again.primitives[0].shape).angle_deg, solid.angle_deg, 1e-6);
  }
}

TEST(OpenScadSweep, OurFlatFilesComeBackWithTheirHolesAndParts) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    RandomStream random(seed);
    const Profile profile = parts(random);
    Primitive primitive{.id = "part", .shape = Revolution{profile}, .pose = test::random_pose(random)};
    if (random.chance(0.5)) std::get<Revolution>(primitive.shape).angle_deg = random.uniform(1, 359);
    if (random.chance(0.5)) primitive.shape = Extrusion{.profile = profile, .height = 1};
    const std::string text = to_openscad_csg({.primitives = {primitive}, .tree = CsgTree::leaf(0)});
    SCOPED_TRACE(text);
    const Model again = parse_openscad(text);
    ASSERT_EQ(again.primitives.size(), 1U);
    ASSERT_EQ(leaf_count(*again.tree), 1U);
    if (std::holds_alternative<Torus>(again.primitives[0].shape)) continue;
    // Arcs are polygons there, of 64 corners and more in a full circle.
    EXPECT_NEAR(area_of(profile), area_of(profile_of(again.primitives[0])), 0.02 * area_of(profile));
    EXPECT_EQ(regions_of(profile).size(), regions_of(profile_of(again.primitives[0])).size());
  }
}

/// Compares with a formula of the flat region, extruded by 2 from z = 0, and turned.
void expect_region(const std::string& shapes, const std::function<bool(double, double)>& contains, std::size_t solids) {
  SCOPED_TRACE(shapes);
  const Model extruded = parse_openscad("linear_extrude(height = 2) {" + shapes + "}");
  const Model turned = parse_openscad("rotate_extrude() {" + shapes + "}");
  EXPECT_EQ(extruded.primitives.size(), solids);
  EXPECT_EQ(turned.primitives.size(), solids);
  Points upright;
  Points around;
  std::vector<bool> expected;
  for (double x = 0.013; x < 8; x += 0.21) {
    for (double y = -4.017; y < 4; y += 0.21) {
      for (const double z : {-0.1, 0.1, 1.9, 2.1}) {
        upright.push_back({x, y, z});
        around.push_back({x * std::cos(z), x * std::sin(z), y});
        expected.push_back(contains(x, y));
      }
    }
  }
  const std::vector<double> in_extruded = implicit_value(*extruded.tree, extruded.primitives, upright);
  const std::vector<double> in_turned = implicit_value(*turned.tree, turned.primitives, around);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const bool is_between = upright[i].z() > 0 && upright[i].z() < 2;
    ASSERT_EQ(in_extruded[i] < 0, expected[i] && is_between) << upright[i].transpose();
    ASSERT_EQ(in_turned[i] < 0, expected[i]) << upright[i].transpose();
  }
}

TEST(OpenScadSweep, FlatShapesAreWhereOpenScadDrawsThem) {
  const auto in_disc = [](double x, double y, double cx, double cy, double r) {
    return std::hypot(x - cx, y - cy) < r;
  };
  const auto in_box = [](double x, double y, double x0, double x1, double y0, double y1) {
    return x > x0 && x < x1 && y > y0 && y < y1;
  };
  expect_region(
      "square([3, 2]);", [&](double x, double y) { return in_box(x, y, 0, 3, 0, 2); }, 1);
  expect_region(
      "translate([4, 1]) square(size = 2, center = true);",
      [&](double x, double y) { return in_box(x, y, 3, 5, 0, 2); }, 1);
  expect_region(
      "polygon(points = [[1, 0], [3, 0], [3, 2], [1, 0]], paths = undef, convexity = 1);",
      [](double x, double y) { return x < 3 && y > 0 && y < x - 1; }, 1);
  expect_region(
      "polygon([[0, 0], [4, 0], [4, 4], [0, 4], [1, 1], [3, 1], [3, 3], [1, 3]], [[0, 1, 2, 3], [4, 5, 6, 7]]);",
      [&](double x, double y) { return in_box(x, y, 0, 4, 0, 4) && !in_box(x, y, 1, 3, 1, 3); }, 1);
  expect_region(
      "translate([4, 0]) rotate(90) mirror([1, 0]) translate([2, 1]) square(1);",
      [&](double x, double y) { return in_box(x, y, 2, 3, -3, -2); }, 1);
  expect_region(
      "multmatrix([[2, 1, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) square(1);",
      [](double x, double y) { return y > 0 && y < 1 && x - 1 - y > 0 && x - 1 - y < 2; }, 1);
  expect_region(
      "difference() { translate([4, 0]) scale(2) circle(d = 3); translate([4, 0]) circle(1); }",
      [&](double x, double y) { return in_disc(x, y, 4, 0, 3) && !in_disc(x, y, 4, 0, 1); }, 1);
  expect_region(
      "union() { square(2); translate([4, 0]) circle(r = 1); }",
      [&](double x, double y) { return in_box(x, y, 0, 2, 0, 2) || in_disc(x, y, 4, 0, 1); }, 1);
}

TEST(OpenScadSweep, OperationsThatAreNoProfileStayOperations) {
  const auto in_disc = [](double x, double y, double cx, double r) { return std::hypot(x - cx, y) < r; };
  const auto in_square = [](double x, double y) { return x > 1 && x < 5 && std::abs(y) < 2; };
  const std::string square = "translate([3, 0]) square(4, center = true);";
  expect_region(
      "difference() { " + square + " translate([5, 0]) circle(1); translate([3, 0]) circle(0.5); }",
      [&](double x, double y) { return in_square(x, y) && !in_disc(x, y, 5, 1) && !in_disc(x, y, 3, 0.5); }, 2);
  expect_region(
      "union() { " + square + " translate([5, 0]) circle(1); translate([7, 0]) circle(0.5); }",
      [&](double x, double y) { return in_square(x, y) || in_disc(x, y, 5, 1) || in_disc(x, y, 7, 0.5); }, 2);
  expect_region("union() { " + square + " translate([3, 0]) circle(1); }", in_square, 2);
  expect_region(
      "intersection() { " + square + " translate([5, 0]) circle(2); }",
      [&](double x, double y) { return in_square(x, y) && in_disc(x, y, 5, 2); }, 2);
  expect_region(
      "difference() { translate([3, 0]) circle(1); " + square + " translate([7, 0]) circle(1); }",
      [](double, double) { return false; }, 3);
  expect_region("union() { translate([3, 0]) circle(1); " + square + " }", in_square, 2);
  // What covers the hole of a ring, and what lies in the overlap of two shapes.
  expect_region(
      "difference() { difference() { " + square + " translate([3, 0]) circle(0.5); } translate([3, 0]) circle(1); }",
      [&](double x, double y) { return in_square(x, y) && !in_disc(x, y, 3, 1); }, 2);
  expect_region(
      "difference() { union() { " + square + " translate([5, 0]) circle(1); } translate([4.5, 0]) circle(0.3); }",
      [&](double x, double y) { return (in_square(x, y) || in_disc(x, y, 5, 1)) && !in_disc(x, y, 4.5, 0.3); }, 3);
  // A disc in the hole of a ring, and what is taken from both.
  expect_region(
      "difference() { union() { difference() { " + square +
          " translate([3, 0]) circle(1.5); } translate([3, 0]) circle(1); } translate([3, 0]) circle(0.5); }",
      [&](double x, double y) {
        return (in_square(x, y) && !in_disc(x, y, 3, 1.5)) || (in_disc(x, y, 3, 1) && !in_disc(x, y, 3, 0.5));
      },
      1);
}

TEST(OpenScadSweep, SpecialCasesAreAsOpenScadDrawsThem) {
  const auto only = [](const std::string& text) {
    const Model model = parse_openscad(text);
    EXPECT_EQ(model.primitives.size(), 1U) << text;
    return model.primitives.at(0);
  };
  const auto corners_of = [&](const std::string& text) { return profile_of(only(text)).paths.at(0).size(); };
  EXPECT_EQ(corners_of("linear_extrude(5, $fn = 6) circle(3);"), 6U) << "children inherit $fn";
  EXPECT_EQ(corners_of("linear_extrude(5) translate([1, 0], $fn = 6) { circle(3); }"), 6U);
  EXPECT_EQ(corners_of("module disc() { circle(3); } linear_extrude(5, $fn = 5) disc();"), 5U);
  EXPECT_EQ(corners_of("linear_extrude(5, $fn = 6) circle(3, $fn = 64);"), 2U);
  EXPECT_EQ(corners_of("$fn = 6; linear_extrude(5, $fn = 64) circle(3);"), 2U);
  EXPECT_EQ(parse_openscad("linear_extrude(1) { union($fn = 6) { circle(1); } translate([9, 0]) circle(1); }")
                .primitives.at(0)
                .shape.index(),
            Shape(Extrusion{}).index());
  EXPECT_EQ(corners_of("linear_extrude(1) circle(1, $fn = 1);"), 3U);
  EXPECT_EQ(corners_of("linear_extrude(1) polygon([[0, 0], [1, 0], [1, 1]], []);"), 3U);
  EXPECT_EQ(corners_of("linear_extrude(1) polygon([[0, 0], [1, 0], [1, 1]], [[0, 1, 2], []]);"), 3U);
  EXPECT_EQ(corners_of("path = [[0, 0], [1, 0], [1, 1]]; linear_extrude(1) polygon(path);"), 3U);
  EXPECT_EQ(std::get<Extrusion>(only("linear_extrude() square(3);").shape).height, 100);
  EXPECT_EQ(std::get<Extrusion>(only("linear_extrude(center = true, height = 4) square(3);").shape).height, 4);
  EXPECT_EQ(only("rotate_extrude(angle = -400) square(3);").shape.index(), Shape(Revolution{}).index());
  EXPECT_EQ(std::get<Revolution>(only("rotate_extrude(angle = 90) square(3);").shape).angle_deg, 90);
  const auto torus = std::get<Torus>(only("rotate_extrude() { difference() { union() {} translate([20, 0]) circle(5); "
                                          "} translate([10, 0]) circle(3); }")
                                         .shape);
  EXPECT_EQ(torus.major_radius, 10) << "the shape of an operation that came to nothing is none";
  EXPECT_EQ(torus.minor_radius, 3);
}

double distance_at(const Model& model, const Vector3d& place) {
  return implicit_value(*model.tree, model.primitives, test::single(place))[0];
}

void expect_inside(const Model& model, const std::vector<Vector3d>& places) {
  for (const Vector3d& place : places) EXPECT_LT(distance_at(model, place), 0) << place.transpose();
}

void expect_outside(const Model& model, const std::vector<Vector3d>& places) {
  for (const Vector3d& place : places) EXPECT_GT(distance_at(model, place), 0) << place.transpose();
}

TEST(OpenScadSweep, SolidsAreMappedAsOthers) {
  const Model model = parse_openscad(
      "mirror([0, 0, 1]) scale([2, 1, 3]) linear_extrude(1) polygon([[0, 0], [1, 0], [0, 1]]);"
      "translate([9, 0, 0]) scale(2) linear_extrude(height = 1, center = true) polygon([[0, 0], [1, 0], [0, 1]]);");
  expect_inside(model, {{1.9, 0.01, -2.9}, {9.1, 1.8, 0.9}});
  expect_outside(model, {{1.9, 0.01, 0.1}, {0.1, 1.01, -1}});
  EXPECT_NE(test::refusal("scale([1, 2, 1]) linear_extrude(1) circle(1);").find("keeps round solids round"),
            std::string::npos);
  const Model sheared = parse_openscad("translate([1, 0, 0]) scale([2, 1, 1]) rotate(45) linear_extrude(1) square(1);");
  EXPECT_EQ(sheared.primitives.size(), 1U);
  expect_inside(sheared, {{1, 1.4, 0.5}, {2.3, 0.7, 0.5}, {-0.3, 0.7, 0.5}});
  expect_outside(sheared, {{2.3, 0.7, 1.1}, {2.3, 1.1, 0.5}});
  EXPECT_NE(test::refusal("scale([2, 1, 1]) rotate([0, 45, 0]) linear_extrude(1) square(1);").find("upright"),
            std::string::npos);
  const Primitive knob = parse_openscad("scale([2, 2, 3]) rotate_extrude() square([1, 2]);").primitives.at(0);
  EXPECT_TRUE(bounds(knob).isApprox(AlignedBox(Vector3d(-2, -2, 0), Vector3d(2, 2, 6)), 1e-12));
  const Model sectors = parse_openscad(
      "mirror([0, 1, 0]) rotate_extrude(angle = 30) square([2, 1]);"
      "translate([9, 0, 0]) rotate_extrude(angle = -60, start = -30) translate([1, 0]) square(1);");
  expect_inside(sectors, {{1.5, -0.1, 0.5}, {9.1, -1.5, 0.5}});
  expect_outside(sectors, {{1.5, 0.1, 0.5}, {1.5, -0.9, 0.5}, {10.4, -0.1, 0.5}, {8.9, -1.5, 0.5}});
  const Primitive nut = parse_openscad("linear_extrude(1) circle(1, $fn = 6);").primitives.at(0);
  EXPECT_EQ(profile_of(nut).paths.at(0).size(), 6U);
}

TEST(OpenScadSweep, EqualSweptSolidsAreOnePrimitive) {
  EXPECT_EQ(parse_openscad("for (i = [1 : 9]) linear_extrude(1) square(1);").primitives.size(), 1U);
  EXPECT_EQ(parse_openscad("for (i = [1 : 9]) linear_extrude(i) square(1);").primitives.size(), 9U);
  EXPECT_EQ(parse_openscad("for (i = [1 : 9]) rotate_extrude() square(i);").primitives.size(), 9U);
}

TEST(OpenScadSweep, SaysWhatIsNoSweptSolid) {
  const std::vector<std::pair<std::string, std::string>> texts{
      {"linear_extrude(height = 2, twist = 90) square(1);", "line 1, column 36: expected an extrusion without a twist"},
      {"linear_extrude(2, scale = [1, 0.5]) square(1);", "column 27: expected an extrusion with a scale of 1"},
      {"linear_extrude(2, v = [1, 0, 1]) square(1);", "by its height alone"},
      {"linear_extrude(center = true, 5) square(1);", "column 31: expected a height as the first argument"},
      {"linear_extrude(5) square([1, 2, 3]);", "a square with two sizes"},
      {"linear_extrude(-1) square(1);", "a height above 0"},
      {"rotate_extrude(angle = 0) square(1);", "line 1, column 1: expected an angle other than 0"},
      {"rotate_extrude(45) square(1);", "line 1, column 16: expected an angle by its name"},
      {"rotate_extrude()\n  circle(1);",
       "line 2, column 3: expected a shape entirely to the right of the axis (x >= 0)"},
      {"rotate_extrude() translate([1, 0]) polygon([[0, 0], [1, 1], [-1, 1]]);",
       "column 36: profile/0/1: expected a profile that does not touch the axis in a single point"},
      {"linear_extrude(1) cube(1);", "column 19: expected a circle, square or polygon, found 'cube'"},
      {"linear_extrude(1) linear_extrude(1) square(1);", "found 'linear_extrude'"},
      {"square(1);", "line 1, column 1: expected 'square' within linear_extrude or rotate_extrude"},
      {"linear_extrude(1) polygon([[0, 0], [1, 1], [1, 0], [0, 1]]);", "does not cross or touch"},
      {"linear_extrude(1) polygon([[0, 0], [1, 1]]);", "three different corners"},
      {"linear_extrude(1) polygon([]);", "three different corners"},
      {"linear_extrude(1) polygon([[0, 0], [1, 0], [1, 1]], [[]]);", "a polygon of"},
      {"linear_extrude(1) polygon([[0, 0], [1, 0], [1, 1, 1]]);", "a point of two numbers"},
      {"linear_extrude(1) polygon([[0, 0], [1, 0], [1, 1]], [[0, 1, 3]]);", "numbers of points"},
      {"linear_extrude(1) scale([1, 2]) circle(1);", "keeps circles round"},
      {"linear_extrude(1) scale([1, 0]) circle(1);", "with an area"},
      {"linear_extrude(1) rotate([30, 0, 0]) circle(1);", "stays in its plane"},
      {"linear_extrude(1) circle(d = 0);", "a diameter above 0"},
      {"linear_extrude(1) polygon(path([[0, 0], [1, 0], [1, 1]]));", "path() as in files of cloud2csg"},
      {"linear_extrude(1) { }", "expected a solid, found none"},
  };
  for (const auto& [text, message] : texts) {
    EXPECT_NE(test::refusal(text).find(message), std::string::npos) << text << "\n" << test::refusal(text);
  }
}

Model lens() {
  const Profile profile{
      .paths = {{{.point = {0, 0}, .bulge = 0.5}, {.point = {2, 0}, .bulge = 0.25}}, test::circle_path({1, 0}, 0.1)}};
  return {.primitives = {{.id = "lens", .shape = Extrusion{.profile = profile, .height = 1}}},
          .tree = CsgTree::leaf(0)};
}

TEST(OpenScadSweep, KnowsOnlyOurOwnFunctions) {
  const std::string text = to_openscad(lens());
  EXPECT_EQ(test::refusal(text), "accepted");
  std::string other = text;
  other.replace(other.find("4 * atan(bulge)"), 1, "3");
  EXPECT_NE(test::refusal(other).find("path() as in files"), std::string::npos) << test::refusal(other);
  EXPECT_NE(test::refusal(text + "function half(x) = x / 2;").find("found 'function'"), std::string::npos);
  std::string with_returns;
  for (const char c : text) with_returns += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(test::refusal(with_returns), "accepted");
}

TEST(OpenScadSweep, DamagedFilesAreReadOrRefused) {
  const std::string text = to_openscad(lens());
  for (std::size_t length = 0; length < text.size(); length += 3) {
    const std::string answer = test::refusal(text.substr(0, length));
    EXPECT_TRUE(answer == "accepted" || answer.starts_with("part.scad: ")) << answer;
  }
  const std::string alphabet = "(){}[];,=+-*/%#!\"1a. \n\xc3";
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    RandomStream random(seed);
    std::string changed = text;
    for (int i = 0; i < 3; ++i) changed[random.below(changed.size())] = alphabet[random.below(alphabet.size())];
    const std::string answer = test::refusal(changed);
    ASSERT_TRUE(answer == "accepted" || answer.starts_with("part.scad: ")) << answer << "\n" << changed;
  }
}

TEST(OpenScadSweep, ManyShapesTakeLittleTime) {
  const Model plate = parse_openscad(
      "linear_extrude(1) difference() { square(200); for (i = [1 : 30], j = [1 : 30]) translate([6 * i, 6 * j]) "
      "circle(1); }");
  EXPECT_EQ(plate.primitives.size(), 1U);
  EXPECT_EQ(profile_of(plate.primitives[0]).paths.size(), 901U);
  const Model touching = parse_openscad(
      "linear_extrude(1) difference() { square(200); for (i = [1 : 30], j = [1 : 30]) translate([6 * i, 6 * j]) "
      "circle(1); translate([100, 0]) circle(2); }");
  EXPECT_EQ(touching.primitives.size(), 2U) << "one pair that crosses keeps no others apart";
  std::string comb = "[0, -1]";
  for (int i = 1; i < 1000; ++i) comb += fmt::format(", [{}, {}]", i, i % 2);
  comb += ", [999, -1]";
  const Model combs =
      parse_openscad("linear_extrude(1) for (i = [1 : 100]) translate([0, 3 * i]) polygon([" + comb + "]);");
  EXPECT_EQ(profile_of(combs.primitives[0]).paths.size(), 9U) << "more would have over 10 000 segments";
  const Model crowd = parse_openscad("linear_extrude(1) for (i = [1 : 5000]) translate([i, 0]) circle(5);");
  EXPECT_GT(crowd.primitives.size(), 4000U);
}

}  // namespace
}  // namespace cloud2csg
