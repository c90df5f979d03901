#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "cloud2csg/error.hpp"
#include "cloud2csg/model.hpp"
#include "core/base/files.hpp"
#include "core/base/random.hpp"
#include "openscad/refusal.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

bool contains(const Model& model, const Vector3d& point) {
  return implicit_value(*model.tree, model.primitives, test::single(point))[0] < 0;
}

using test::refusal;

/// A part by itself, to look at its primitive.
Primitive only_primitive(const std::string& text) {
  const Model model = parse_openscad(text);
  EXPECT_EQ(model.primitives.size(), 1U) << text;
  EXPECT_EQ(model.tree, CsgTree::leaf(0)) << text;
  return model.primitives.at(0);
}

TEST(OpenScad, ReadsCubes) {
  const Primitive corner = only_primitive("cube([1, 2, 3]);");
  EXPECT_EQ(std::get<Box>(corner.shape).size, Vector3d(1, 2, 3));
  EXPECT_EQ(corner.pose.position, Vector3d(0.5, 1, 1.5));
  EXPECT_EQ(only_primitive("cube(size = 2, center = true);").pose.position, Vector3d(0, 0, 0));
  EXPECT_EQ(std::get<Box>(only_primitive("cube();").shape).size, Vector3d(1, 1, 1));
}

TEST(OpenScad, ReadsSpheresAndCylinders) {
  EXPECT_EQ(std::get<Sphere>(only_primitive("sphere(2);").shape).radius, 2);
  EXPECT_EQ(std::get<Sphere>(only_primitive("sphere(r = 1.5, $fn = 50);").shape).radius, 1.5);
  const Primitive cylinder = only_primitive("cylinder(h = 4, r = 0.5);");
  EXPECT_EQ(std::get<Cylinder>(cylinder.shape).radius, 0.5);
  EXPECT_EQ(std::get<Cylinder>(cylinder.shape).height, 4);
  EXPECT_EQ(cylinder.pose.position, Vector3d(0, 0, 2));
  const Primitive cone = only_primitive("cylinder(3, 2, 0, center = true);");
  EXPECT_EQ(std::get<Cone>(cone.shape).radius_bottom, 2);
  EXPECT_EQ(std::get<Cone>(cone.shape).radius_top, 0);
  EXPECT_EQ(cone.pose.position, Vector3d(0, 0, 0));
}

TEST(OpenScad, ReadsATorus) {
  const Primitive torus = only_primitive("rotate_extrude($fn = 90) translate([3, 2]) circle(r = 1);");
  EXPECT_EQ(std::get<Torus>(torus.shape).major_radius, 3);
  EXPECT_EQ(std::get<Torus>(torus.shape).minor_radius, 1);
  EXPECT_EQ(torus.pose.position, Vector3d(0, 0, 2));
}

TEST(OpenScad, DrawsACylinderOfFewFacetsAsAPrism) {
  const Model nut = parse_openscad("cylinder(h = 2, r = 1, center = true, $fn = 6);");
  EXPECT_EQ(std::get<Polytope>(nut.primitives[0].shape).planes.size(), 8U);
  EXPECT_TRUE(contains(nut, {0.99, 0, 0}));
  EXPECT_FALSE(contains(nut, {0, 0.9, 0})) << "a flat is at cos 30 degrees";
  EXPECT_TRUE(contains(parse_openscad("$fn = 4; cylinder(h = 2, r1 = 1, r2 = 0);"), {0.45, 0, 1}));
  EXPECT_FALSE(contains(parse_openscad("$fn = 4; cylinder(h = 2, r1 = 1, r2 = 0);"), {0.4, 0.4, 1}));
}

TEST(OpenScad, ReadsAConvexPolyhedronInEitherDirection) {
  const std::string points = "polyhedron(points = [[0,0,0], [1,0,0], [0,1,0], [0,0,1]], faces = ";
  for (const char* faces : {"[[0,1,2], [0,3,1], [0,2,3], [1,3,2]]", "[[0,2,1], [0,1,3], [0,3,2], [1,2,3]]"}) {
    const Model model = parse_openscad(points + faces + ");");
    EXPECT_EQ(std::get<Polytope>(model.primitives[0].shape).planes.size(), 4U);
    EXPECT_TRUE(contains(model, {0.2, 0.2, 0.2}));
    EXPECT_FALSE(contains(model, {0.4, 0.4, 0.4}));
  }
  EXPECT_NE(refusal(points + "[[0,1,2], [0,3,1], [0,2,3]]);").find("line 1, column 1: planes: expected"),
            std::string::npos);
  EXPECT_NE(refusal(points + "[[0,1,2], [0,3,1], [0,2,3], [1,3,4]]);").find("numbers of points"), std::string::npos);
}

TEST(OpenScad, RefusesAPolyhedronWithADent) {
  EXPECT_NE(refusal("polyhedron(points = [[0,0,0], [4,0,0], [0,4,0], [1,1,1], [0,0,4]],"
                    "faces = [[0,1,2], [0,4,1], [0,2,4], [1,4,3], [4,2,3], [2,1,3]]);")
                .find("line 1, column 1: expected a convex polyhedron"),
            std::string::npos);
}

TEST(OpenScad, MovesSolidsAsOpenScadDoes) {
  const Vector3d place = only_primitive("rotate([0, 0, 90]) translate([2, 1, 0]) sphere(1);").pose.position;
  EXPECT_EQ(place, Vector3d(-1, 2, 0));
  const Vector3d turned = only_primitive("rotate([90, 0, 90]) translate([0, 0, 1]) sphere(1);").pose.position;
  EXPECT_LT((turned - Vector3d(1, 0, 0)).norm(), 1e-12);
  const Vector3d about = only_primitive("rotate(a = 180, v = [1, 1, 0]) translate([1, 0, 0]) sphere(1);").pose.position;
  EXPECT_LT((about - Vector3d(0, 1, 0)).norm(), 1e-12);
  EXPECT_EQ(only_primitive("mirror([1, 0, 0]) translate([2, 1, 0]) sphere(1);").pose.position, Vector3d(-2, 1, 0));
  EXPECT_EQ(only_primitive("multmatrix([[1,0,0,5],[0,1,0,6],[0,0,1,7],[0,0,0,1]]) sphere(1);").pose.position,
            Vector3d(5, 6, 7));
}

TEST(OpenScad, ScalesWhatStaysASolidOfOurs) {
  EXPECT_EQ(std::get<Sphere>(only_primitive("scale(3) sphere(2);").shape).radius, 6);
  EXPECT_EQ(std::get<Box>(only_primitive("scale([1, 2, 3]) cube(1);").shape).size, Vector3d(1, 2, 3));
  const Primitive cylinder = only_primitive("scale([2, 2, 5]) cylinder(h = 1, r = 1);");
  EXPECT_EQ(std::get<Cylinder>(cylinder.shape).radius, 2);
  EXPECT_EQ(std::get<Cylinder>(cylinder.shape).height, 5);
  const Model sheared =
      parse_openscad("scale([2, 1, 1]) rotate([0, 0, 45]) cube(sqrt2, center = true); sqrt2 = 1.414214;");
  EXPECT_TRUE(contains(sheared, {1.9, 0, 0}));
  EXPECT_FALSE(contains(sheared, {1.9, 0.2, 0}));
  const Model mirrored =
      parse_openscad("scale([-1, 1, 1]) rotate([0, 30, 10]) translate([1, 0, 0]) cylinder(h = 1, r1 = 1, r2 = 0);");
  const Model by_mirror =
      parse_openscad("mirror([1, 0, 0]) rotate([0, 30, 10]) translate([1, 0, 0]) cylinder(h = 1, r1 = 1, r2 = 0);");
  RandomStream random(3);
  for (int i = 0; i < 500; ++i) {
    const Vector3d point = test::random_within(2, random);
    EXPECT_EQ(contains(mirrored, point), contains(by_mirror, point));
  }
}

TEST(OpenScad, RefusesWhatIsNoLongerASolidOfOurs) {
  EXPECT_NE(refusal("scale([1, 1, 2])\n  sphere(1);").find("part.scad: line 2, column 3: expected a scaling"),
            std::string::npos);
  EXPECT_NE(refusal("scale([1, 2, 1]) cylinder(h = 1, r = 1);")
                .find("a scaling that keeps round solids round and upright, found 1, 2, 1"),
            std::string::npos);
  EXPECT_NE(refusal("scale([1, 1, 2]) rotate([30, 0, 0]) cylinder(h = 1, r = 1);").find("upright"), std::string::npos);
  EXPECT_NE(refusal("scale([1, 1, 0]) cube(1);").find("with a volume"), std::string::npos);
}

TEST(OpenScad, CombinesSolids) {
  const Model model = parse_openscad(R"(
    // a plate with two bores, of which one is closed again
    difference() {
      cube([4, 4, 1], center = true);
      translate([1, 0, 0]) cylinder(h = 3, r = 0.5, center = true);
      translate([-1, 0, 0]) { cylinder(h = 3, r = 0.5, center = true); }
      *sphere(10);
      %sphere(10);
    }
    color([1, 0, 0], 0.5) render() group() intersection() {
      #translate([-1, 0, 0]) cylinder(h = 3, r = 0.5, center = true);
      cube([4, 4, 1], center = true);
    } /* end */)");
  EXPECT_EQ(model.primitives.size(), 3U) << "equal solids are one primitive";
  EXPECT_EQ(to_text(*model.tree, model.primitives), "(cube - cylinder - cylinder_2) | (cylinder_2 & cube)");
  EXPECT_FALSE(contains(model, {1, 0, 0}));
  EXPECT_TRUE(contains(model, {-1, 0, 0}));
}

TEST(OpenScad, KnowsWhatIsEmpty) {
  EXPECT_EQ(to_text(*parse_openscad("sphere(1); difference() { group(); sphere(2); }").tree,
                    {{.id = "s", .shape = Sphere{1}}}),
            "s");
  EXPECT_NE(refusal("intersection() { sphere(1); group(); sphere(2); }").find("expected a solid, found none"),
            std::string::npos);
  EXPECT_NE(refusal("").find("expected a solid, found none"), std::string::npos);
}

TEST(OpenScad, EvaluatesSimpleNumbersAndModules) {
  const Model model = parse_openscad(R"(
    width = 2 * (3 + 1) - 6 / 3;  // 6
    size = [width, width, -(-1)];
    half = width / 2;
    plate();
    module plate() { translate([half, 0, 0]) cube(size, center = true); }
    module unused() { hull() cube(1); }
    boss(); translate([0, 0, 1]) boss();
    module boss() cylinder(h = 1, r = 1);)");
  ASSERT_EQ(model.primitives.size(), 3U);
  EXPECT_EQ(model.primitives[0].id, "plate");
  EXPECT_EQ(std::get<Box>(model.primitives[0].shape).size, Vector3d(6, 6, 1));
  EXPECT_EQ(model.primitives[0].pose.position, Vector3d(3, 0, 0));
  EXPECT_EQ(model.primitives[1].id, "boss");
  EXPECT_EQ(model.primitives[2].id, "boss_2");
}

TEST(OpenScad, UnitesTheTurnsOfALoop) {
  const Model row = parse_openscad(R"(
    step = [2, 0, 0];
    difference() {
      cube([9, 4, 4]);
      for (i = [0 : 4 - 1]) translate(i * step + [1, 2, 0]) bore();
    }
    half = 1 / 2;
    module bore() { cylinder(h = 9, r = half, center = true); })");
  EXPECT_EQ(to_text(*row.tree, row.primitives), "cube - (bore | bore_2 | bore_3 | bore_4)");
  EXPECT_EQ(row.primitives[4].pose.position, Vector3d(7, 2, 0));
  const Model grid = parse_openscad("for (i = [0:2], j = [i:-2:-1]) translate([i, j, 0]) sphere(.1);");
  ASSERT_EQ(grid.primitives.size(), 5U) << "the ranges of later variables know the earlier ones";
  EXPECT_EQ(grid.primitives[4].pose.position, Vector3d(2, 0, 0));
  EXPECT_EQ(parse_openscad("for (i = [0:.1:.3]) translate([i, 0, 0]) sphere(1);").primitives.size(), 4U);
  EXPECT_EQ(
      parse_openscad("for (at = [[1, 2, 3], [4, 5, 6]]) translate(-at / 2) sphere(1);").primitives.back().pose.position,
      Vector3d(-2, -2.5, -3));
  const Model alone = parse_openscad("sphere(1); difference() { for (i = [1 : -1 : 2]) sphere(3); sphere(2); }");
  EXPECT_EQ(to_text(*alone.tree, alone.primitives), "sphere") << "a loop without a turn is nothing";
}

TEST(OpenScad, IntersectsTheTurnsOfALoop) {
  const Model lens = parse_openscad("intersection_for (i = [0 : 2]) translate([i, 0, 0]) sphere(r = 2);");
  EXPECT_EQ(lens.primitives.size(), 3U);
  EXPECT_TRUE(contains(lens, {1, 0, 0}));
  EXPECT_FALSE(contains(lens, {2.1, 0, 0}));
  EXPECT_FALSE(contains(lens, {-0.1, 0, 0}));
}

TEST(OpenScad, LoopVariablesAreNotKnownInModules) {
  EXPECT_NE(refusal("module m() sphere(i); for (i = [1 : 2]) m();").find("found 'i'"), std::string::npos);
  const Model model = parse_openscad("i = 3; module m() sphere(i); for (i = [1 : 2]) { m(); sphere(i); }");
  EXPECT_EQ(to_text(*model.tree, model.primitives), "m | sphere | m | sphere_2");
}

TEST(OpenScad, RefusesLoopsThatAreNone) {
  EXPECT_NE(refusal("for (i = [3 : 0]) sphere(i);").find("line 1, column 11: expected a rising range"),
            std::string::npos);
  EXPECT_NE(refusal("for (i = 3) sphere(i);").find("expected a list or a range like [0 : 3]"), std::string::npos);
  EXPECT_NE(refusal("for ([0 : 3]) sphere(1);").find("expected a variable and its values"), std::string::npos);
  EXPECT_NE(refusal("for (i = [0 : 0 : 3]) sphere(1);").find("a rising range"), std::string::npos);
  EXPECT_NE(refusal("sphere([0 : 3]);").find("expected ',', found ':'"), std::string::npos);
  EXPECT_NE(refusal("cube([1, 2] + [1]);").find("expected a number"), std::string::npos);
  EXPECT_NE(refusal("cube([1, 2, 3] * [1, 2, 3]);").find("expected a number"), std::string::npos);
}

TEST(OpenScad, SaysWhereAndWhatWasExpected) {
  EXPECT_EQ(refusal("union() {\n  cube(1);\n"),
            "part.scad: line 3, column 1: expected a closing bracket, found the end of the file; let OpenSCAD flatten "
            "it (-o part.csg), or extract a tree from its mesh (-o part.stl)");
  const std::vector<std::pair<std::string, std::string>> others{
      {"cube(1)", "column 8: expected the end of a statement, found the end of the file"},
      {"cube(size = tall);", "line 1, column 13: expected a variable with a value here, found 'tall'"},
      {"if (true) cube(1);", "line 1, column 1: expected a solid, a map or an operation, found 'if'"},
      {"/* \xc3\xa4 */ hull() cube(1);", "column 9: expected a solid, a map or an operation, found 'hull'"},
      {"cube(-1);", "line 1, column 1: expected a cube with three sizes above 0"},
      {"cube(wide = 1);", "a known argument, found 'wide'"},
      {"sphere(d = 1);", "a known argument, found 'd'"},
      {"cube(1 / 0);", "expected a number"},
      {"cube([1, 2]);", "three sizes above 0"},
      {"cube(1, center = 3);", "expected true or false"},
      {"a = 1; a = 2; cube(a);", "one value for a variable"},
      {"module m() { a = 1; cube(a); } m();", "found 'a'"},
      {"r = sqrt(2); cube(r);", "found 'sqrt'"},
      {"a = [1, 2, 3]; cube(a[0]);", "expected ',', found '['"},
      {"a = true ? 1 : 2; cube(a);", "expected ';', found '?'"},
      {"function f(x) = x; cube(1);", "found 'function'"},
      {"include <parts.scad>\ncube(1);", "found 'include'"},
      {"module m(x) cube(x);", "without parameters"},
      {"cube(1e999);", "double precision"},
      {"/* cube(1);", "expected the end of this comment"},
      {"color(\"red\") cube(1);", "expected a supported character"},
      {"!cube(1);", "a solid or an operation, found '!'"},
  };
  for (const auto& [text, message] : others) EXPECT_NE(refusal(text).find(message), std::string::npos) << refusal(text);
}

std::string repeated(const std::string& text, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

TEST(OpenScad, HostileNestingDoesNotOverflowTheStack) {
  constexpr std::size_t k_many = 300'000;
  for (const char* opening : {"union(){", "{", "translate([0,0,1])", "for(i=[0:1])", "#", "*", "cube(", "cube([",
                              "cube([0:", "x=(", "x=-", "x=!"}) {
    EXPECT_NE(refusal(repeated(opening, k_many)).find("expected"), std::string::npos) << opening;
  }
  EXPECT_NE(refusal("module a() { a(); } a();").find("nested blocks, brackets and calls"), std::string::npos);
  std::string doubling = "module m0() { cube(1); }";
  for (int i = 1; i < 60; ++i) {
    doubling += "module m" + std::to_string(i) + "() {" + repeated("m" + std::to_string(i - 1) + "();", 2) + "}";
  }
  EXPECT_NE(refusal(doubling + "m59();").find("in all"), std::string::npos);
  EXPECT_NE(refusal("a0 = [1, 2]; a1 = [a0, a0]; cube(1);").find("found a list"), std::string::npos);
  EXPECT_NE(refusal("a0 = [1, 2]; a1 = [a0 + a0, 1 * a0]; cube(1);").find("found a list"), std::string::npos);
  EXPECT_NE(refusal("for (i = [0 : 1e-300 : 1]) ;").find("at most 1000000 steps"), std::string::npos);
  EXPECT_NE(refusal("for (i = [1 : 2000], j = [1 : 2000]) ;").find("in all"), std::string::npos);
  std::string many = "for (i = [0 : 0]";
  for (int i = 0; i < 2000; ++i) many += ", i = [0 : 0]";
  EXPECT_NE(refusal(many + ") cube(1);").find("nested blocks, brackets and calls"), std::string::npos);
  const Model sum = parse_openscad("cube(" + repeated("1+", k_many) + "1);");
  EXPECT_EQ(std::get<Box>(sum.primitives[0].shape).size.x(), k_many + 1.0) << "what is only long is read";
  EXPECT_EQ(parse_openscad(repeated("sphere(1);", 10'000)).primitives.size(), 1U);
}

TEST(OpenScad, EveryBeginningOfAFileIsReadOrRefusedWithItsPlace) {
  const std::string text = R"(w = [1, 2.5e0, .5]; // size
module m() { rotate([0, 90, 0]) difference() { cube(w, center = true); sphere(r = w2 * 2); } }
w2 = -(3 - 4) / 5; /* c */ m(); polyhedron(points = [[0,0,0], [1,0,0], [0,1,0], [0,0,1]],
faces = [[0,1,2], [0,3,1], [0,2,3], [1,3,2]]); for (i = [0:1:2], j = [1,2]) color([1, 0, 0]) multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) cube(1);)";
  EXPECT_EQ(refusal(text), "accepted");
  for (std::size_t length = 0; length < text.size(); ++length) {
    const std::string answer = refusal(text.substr(0, length));
    EXPECT_TRUE(answer == "accepted" || answer.starts_with("part.scad: ")) << answer;
  }
}

RC_GTEST_PROP(OpenScadProperty, AnyChangedBytesAreReadOrRefused, (std::uint64_t seed)) {
  RandomStream random(seed);
  std::string text =
      "a = 2; difference() { translate([a, 0, 1]) cube([1, 2, a * 3], center = true); "
      "for (i = [0:2]) rotate(a = 30 * i, v = [1, 0, 0]) cylinder(h = 2, r1 = 1, r2 = 0.5, $fn = 30); }";
  for (int change = 0; change < 4; ++change) {
    const std::string alphabet = "(){}[];,=+-*/%#!\"1a. \n\xc3";
    text[random.below(text.size())] = alphabet[random.below(alphabet.size())];
  }
  const std::string answer = refusal(text);
  RC_ASSERT(answer == "accepted" || answer.starts_with("part.scad: "));
}

}  // namespace
}  // namespace cloud2csg
