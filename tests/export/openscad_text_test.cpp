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

/// The tree's part of the program: from the line after $fn to the first module.
std::string tree_part(const std::string& formula) {
  const PrimitiveSet primitives = balls({"a", "b", "c", "d"});
  const std::string text = to_openscad(parse_tree(formula, primitives), primitives);
  const std::size_t begin = text.find("\n\n") + 2;
  return text.substr(begin, text.find("\nmodule") - begin);
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
  EXPECT_EQ(tree_part("a & empty").rfind("union() {}", 0), 0U);
}

TEST(OpenScadTree, LongChainsNeedNoStack) {
  const PrimitiveSet primitives = balls({"a", "b"});
  CsgTree tree = CsgTree::leaf(0);
  for (int i = 0; i < 3000; ++i) tree = i % 2 == 0 ? unite(CsgTree::leaf(1), tree) : intersect(CsgTree::leaf(1), tree);
  EXPECT_LT(to_openscad(tree, primitives).size(), 2'000'000U);
}

TEST(OpenScadNames, AreUniqueAndAllowed) {
  const PrimitiveSet primitives = balls({"sphere", "a b", "a_b", "9", "everything", "a_b_2", "caf\xc3\xa9\nx"});
  CsgTree tree = CsgTree::leaf(0);
  for (PrimitiveIndex i = 1; i < primitives.size(); ++i) tree = unite(tree, CsgTree::leaf(i));
  const std::string text = to_openscad(tree, primitives);
  for (const char* name : {"sphere_2", "a_b", "a_b_2", "solid_9", "everything_2", "a_b_2_2", "caf___x"}) {
    EXPECT_NE(text.find(std::string("module ") + name + "() {"), std::string::npos) << name << "\n" << text;
  }
  EXPECT_NE(text.find("// sphere\nmodule sphere_2"), std::string::npos) << "the id it had";
}

std::string solid_line(Shape shape, const Pose& pose = {}) {
  const std::string text = to_openscad(CsgTree::leaf(0), {named("p", std::move(shape), pose)});
  const std::size_t begin = text.find("module p() {\n  ") + 15;
  return text.substr(begin, text.rfind("\n}") - begin);
}

Pose turned(double degrees, const Eigen::Vector3d& axis, const Eigen::Vector3d& position = Eigen::Vector3d::Zero()) {
  return {
      .position = position,
      .orientation = Eigen::Quaterniond(Eigen::AngleAxisd(degrees * 3.14159265358979323846 / 180, axis.normalized()))};
}

TEST(OpenScadSolids, AreShort) {
  using Eigen::Vector3d;
  EXPECT_EQ(solid_line(Box{.size = {1, 2, 0.1}}), "cube([1, 2, 0.1], center = true);");
  EXPECT_EQ(solid_line(Box{.size = {1, 1, 1}}, turned(30, Vector3d::UnitZ(), {1, 1e-17, 0})),
            "translate([1, 0, 0]) rotate([0, 0, 30]) cube([1, 1, 1], center = true);");
  EXPECT_EQ(solid_line(Box{.size = {1, 1, 1}}, turned(90, Vector3d::UnitY())),
            "rotate([0, 90, 0]) cube([1, 1, 1], center = true);");
  EXPECT_EQ(solid_line(Sphere{.radius = 0.5}, turned(30, Vector3d::UnitZ())), "sphere(r = 0.5);");
  EXPECT_EQ(solid_line(Cylinder{.radius = 1, .height = 2}, turned(90, Vector3d::UnitX())),
            "rotate([90, 0, 0]) cylinder(h = 2, r = 1, center = true);");
  EXPECT_EQ(solid_line(Cylinder{.radius = 1, .height = 2}, turned(90, Vector3d::UnitY())),
            "rotate([0, 90, 0]) cylinder(h = 2, r = 1, center = true);");
  EXPECT_EQ(solid_line(Cylinder{.radius = 1, .height = 2}, turned(77, Vector3d::UnitZ())),
            "cylinder(h = 2, r = 1, center = true);");
  EXPECT_EQ(solid_line(Cone{.radius_bottom = 1, .radius_top = 0, .height = 2}),
            "cylinder(h = 2, r1 = 1, r2 = 0, center = true);");
  EXPECT_EQ(solid_line(Torus{.major_radius = 1, .minor_radius = 0.25}),
            "rotate_extrude() translate([1, 0]) circle(r = 0.25);");
}

TEST(OpenScadText, HeadIsComment) {
  const std::string text = to_openscad(CsgTree::leaf(0), balls({"a"}), {.facets = 12, .comment = "one\ntwo */ three"});
  EXPECT_EQ(text.rfind("// one\n// two */ three\n$fn = 12;", 0), 0U) << text;
}

TEST(OpenScadText, RefusesBadOptions) {
  const PrimitiveSet primitives = balls({"a"});
  EXPECT_THROW((void)to_openscad(CsgTree::leaf(0), primitives, {.facets = 2}), Error);
  EXPECT_THROW((void)to_openscad(CsgTree::leaf(0), primitives, {.mesh_resolution = 1}), Error);
}

}  // namespace
}  // namespace cloud2csg
