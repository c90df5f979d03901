#include <gtest/gtest.h>

#include "cloud2csg/error.hpp"
#include "cloud2csg/export.hpp"

namespace cloud2csg {
namespace {

Primitive named(const std::string& id, Shape shape, const Pose& pose = {}) {
  return {.id = id, .shape = std::move(shape), .pose = pose, .displacement = {}};
}

PrimitiveSet balls(const std::vector<std::string>& ids) {
  PrimitiveSet primitives;
  for (const std::string& id : ids) primitives.push_back(named(id, Sphere{.radius = 1}));
  return primitives;
}

/// The tree's part of the program: from the paragraph that is no parameters to the first module.
std::string tree_part(const std::string& formula) {
  const PrimitiveSet primitives = balls({"a", "b", "c", "d"});
  const std::string text =
      to_openscad({.primitives = primitives, .tree = parse_tree(formula, primitives)}, {.patterns = false});
  std::size_t begin = text.find("\n\n") + 2;
  while (text.compare(begin, 2, "/*") == 0 || text.compare(begin, 2, "//") == 0) begin = text.find("\n\n", begin) + 2;
  return text.substr(begin, text.find("\nmodule", begin) - begin);
}

TEST(OpenScadTree, ChainsAreOneBlock) {
  EXPECT_EQ(tree_part("a"), "a();\n");
  EXPECT_EQ(tree_part("a | (b | c) | d"), "union() {\n  a();\n  b();\n  c();\n  d();\n}\n");
  EXPECT_EQ(tree_part("a & (b & c)"), "intersection() {\n  a();\n  b();\n  c();\n}\n");
  EXPECT_EQ(tree_part("(a - b) - (c | d)"), "difference() {\n  a();\n  b();\n  c();\n  d();\n}\n");
  EXPECT_EQ(tree_part("(a | b) - c"), "difference() {\n  union() {\n    a();\n    b();\n  }\n  c();\n}\n");
  EXPECT_EQ(tree_part("(a & b) - c"), "difference() {\n  intersection() {\n    a();\n    b();\n  }\n  c();\n}\n");
}

TEST(OpenScadTree, ComplementsBecomeDifferencesWhereTheyCan) {
  EXPECT_EQ(tree_part("a & ~b"), "difference() {\n  a();\n  b();\n}\n");
  EXPECT_EQ(tree_part("a - ~b"), "intersection() {\n  a();\n  b();\n}\n");
  EXPECT_EQ(tree_part("~a"), "difference() {\n  everything();\n  a();\n}\n");
  EXPECT_EQ(tree_part("~a & ~b"), "difference() {\n  everything();\n  a();\n  b();\n}\n");
}

TEST(OpenScadTree, ConstantsVanishWhereTheyCan) {
  EXPECT_EQ(tree_part("(a | empty) & full"), "a();\n");
  EXPECT_EQ(tree_part("full").rfind("everything();\n", 0), 0U);
  EXPECT_EQ(tree_part("a & empty").rfind("union();", 0), 0U);
}

TEST(OpenScadTree, FlatIntersectionsAreOfTwo) {
  const PrimitiveSet primitives = balls({"a", "b", "c", "d"});
  std::string text = to_openscad_csg({.primitives = primitives, .tree = parse_tree("(a & b & c) - d", primitives)});
  const std::string ball =
      "multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { sphere($fn = 0, $fa = 5.625, $fs = 0.01, "
      "r = 1); }";
  for (std::size_t at = text.find(ball); at != std::string::npos; at = text.find(ball))
    text.replace(at, ball.size(), "o");
  EXPECT_EQ(text,
            "difference() {\n  intersection() {\n    intersection() {\n      o\n      o\n    }\n    o\n  }\n  o\n}\n");
}

TEST(OpenScadTree, LongChainsNeedNoStack) {
  const PrimitiveSet primitives = balls({"a", "b"});
  CsgTree tree = CsgTree::leaf(0);
  for (int i = 0; i < 3000; ++i) tree = i % 2 == 0 ? unite(CsgTree::leaf(1), tree) : intersect(CsgTree::leaf(1), tree);
  EXPECT_LT(to_openscad({.primitives = primitives, .tree = tree}).size(), 2'000'000U);
}

TEST(OpenScadNames, AreUniqueAndAllowed) {
  const PrimitiveSet primitives = balls({"sphere", "a b", "a_b", "9", "everything", "a_b_2", "caf\xc3\xa9\nx"});
  CsgTree tree = CsgTree::leaf(0);
  for (PrimitiveIndex i = 1; i < primitives.size(); ++i) tree = unite(tree, CsgTree::leaf(i));
  const std::string text = to_openscad({.primitives = primitives, .tree = tree});
  for (const char* name : {"sphere_2", "a_b", "a_b_2", "solid_9", "everything_2", "a_b_2_2", "caf___x"}) {
    EXPECT_NE(text.find(std::string("module ") + name + "() {"), std::string::npos) << name << "\n" << text;
  }
  EXPECT_NE(text.find("// sphere\nmodule sphere_2"), std::string::npos) << "the id it had";
}

/// The values of a solid, then its statement.
std::string solid_lines(Shape shape, const Pose& pose = {}) {
  const std::string text = to_openscad({.primitives = {named("p", std::move(shape), pose)}, .tree = CsgTree::leaf(0)});
  const std::size_t values = text.find("/* [p] */\n") + 10;
  const std::size_t begin = text.find("module p() {\n  ") + 15;
  return text.substr(values, text.find("\n\n", values) + 1 - values) + text.substr(begin, text.rfind("\n}") - begin);
}

Pose turned(double degrees, const Eigen::Vector3d& axis, const Eigen::Vector3d& position = Eigen::Vector3d::Zero()) {
  return {
      .position = position,
      .orientation = Eigen::Quaterniond(Eigen::AngleAxisd(degrees * 3.14159265358979323846 / 180, axis.normalized()))};
}

TEST(OpenScadSolids, AreShort) {
  using Eigen::Vector3d;
  EXPECT_EQ(solid_lines(Box{.size = {1, 2, 0.1}}),
            "p_size = [1, 2, 0.1];\np_position = [0, 0, 0];\ntranslate(p_position) cube(p_size, center = true);");
  EXPECT_EQ(solid_lines(Box{.size = {1, 1, 1}}, turned(30, Vector3d::UnitZ(), {1, 1e-17, 0})),
            "p_size = [1, 1, 1];\np_position = [1, 0, 0];\np_rotation = [0, 0, 30];\n"
            "translate(p_position) rotate(p_rotation) cube(p_size, center = true);");
  EXPECT_EQ(solid_lines(Sphere{.radius = 0.5}, turned(30, Vector3d::UnitZ())),
            "p_radius = 0.5;\np_position = [0, 0, 0];\ntranslate(p_position) sphere(r = p_radius);");
  const std::string turned_cylinder =
      "translate(p_position) rotate(p_rotation) cylinder(h = p_height, r = p_radius, center = true);";
  const std::string cylinder_values = "p_radius = 1;\np_height = 2;\np_position = [0, 0, 0];\n";
  EXPECT_EQ(solid_lines(Cylinder{.radius = 1, .height = 2}, turned(90, Vector3d::UnitX())),
            cylinder_values + "p_rotation = [90, 0, 0];\n" + turned_cylinder);
  EXPECT_EQ(solid_lines(Cylinder{.radius = 1, .height = 2}, turned(90, Vector3d::UnitY())),
            cylinder_values + "p_rotation = [0, 90, 0];\n" + turned_cylinder);
  EXPECT_EQ(solid_lines(Cylinder{.radius = 1, .height = 2}, turned(77, Vector3d::UnitZ())),
            cylinder_values + "translate(p_position) cylinder(h = p_height, r = p_radius, center = true);");
  EXPECT_EQ(solid_lines(Cone{.radius_bottom = 1, .radius_top = 0, .height = 2}),
            "p_radius_bottom = 1;\np_radius_top = 0;\np_height = 2;\np_position = [0, 0, 0];\n"
            "translate(p_position) cylinder(h = p_height, r1 = p_radius_bottom, r2 = p_radius_top, center = true);");
  EXPECT_EQ(solid_lines(Torus{.major_radius = 1, .minor_radius = 0.25}),
            "p_major_radius = 1;\np_minor_radius = 0.25;\np_position = [0, 0, 0];\n"
            "translate(p_position) rotate_extrude() translate([p_major_radius, 0]) circle(r = p_minor_radius);");
}

TEST(OpenScadSolids, VariablesAreUnique) {
  const PrimitiveSet primitives{named("a", Torus{.major_radius = 1, .minor_radius = 0.25}),
                                named("a_major", Sphere{.radius = 7})};
  const std::string text = to_openscad({.primitives = primitives, .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))});
  EXPECT_NE(text.find("a_major_radius = 1;"), std::string::npos) << text;
  EXPECT_NE(text.find("a_major_radius_2 = 7;"), std::string::npos) << text;
  EXPECT_NE(text.find("sphere(r = a_major_radius_2)"), std::string::npos) << text;
}

TEST(OpenScadTree, FlatCirclesHaveTheFacetsAskedForInAnyUnit) {
  const auto flat = [](double radius, int facets) {
    return to_openscad_csg({.primitives = {named("p", Sphere{.radius = radius})}, .tree = CsgTree::leaf(0)},
                           {.facets = facets});
  };
  // By angle, which FreeCAD reads as round, where no facet is shorter than the least that OpenSCAD makes by angle.
  EXPECT_NE(flat(1, 64).find("sphere($fn = 0, $fa = 5.625, $fs = 0.01, "), std::string::npos);
  EXPECT_NE(flat(0.005, 64).find("sphere($fn = 64, $fa = 5.625, $fs = 0.01, "), std::string::npos);
  // FreeCAD takes up to 16 for corners.
  EXPECT_NE(flat(0.005, 12).find("sphere($fn = 17, "), std::string::npos);
}

TEST(OpenScadLoops, AreWrittenForThreeOrMore) {
  PrimitiveSet holes;
  CsgTree tree = CsgTree::leaf(0);
  for (int i = 0; i < 3; ++i) {
    holes.push_back(named("hole_" + std::to_string(i + 1), Sphere{.radius = 1}, {.position = {20.0 * i, 0, 0}}));
    if (i > 0) tree = unite(tree, CsgTree::leaf(static_cast<PrimitiveIndex>(i)));
  }
  const std::string text = to_openscad({.primitives = holes, .tree = tree});
  EXPECT_NE(text.find("hole_1_count = 3;\nhole_1_step = [20, 0, 0];\n"), std::string::npos) << text;
  EXPECT_NE(text.find("  for (i = [0 : hole_1_count - 1]) translate(i * hole_1_step) hole_1();\n"), std::string::npos);
  EXPECT_EQ(text.find("module hole_2"), std::string::npos);
  EXPECT_NE(text.find("as hole_2, hole_3"), std::string::npos) << "which primitives it stands for";
  EXPECT_NE(to_openscad({.primitives = holes, .tree = tree}, {.patterns = false}).find("module hole_2"),
            std::string::npos);
  // Two have a step, but no pattern; what the tree has twice stays alone.
  EXPECT_EQ(to_openscad({.primitives = holes, .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))}).find("for ("),
            std::string::npos);
  EXPECT_EQ(to_openscad({.primitives = holes, .tree = unite(tree, subtract(CsgTree::leaf(0), CsgTree::leaf(1)))})
                .find("for ("),
            std::string::npos);
}

TEST(OpenScadText, HeadIsComment) {
  const std::string text = to_openscad({.primitives = balls({"a"}), .tree = CsgTree::leaf(0)},
                                       {.facets = 12, .comment = "one\ntwo */ three"});
  EXPECT_EQ(text.rfind("// one\n// two */ three\n$fn = 12;", 0), 0U) << text;
}

TEST(OpenScadText, RefusesBadOptions) {
  const PrimitiveSet primitives = balls({"a"});
  EXPECT_THROW((void)to_openscad({.primitives = primitives, .tree = CsgTree::leaf(0)}, {.facets = 2}), Error);
  EXPECT_THROW((void)to_openscad({.primitives = primitives, .tree = CsgTree::leaf(0)}, {.mesh_resolution = 1}), Error);
}

}  // namespace
}  // namespace cloud2csg
