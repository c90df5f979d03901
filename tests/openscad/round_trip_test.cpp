#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "cloud2csg/export.hpp"
#include "cloud2csg/model.hpp"
#include "core/base/files.hpp"
#include "core/base/random.hpp"
#include "support/flange.hpp"
#include "support/random_scene.hpp"
#include "support/repeated_parts.hpp"

namespace cloud2csg {
namespace {

using Eigen::Vector3d;

std::filesystem::path temporary(const std::string& name) {
  return std::filesystem::temp_directory_path() / ("cloud2csg_scad_test_" + name);
}

bool has_openscad() {
  return std::system("command -v openscad > /dev/null 2>&1") == 0;  // NOLINT: a fixed command
}

/// Where both models say the same, but for points so near to a surface that six digits decide.
void expect_same_solid(const Model& expected, const Model& found, RandomStream& random,
                       const Vector3d& centre = Vector3d::Zero(), double reach = 2.5) {
  Points points;
  for (int i = 0; i < 4000; ++i) points.push_back(centre + test::random_within(reach, random));
  const std::vector<double> left = implicit_value(*expected.tree, expected.primitives, points);
  const std::vector<double> right = implicit_value(*found.tree, found.primitives, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::abs(left[i]) < 1e-3) continue;
    ASSERT_EQ(left[i] < 0, right[i] < 0) << to_text(*expected.tree, expected.primitives) << "\nat "
                                         << points[i].transpose() << ", " << left[i] << " and " << right[i];
  }
}

/// Of the solids that .scad files hold as such: no half-spaces (cubes there), displaced solids and formulas (meshes).
/// `with_profiles`: whose arcs OpenSCAD does not keep.
Model random_model(RandomStream& random, bool with_profiles) {
  Model model{.primitives = test::random_primitives(6, random)};
  for (Primitive& primitive : model.primitives) {
    primitive.displacement.reset();
    const bool is_mesh = std::holds_alternative<Expression>(primitive.shape);
    const bool has_profile =
        std::holds_alternative<Extrusion>(primitive.shape) || std::holds_alternative<Revolution>(primitive.shape);
    if (is_mesh || (has_profile && !with_profiles) || std::holds_alternative<HalfSpace>(primitive.shape)) {
      primitive.shape =
          Polytope{.planes = {{{-1, 0, 0}, 1}, {{0, -1, 0}, 1}, {{0, 0, -1}, 1}, {{0.6, 0.8, 0}, 1}, {{0, 0, 1}, 0.5}}};
    }
    auto* torus = std::get_if<Torus>(&primitive.shape);
    if (torus != nullptr && torus->minor_radius >= torus->major_radius) torus->minor_radius /= 2;
  }
  const CsgTree whole = CsgTree::leaf(0);  // so that complements stay bounded
  model.tree = subtract(unite(whole, CsgTree::leaf(1)), test::random_formula(6, 9, random));
  return model;
}

TEST(OpenScadRoundTrip, OurScriptsAreReadAsTheyAre) {
  int compared = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    RandomStream random(seed);
    const Model model = random_model(random, true);
    const std::string text = to_openscad(model);
    if (text.find("everything()") != std::string::npos) continue;
    if (primitives_of(*model.tree).empty() || text.find("empty solid") != std::string::npos) continue;
    SCOPED_TRACE(text);
    expect_same_solid(model, parse_openscad(text), random);
    ++compared;
  }
  EXPECT_GT(compared, 20);
}

TEST(OpenScadRoundTrip, OurScriptsAreReadAsOpenScadFlattensThem) {
  if (!has_openscad()) GTEST_SKIP() << "needs the openscad program";
  const std::filesystem::path scad = temporary("model.scad");
  const std::filesystem::path csg = temporary("model.csg");
  for (std::uint64_t seed = 100; seed < 120; ++seed) {
    RandomStream random(seed);
    const Model model = random_model(random, false);
    write_text_file(scad, to_openscad(model));
    const std::string command = "openscad -o '" + csg.string() + "' '" + scad.string() + "' > /dev/null 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0);  // NOLINT: our names
    SCOPED_TRACE(read_text_file(csg));
    expect_same_solid(model, read_model(csg), random);
  }
  std::filesystem::remove(scad);
  std::filesystem::remove(csg);
}

/// A box with bores in three columns and four rows.
Model bored_plate() {
  Model model{.primitives = {{.id = "plate", .shape = Box{.size = {4, 5, 1}}}}};
  CsgTree tree = CsgTree::leaf(0);
  for (int i = 0; i < 12; ++i) {
    const Vector3d place(i % 3 - 1.1, i / 3 - 1.5, 0);
    model.primitives.push_back({.id = "bore " + std::to_string(i),
                                .shape = Cylinder{.radius = 0.4, .height = 2},
                                .pose = {.position = place}});
    tree = subtract(tree, CsgTree::leaf(static_cast<PrimitiveIndex>(i + 1)));
  }
  model.tree = tree;
  return model;
}

TEST(OpenScadRoundTrip, LoopsKeepTheirSolids) {
  RandomStream random(1);
  const Model flange = test::flange();
  const std::string circle = to_openscad(flange);
  ASSERT_NE(circle.find("for (i = [0 : "), std::string::npos);
  ASSERT_NE(circle.find("rotate(a = i * "), std::string::npos);
  const Model flange_again = parse_openscad(circle);
  expect_same_solid(flange, flange_again, random, {30, 20, 5}, 12);
  EXPECT_EQ(flange_again.primitives.size(), flange.primitives.size());
  const Model plate = bored_plate();
  const std::string grid = to_openscad(plate);
  ASSERT_NE(grid.find(", j = [0 : "), std::string::npos);
  const Model plate_again = parse_openscad(grid);
  expect_same_solid(plate, plate_again, random);
  EXPECT_EQ(leaf_count(*plate_again.tree), leaf_count(*plate.tree));
}

TEST(OpenScadRoundTrip, LoopsOverCombinationsKeepTheirSolids) {
  RandomStream random(1);
  const Model model = test::repeated_parts();
  const std::string text = to_openscad(model);
  for (const char* loop : {"for (i = [0, 1]) translate(2 * i * ", "intersection_for (i = "}) {
    ASSERT_NE(text.find(loop), std::string::npos) << loop << "\n" << text;
  }
  // One bar, in a loop with that of its bores; one angle; one lens.
  for (const char* solid : {"bar_", "bore_", "angle_", "notch_", "lens_"}) {
    const std::string module = std::string("module ") + solid;
    ASSERT_NE(text.find(module), std::string::npos) << solid << "\n" << text;
    EXPECT_EQ(text.find(module), text.rfind(module)) << solid << "\n" << text;
  }
  const Model again = parse_openscad(text);
  expect_same_solid(model, again, random, {1, 4, 3}, 12);
  EXPECT_EQ(again.primitives.size(), model.primitives.size());
  EXPECT_EQ(leaf_count(*again.tree), leaf_count(*model.tree));
}

Primitive solid_again(const std::string& text) {
  Model model = parse_openscad(text);
  EXPECT_EQ(model.primitives.size(), 1U) << text;
  return model.primitives.front();
}

TEST(OpenScadRoundTrip, ToriWithoutAHoleAreReadInAnyUnit) {
  for (const double unit : {0.01, 1.0, 10'000.0}) {
    const PrimitiveSet ring{{.id = "ring", .shape = Torus{.major_radius = unit, .minor_radius = unit}}};
    for (const std::string& text : {to_openscad({.primitives = ring, .tree = CsgTree::leaf(0)}),
                                    to_openscad_csg({.primitives = ring, .tree = CsgTree::leaf(0)})}) {
      SCOPED_TRACE(text);
      const Primitive torus = solid_again(text);
      EXPECT_DOUBLE_EQ(std::get<Torus>(torus.shape).major_radius, unit);
      EXPECT_DOUBLE_EQ(std::get<Torus>(torus.shape).minor_radius, unit);
    }
  }
  // A profile that is cut where it is more than a pinhole is no torus.
  const Model cut = parse_openscad(
      "rotate_extrude() intersection() { translate([2, 0]) circle(r = 1); translate([1.5, -1]) square(2); }");
  EXPECT_EQ(to_text(*cut.tree, cut.primitives), "revolution & revolution_2");
}

TEST(OpenScadRoundTrip, FewFacetsAreCorners) {
  const PrimitiveSet pin{{.id = "pin", .shape = Cylinder{.radius = 1, .height = 2}}};
  const auto again = [&pin](int facets) {
    return solid_again(to_openscad({.primitives = pin, .tree = CsgTree::leaf(0)}, {.facets = facets})).shape;
  };
  EXPECT_TRUE(std::holds_alternative<Polytope>(again(8)));
  EXPECT_TRUE(std::holds_alternative<Cylinder>(again(9)));
  EXPECT_TRUE(std::holds_alternative<Cylinder>(
      solid_again(to_openscad_csg({.primitives = pin, .tree = CsgTree::leaf(0)}, {.facets = 8})).shape));
}

TEST(OpenScadRoundTrip, TheShippedModelsKeepTheirSolids) {
  for (const char* name : {"m0.json", "m3.json"}) {
    const Model model = read_model(std::filesystem::path(CLOUD2CSG_DATA_DIR) / "models" / name);
    const Model again = parse_openscad(to_openscad(model));
    RandomStream random(1);
    expect_same_solid(model, again, random);
    EXPECT_EQ(leaf_count(*again.tree), leaf_count(*model.tree));
  }
}

}  // namespace
}  // namespace cloud2csg
