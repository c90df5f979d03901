#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "cloud2csg/advanced/brep.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/mesh.hpp"
#include "core/base/files.hpp"
#include "step_module/read_back.hpp"
#include "support/known_solids.hpp"
#include "support/outside_program.hpp"
#include "support/random_scene.hpp"

namespace cloud2csg {
namespace {

constexpr double k_pi = std::numbers::pi;

/// A folder for the files of a test.
class WriteBrep : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  BrepReport step(const CsgTree& tree, const PrimitiveSet& primitives, const BrepOptions& options = {}) {
    BrepReport report = write_step(path("x.step"), {.primitives = primitives, .tree = tree}, options);
    read_ = test::read_step(path("x.step"));
    return report;
  }

  /// Writes, reads again, and holds all volumes against the expected one.
  void expect_solid(const CsgTree& tree, const PrimitiveSet& primitives, double volume, double tolerance = 1e-6) {
    const BrepReport report = step(tree, primitives);
    EXPECT_TRUE(report.is_valid);
    EXPECT_TRUE(report.failed.empty());
    EXPECT_NEAR(report.volume / volume, 1, tolerance);
    EXPECT_NEAR(report.tree_volume, volume, 5 * report.tree_volume_error + 1e-9 * volume);
    EXPECT_TRUE(read_.is_valid);
    EXPECT_EQ(read_.solids, report.solids);
    EXPECT_NEAR(read_.volume / volume, 1, tolerance);
  }

  test::ReadBack read_ = {};  ///< what step() wrote

 private:
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() /
      (std::string("cloud2csg_brep_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
};

Primitive turned(std::string id, Shape shape) {
  Primitive primitive = test::placed(std::move(id), std::move(shape), {3, -2, 1});
  primitive.pose.orientation = Eigen::Quaterniond(0.6, 0.48, 0.64, 0);
  return primitive;
}

/// All tests but those of known primitives use these: a plate, a ball in its middle, and a rod through it.
PrimitiveSet plate_ball_rod() {
  return {test::placed("plate", Box{.size = {4, 4, 1}}, {0, 0, 0}),
          test::placed("ball", Sphere{.radius = 1}, {0, 0, 0}),
          test::placed("rod", Cylinder{.radius = 0.25, .height = 4}, {1.5, 1.5, 0})};
}

TEST_F(WriteBrep, PrimitivesHaveTheirVolumes) {
  const CsgTree leaf = CsgTree::leaf(0);
  expect_solid(leaf, {turned("box", Box{.size = {1, 2, 3}})}, 6);
  expect_solid(leaf, {turned("sphere", Sphere{.radius = 2})}, 32 * k_pi / 3);
  expect_solid(leaf, {turned("cylinder", Cylinder{.radius = 2, .height = 3})}, 12 * k_pi);
  expect_solid(leaf, {turned("frustum", Cone{.radius_bottom = 2, .radius_top = 1, .height = 3})}, 7 * k_pi);
  expect_solid(leaf, {turned("cone", Cone{.radius_bottom = 2, .radius_top = 0, .height = 3})}, 4 * k_pi);
  expect_solid(leaf, {turned("tip down", Cone{.radius_bottom = 0, .radius_top = 2, .height = 3})}, 4 * k_pi);
  expect_solid(leaf, {turned("nearly", Cone{.radius_bottom = 2, .radius_top = 2, .height = 3})}, 12 * k_pi);
  expect_solid(leaf, {turned("torus", Torus{.major_radius = 2, .minor_radius = 0.5})}, k_pi * k_pi);
  expect_solid(leaf, {turned("horn", Torus{.major_radius = 1, .minor_radius = 1})}, 2 * k_pi * k_pi, 1e-4);
  const Polytope wedge{
      .planes = {{{-1, 0, 0}, 0}, {{0, -1, 0}, 0}, {{0, 0, -1}, 0}, {{0.6, 0.8, 0}, 1.2}, {{0, 0, 1}, 3}}};
  expect_solid(leaf, {turned("wedge", wedge)}, 0.5 * 2 * 1.5 * 3);
}

TEST_F(WriteBrep, TurnedCirclesAreTori) {
  const auto count = [&](std::string_view entity) {
    const std::string text = read_text_file(path("x.step"));
    std::size_t found = 0;
    for (auto at = text.find(entity); at != std::string::npos; at = text.find(entity, at + 1)) ++found;
    return found;
  };
  const ClosedPath rounded{{.point = {2, 0}}, {.point = {3, 0}, .bulge = 0.4}, {.point = {3, 2}}, {.point = {2, 2}}};
  for (const double angle : {90.0, 360.0}) {
    const Profile tube{.paths = {test::circle_path({2, 0}, 0.5), test::circle_path({2, 0}, 0.25)}};
    (void)step(CsgTree::leaf(0), {turned("tube", Revolution{.profile = tube, .angle_deg = angle})});
    EXPECT_EQ(count("TOROIDAL_SURFACE"), 2U);
    EXPECT_EQ(count("SURFACE_OF_REVOLUTION"), 0U);
    (void)step(CsgTree::leaf(0), {turned("barrel", Revolution{.profile = {.paths = {rounded}}, .angle_deg = angle})});
    EXPECT_EQ(count("TOROIDAL_SURFACE"), 1U);
    EXPECT_EQ(count("SURFACE_OF_REVOLUTION"), 0U);
  }
}

/// The part at r > 0 of a circle around (R, 0). Turned, it is an apple for R > 0 and a lemon for R < 0.
TEST_F(WriteBrep, TurnedArcsThatEndOnTheAxisHaveTheirVolumes) {
  constexpr double k_radius = 2;
  for (const double middle : {1.8, 1.0, 0.2, -0.2, -1.0, -1.8}) {
    const double half = std::sqrt(k_radius * k_radius - middle * middle);
    const double half_angle = std::acos(-middle / k_radius);
    const ClosedPath path{{.point = {0, -half}, .bulge = std::tan(half_angle / 2)}, {.point = {0, half}}};
    const double area = k_radius * k_radius * half_angle / 2 + middle * half / 2;  // of one half
    const double volume = 4 * k_pi * (middle * area + half * half * half / 3);
    expect_solid(CsgTree::leaf(0), {turned("turned", Revolution{{.paths = {path}}})}, volume);
  }
}

TEST_F(WriteBrep, SectorsHaveTheirShareOfAFullTurn) {
  const ClosedPath on_axis{{.point = {0, 0}}, {.point = {2, 0}}, {.point = {2, 3}}, {.point = {0, 3}}};
  for (const double angle : {1.0, 90.0, 180.0, 200.0, 359.0}) {
    const Revolution wedge{.profile = {.paths = {on_axis}}, .angle_deg = angle};
    expect_solid(CsgTree::leaf(0), {turned("wedge", wedge)}, 12 * k_pi * angle / 360);
    const Revolution bend{.profile = {.paths = {test::circle_path({2, 0}, 0.5), test::circle_path({2, 0}, 0.25)}},
                          .angle_deg = angle};
    expect_solid(CsgTree::leaf(0), {turned("bend", bend)}, 0.75 * k_pi * k_pi * angle / 360);
  }
}

TEST_F(WriteBrep, SolidsWithoutExactSurfacesHaveFacets) {
  const Expression egg{.distance = "sqrt(x^2 + y^2 + 4 * z^2) - 1",
                       .bounds = AlignedBox(Eigen::Vector3d(-1.2, -1.2, -0.6), Eigen::Vector3d(1.2, 1.2, 0.6))};
  const BrepReport report = step(CsgTree::leaf(0), {turned("egg", egg)});
  EXPECT_EQ(report.faceted, std::vector<PrimitiveIndex>{0});
  EXPECT_TRUE(report.is_valid);
  EXPECT_GT(report.faces, 100U);
  EXPECT_NEAR(read_.volume / (2 * k_pi / 3), 1, 2e-3);
  EXPECT_TRUE(read_.is_valid);
}

TEST_F(WriteBrep, OperationsHaveTheVolumesOfTheirFormulas) {
  const PrimitiveSet primitives = plate_ball_rod();
  const double zone = k_pi * (1 - 1.0 / 12);  // of the ball, within the plate
  const double ball = 4 * k_pi / 3;
  const double rod = 4 * k_pi / 16;
  const auto tree = [&](const char* text) { return parse_tree(text, primitives); };
  expect_solid(tree("plate | ball"), primitives, 16 + ball - zone);
  expect_solid(tree("plate & ball"), primitives, zone);
  expect_solid(tree("plate - ball"), primitives, 16 - zone);
  expect_solid(tree("ball - plate"), primitives, ball - zone);
  EXPECT_EQ(read_.solids, 2U);
  expect_solid(tree("plate - ball - rod"), primitives, 16 - zone - rod / 4);
  expect_solid(tree("plate & ~(ball | rod)"), primitives, 16 - zone - rod / 4);
  expect_solid(tree("(plate | ball | rod) - (ball & plate)"), primitives, 16 + ball + rod * 3 / 4 - 2 * zone);
  expect_solid(tree("ball | rod"), primitives, ball + rod);
  EXPECT_EQ(read_.solids, 2U);
}

TEST_F(WriteBrep, ASphereCutAroundItsPolesIsReadAsItIs) {
  PrimitiveSet primitives{test::placed("ball", Sphere{.radius = 1}, {0, 0, 0})};
  CsgTree tree = CsgTree::leaf(0);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      primitives.push_back(test::placed("cap", Sphere{.radius = 0.7}, 1.1 * side * Eigen::Vector3d::Unit(axis)));
      tree = unite(tree, CsgTree::leaf(static_cast<PrimitiveIndex>(primitives.size() - 1)));
    }
  }
  const BrepReport report = step(tree, primitives);
  EXPECT_TRUE(report.is_valid);
  EXPECT_TRUE(read_.is_valid);
  EXPECT_NEAR(read_.volume, report.tree_volume, 5 * report.tree_volume_error);
}

/// A torus without a hole, cut near its middle, where the kernel's surfaces meet themselves.
PrimitiveSet cut_horn_torus(const Eigen::Vector3d& at, const Eigen::Quaterniond& across) {
  Primitive half_space = test::placed("half", HalfSpace{}, at);
  half_space.pose.orientation = across.normalized();
  Primitive rod = test::placed("rod", Cylinder{.radius = 0.3, .height = 1.2}, {0, 0, 0});
  rod.pose.orientation = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY());
  return {test::placed("ring", Torus{.major_radius = 0.3, .minor_radius = 0.3}, {0, 0, 0}), half_space, rod};
}

TEST_F(WriteBrep, AResultWithGapsGetsFacetsAndIsNamed) {
  const PrimitiveSet primitives = cut_horn_torus(
      {0.09, 0, 0}, {0.4964396767986675, -0.08362997576248334, -0.18127881348883929, 0.8448027380602406});
  const BrepReport report = step(parse_tree("(ring - half) - rod", primitives), primitives);
  EXPECT_TRUE(report.is_valid);
  EXPECT_TRUE(read_.is_valid);
  // Exact, or said to be facets.
  const double tolerance = report.failed.empty() ? 1e-3 : 2e-2;
  EXPECT_NEAR(read_.volume / report.tree_volume, 1, tolerance);
}

TEST_F(WriteBrep, WhatFilesChangeByLessThanCanBeMeasuredIsValid) {
  PrimitiveSet primitives =
      cut_horn_torus({0, 0, 0}, {-0.36148587853258507, -0.6047733518011734, 0.0596863566033558, -0.7071171695045426});
  primitives.push_back(test::placed("below", HalfSpace{}, {0, 0, 0}));
  const BrepReport report = step(parse_tree("(ring & below) - half - rod", primitives), primitives);
  EXPECT_TRUE(report.is_valid);
  EXPECT_TRUE(read_.is_valid);
  EXPECT_LT(report.volume_difference(), 1e-3 + 5 * report.tree_volume_error / report.tree_volume);
}

TEST_F(WriteBrep, HalfSpacesCut) {
  PrimitiveSet primitives = plate_ball_rod();
  primitives.push_back({.id = "below", .shape = HalfSpace{}});
  primitives[3].pose.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 0).normalized()));
  expect_solid(parse_tree("ball & below", primitives), primitives, 2 * k_pi / 3);
  expect_solid(parse_tree("ball - below", primitives), primitives, 2 * k_pi / 3);
  expect_solid(parse_tree("plate & below", primitives), primitives, 8);
  expect_solid(parse_tree("(plate | ~below) & ball & below", primitives), primitives, 0.5 * k_pi * (1 - 1.0 / 12));
  EXPECT_FALSE(step(parse_tree("ball & below", primitives), primitives).cut_at.has_value());
}

TEST_F(WriteBrep, SolidsWithoutEndsAreCutAndSaySo) {
  PrimitiveSet primitives = plate_ball_rod();
  primitives.push_back({.id = "below", .shape = HalfSpace{}});
  const CsgTree open = parse_tree("(ball | below) - plate", primitives);
  const BrepReport report = step(open, primitives);
  ASSERT_TRUE(report.cut_at.has_value());
  EXPECT_TRUE(report.is_valid);
  EXPECT_NEAR(read_.volume, report.tree_volume, 5 * report.tree_volume_error);
  const CsgTree outside = parse_tree("~(ball | rod)", primitives);
  const BrepReport all = step(outside, primitives);
  ASSERT_TRUE(all.cut_at.has_value());
  EXPECT_NEAR(read_.volume / (all.cut_at->volume() - 4 * k_pi / 3 - k_pi / 4), 1, 1e-6);
}

TEST_F(WriteBrep, AnySizeAndPlaceWillDo) {
  for (const double scale : {1e-2, 1e6}) {
    PrimitiveSet primitives = plate_ball_rod();
    for (Primitive& primitive : primitives)
      primitive.pose.position = scale * (primitive.pose.position + Eigen::Vector3d(1e3, 0, 0));
    primitives[0].shape = Box{.size = scale * Eigen::Vector3d(4, 4, 1)};
    primitives[1].shape = Sphere{.radius = scale};
    primitives[2].shape = Cylinder{.radius = 0.25 * scale, .height = 4 * scale};
    const BrepReport report = step(parse_tree("plate - ball - rod", primitives), primitives);
    const double volume = std::pow(scale, 3) * (16 - k_pi * (1 - 1.0 / 12) - k_pi / 16);
    EXPECT_NEAR(report.tree_volume / volume, 1, 1e-3) << scale;
    EXPECT_TRUE(report.is_valid) << scale;
    EXPECT_NEAR(read_.volume / volume, 1, 1e-4) << scale;
  }
}

TEST_F(WriteBrep, NamesArePartAndFaces) {
  PrimitiveSet primitives = plate_ball_rod();
  primitives[0].id = "it's a \"plate\"";
  primitives[1].id = "two\nlines \\ ball";
  primitives[2].id = "Größe 漢字";
  const CsgTree tree = subtract(CsgTree::leaf(0), unite(CsgTree::leaf(1), CsgTree::leaf(2)));
  step(tree, primitives, {.name = "Teil 'Ä'"});
  for (const char byte : test::content_of(path("x.step"))) ASSERT_TRUE(byte == '\n' || (byte >= 0x20 && byte < 0x7F));
  // As the reader gives them: it undoes quotes and what is beyond ASCII.
  EXPECT_EQ(read_.products, std::set<std::string>{"Teil 'Ä'"});
  EXPECT_EQ(read_.faces, (std::set<std::string>{primitives[0].id, primitives[1].id, primitives[2].id}));
}

TEST_F(WriteBrep, PrimitivesAreComponentsWhenAskedFor) {
  const PrimitiveSet primitives = plate_ball_rod();
  const CsgTree tree = parse_tree("plate - ball", primitives);
  const BrepReport report = step(tree, primitives, {.with_primitives = true});
  // All of the file is checked, the part is told of.
  const BrepReport alone = write_step(path("alone.step"), {.primitives = primitives, .tree = tree});
  EXPECT_TRUE(report.is_valid);
  EXPECT_EQ(report.solids, 1U);
  EXPECT_NEAR(report.volume, alone.volume, 1e-6 * alone.volume);
  EXPECT_EQ(read_.products, (std::set<std::string>{"x", "x assembly", "primitives", "plate", "ball"}));
  EXPECT_EQ(read_.solids, 3U);
}

TEST_F(WriteBrep, BrepFilesHoldTheSameSolid) {
  const PrimitiveSet primitives = plate_ball_rod();
  const BrepReport report =
      write_brep(path("x.brep"), {.primitives = primitives, .tree = parse_tree("plate - ball", primitives)});
  const test::ReadBack read = test::read_brep(path("x.brep"));
  EXPECT_TRUE(read.is_valid);
  EXPECT_NEAR(read.volume, 16 - k_pi * (1 - 1.0 / 12), 1e-6);
  EXPECT_NEAR(report.volume, read.volume, 1e-9);
}

/// The part of a STEP file that does not say when it was written.
std::string data_of(const std::filesystem::path& file) {
  const std::string text = test::content_of(file);
  return text.substr(text.find("DATA;"));
}

TEST_F(WriteBrep, ThreadsMakeNoDifference) {
  const Model model = test::paper_model("m0");
  write_step(path("one.step"), model, {.name = "m0"}, {.threads = 1});
  write_step(path("many.step"), model, {.name = "m0"}, {.threads = 4});
  EXPECT_EQ(data_of(path("one.step")), data_of(path("many.step")));
}

TEST_F(WriteBrep, EmptySolidsAreRefusedAndOlderFilesStay) {
  const PrimitiveSet primitives = plate_ball_rod();
  std::ofstream(path("x.step")) << "older";
  const CsgTree nothing = parse_tree("ball & rod", primitives);
  EXPECT_THROW(write_step(path("x.step"), {.primitives = primitives, .tree = nothing}), Error);
  EXPECT_THROW(write_step(path("x.step"), {.primitives = primitives, .tree = CsgTree::empty()}), Error);
  EXPECT_EQ(test::content_of(path("x.step")), "older");
}

TEST_F(WriteBrep, OptionsOutOfRangeAreNamed) {
  const PrimitiveSet primitives = plate_ball_rod();
  for (const auto& [options, field] : {std::pair{BrepOptions{.facet_resolution = 2}, "facet_resolution"},
                                       std::pair{BrepOptions{.volume_tolerance = 0}, "volume_tolerance"},
                                       std::pair{BrepOptions{.volume_tolerance = std::nan("")}, "volume_tolerance"}}) {
    try {
      write_step(path("x.step"), {.primitives = primitives, .tree = CsgTree::leaf(0)}, options);
      ADD_FAILURE() << field;
    } catch (const Error& error) {
      EXPECT_EQ(error.parts().where, field);
    }
  }
}

TEST_F(WriteBrep, StopsWhenAsked) {
  const Model model = test::paper_model("m0");
  std::stop_source stop;
  const RunContext run{.stop = stop.get_token(), .on_progress = [&](const Progress& progress) {
                         EXPECT_EQ(progress.stage, "solid");
                         if (progress.done > 5) stop.request_stop();
                       }};
  EXPECT_THROW(write_step(path("x.step"), model, {}, run), Cancelled);
  EXPECT_FALSE(std::filesystem::exists(path("x.step")));
}

TEST_F(WriteBrep, PaperModelsAreOneValidSolid) {
  for (const char* name : {"m0", "m2", "m3"}) {
    const Model model = test::paper_model(name);
    const BrepReport report = step(*model.tree, model.primitives);
    EXPECT_TRUE(report.is_valid) << name;
    EXPECT_TRUE(report.failed.empty()) << name;
    EXPECT_LT(report.volume_difference(), 1e-3) << name;
    EXPECT_EQ(read_.solids, 1U) << name;
    EXPECT_NEAR(read_.volume / report.volume, 1, 1e-6) << name;
  }
}

/// Without solids that have no exact surfaces.
PrimitiveSet plain_primitives(std::size_t count, RandomStream& random) {
  PrimitiveSet primitives;
  while (primitives.size() < count) {
    primitives.push_back({.id = "p" + std::to_string(primitives.size()),
                          .shape = test::random_shape(random),
                          .pose = test::random_pose(random)});
  }
  return primitives;
}

/// Coinciding faces, tangent surfaces and all: each is right, or the report says that it is not.
TEST_F(WriteBrep, RandomTreesAreRightOrSaySo) {
  constexpr std::uint64_t k_trees = 40;
  std::size_t solids = 0;
  std::size_t exact = 0;
  for (std::uint64_t seed = 1; seed <= k_trees; ++seed) {
    RandomStream random(seed);
    const std::size_t count = 3 + random.below(6);
    const PrimitiveSet primitives = plain_primitives(count, random);
    const CsgTree tree = test::random_formula(count, count, random);
    BrepReport report;
    try {
      report = step(tree, primitives);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("empty"), std::string::npos) << error.what();
      continue;
    }
    EXPECT_NEAR(read_.volume, report.volume, 1e-5 * report.volume) << "seed " << seed;
    ++solids;
    if (!report.failed.empty() || !report.is_valid) continue;
    EXPECT_LT(std::abs(report.volume - report.tree_volume), 1e-3 * report.tree_volume + 5 * report.tree_volume_error)
        << "seed " << seed << ": " << to_text(tree, primitives);
    EXPECT_TRUE(read_.is_valid) << "seed " << seed;
    ++exact;
  }
  EXPECT_GE(solids, k_trees / 2);
  EXPECT_GE(exact, solids * 9 / 10);
}

}  // namespace
}  // namespace cloud2csg
