#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

#include "cloud2csg/error.hpp"
#include "cloud2csg/export.hpp"
#include "shape/mesh/model_extent.hpp"
#include "support/any_profile.hpp"
#include "support/every_type.hpp"
#include "support/flange.hpp"
#include "support/known_solids.hpp"
#include "support/repeated_parts.hpp"

namespace cloud2csg {
namespace {

std::filesystem::path temporary(const std::string& name) {
  return std::filesystem::temp_directory_path() / ("cloud2csg_export_test_" + name);
}

Model data_model(const std::string& name) {
  return read_model(std::filesystem::path(CLOUD2CSG_DATA_DIR) / "models" / name);
}

std::string content_of(const std::filesystem::path& file) {
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

double mesh_volume(const Model& model, int resolution = 96) {
  return volume_of(mesh_surface(model, bounds_of(model), {.resolution = resolution}));
}

bool has_openscad() {
  return std::system("command -v openscad > /dev/null 2>&1") == 0;
}  // NOLINT: a fixed command

struct Rendering {
  int status;
  std::string log;
  TriangleMesh mesh;
};

/// Renders with the OpenSCAD program, as a user would.
Rendering render(const std::string& name, const Model& model, const OpenScadOptions& options) {
  const std::filesystem::path scad = temporary(name.ends_with(".csg") ? name : name + ".scad");
  const std::filesystem::path off = temporary(name + ".off");
  const std::filesystem::path log = temporary(name + ".log");
  export_model(scad, model, {.openscad = options});
  const std::string command =
      "timeout 500 openscad -o '" + off.string() + "' '" + scad.string() + "' > '" + log.string() + "' 2>&1";
  Rendering rendering{.status = std::system(command.c_str()), .log = content_of(log), .mesh = {}};  // NOLINT: our names
  if (rendering.status == 0) rendering.mesh = read_mesh(off);
  for (const auto& file : {scad, off, log}) std::filesystem::remove(file);
  return rendering;
}

void expect_same_solid(const std::string& name, const Model& model, const OpenScadOptions& options, double tolerance) {
  const Rendering rendering = render(name, model, options);
  ASSERT_EQ(rendering.status, 0) << rendering.log;
  EXPECT_EQ(rendering.log.find("WARNING"), std::string::npos) << rendering.log;
  EXPECT_EQ(rendering.log.find("ERROR"), std::string::npos) << rendering.log;
  EXPECT_TRUE(is_watertight(rendering.mesh));
  const double expected = mesh_volume(model);
  EXPECT_NEAR(volume_of(rendering.mesh) / expected, 1.0, tolerance) << "expected volume " << expected;
}

TEST(OpenScadProgram, RendersM0) {
  if (!has_openscad()) GTEST_SKIP() << "needs the openscad program";
  // A circle of 16 facets has 2.5 % less area; about half of the volume is round.
  expect_same_solid("m0", data_model("m0.json"), {.facets = 16}, 0.02);
}

TEST(OpenScadProgram, RendersADisplacedSolid) {
  if (!has_openscad()) GTEST_SKIP() << "needs the openscad program";
  expect_same_solid("m1", data_model("m1.json"), {.facets = 16, .mesh_resolution = 24}, 0.02);
}

TEST(OpenScadProgram, RendersEveryTypeTurnedAndMoved) {
  if (!has_openscad()) GTEST_SKIP() << "needs the openscad program";
  const Model model = test::model_of_every_type();
  expect_same_solid("every_type", model, {.facets = 24, .mesh_resolution = 24}, 0.03);
}

TEST(OpenScadProgram, RendersTheFlatLanguage) {
  if (!has_openscad()) GTEST_SKIP() << "needs the openscad program";
  expect_same_solid("m0.csg", data_model("m0.json"), {.facets = 16}, 0.02);
  expect_same_solid("every_type.csg", test::model_of_every_type(), {.facets = 24, .mesh_resolution = 24}, 0.03);
}

TEST(OpenScadProgram, RendersLoopsLikeTheirMembers) {
  if (!has_openscad()) GTEST_SKIP() << "needs the openscad program";
  for (const Model& model : {test::flange(), test::repeated_parts()}) {
    const Rendering loops = render("loops", model, {.facets = 48});
    const Rendering plain = render("plain", model, {.facets = 48, .patterns = false});
    ASSERT_EQ(loops.status, 0) << loops.log;
    ASSERT_EQ(plain.status, 0) << plain.log;
    EXPECT_NE(to_openscad(model, {}).find("for (i = "), std::string::npos);
    EXPECT_EQ(loops.log.find("WARNING"), std::string::npos) << loops.log;
    EXPECT_NEAR(volume_of(loops.mesh) / mesh_volume(model), 1.0, 0.01);
    // The facets of a turned cylinder turn with it.
    EXPECT_NEAR(volume_of(loops.mesh) / volume_of(plain.mesh), 1.0, 1e-3);
  }
}

TEST(OpenScadProgram, RendersInAnyUnit) {
  if (!has_openscad()) GTEST_SKIP() << "needs the openscad program";
  for (const double unit : {0.01, 0.1, 10'000.0}) {
    // A torus without a hole meets itself at its middle, which OpenSCAD takes for no solid.
    Model model{.primitives = {{.id = "ring", .shape = Torus{.major_radius = unit, .minor_radius = unit}},
                               {.id = "pin", .shape = Cylinder{.radius = 0.5 * unit, .height = 4 * unit}}},
                .tree = unite(CsgTree::leaf(0), CsgTree::leaf(1))};
    for (const char* name : {"unit", "unit.csg"}) {
      SCOPED_TRACE(testing::Message() << name << " of " << unit);
      expect_same_solid(name, model, {.facets = 24}, 0.03);
    }
  }
}

TEST(OpenScadProgram, RendersAComplement) {
  if (!has_openscad()) GTEST_SKIP() << "needs the openscad program";
  Model model = parse_model(R"({"format": "cloud2csg", "version": 1, "primitives": [
    {"id": "everything", "type": "box", "size": [2, 2, 2]}], "tree": {"op": "complement", "children": [
    {"primitive": "everything"}]}})");
  const Rendering rendering = render("complement", model, {});
  ASSERT_EQ(rendering.status, 0) << rendering.log;
  EXPECT_NEAR(volume_of(rendering.mesh), 27 - 8, 1e-6) << "a box around the model, less the model";
}

TEST(ExportModel, FollowsTheEnding) {
  const Model model = data_model("m3.json");
  const std::pair<const char*, const char*> expected[] = {{"m3.json", "{\"format\": \"cloud2csg\""},
                                                          {"m3.scad", "// Written by cloud2csg\n// A stand-in"},
                                                          {"m3.csg", "// Written by cloud2csg\n// A stand-in"},
                                                          {"m3.FCMacro", "# Written by cloud2csg\n# A stand-in"},
                                                          {"m3.py", "# Written by cloud2csg\n# A stand-in"},
                                                          {"m3.dot", "// Written by cloud2csg\ndigraph"},
                                                          {"m3.OFF", "OFF\n"},
                                                          {"m3.obj", "v "},
                                                          {"m3.stl", "cloud2csg"}};
  for (const auto& [name, start] : expected) {
    const std::filesystem::path file = temporary(name);
    export_model(file, model, {.meshing = {.resolution = 32}});
    EXPECT_EQ(content_of(file).rfind(start, 0), 0U) << name;
    std::filesystem::remove(file);
  }
}

TEST(ExportModel, MeshesHaveTheModelsVolume) {
  const Model model = data_model("m2.json");
  const std::filesystem::path file = temporary("m2.stl");
  export_model(file, model, {.meshing = {.resolution = 64}});
  const TriangleMesh mesh = read_mesh(file);
  std::filesystem::remove(file);
  EXPECT_TRUE(is_watertight(mesh));
  EXPECT_NEAR(volume_of(mesh) / mesh_volume(model), 1, 0.01);
}

TriangleMesh written_mesh(const Model& model, const ExportOptions& options) {
  const std::filesystem::path file = temporary("written.obj");
  export_model(file, model, options);
  TriangleMesh mesh = read_mesh(file);
  std::filesystem::remove(file);
  return mesh;
}

TEST(ExportModel, MeshesOfExactSolidsHaveFlatFacesAndTrueEdges) {
  if (!has_brep()) GTEST_SKIP() << "built without OpenCASCADE";
  const Model model = test::flange();
  const ExportOptions coarse{.meshing = {.resolution = 32}};
  const TriangleMesh mesh = written_mesh(model, coarse);
  EXPECT_TRUE(is_watertight(mesh));
  EXPECT_NEAR(volume_of(mesh) / mesh_volume(model), 1, 0.01);
  constexpr double k_single_precision = 1e-4;  // of what is written, some 50 from the origin
  for (const double value : implicit_value(*model.tree, model.primitives, mesh.vertices)) {
    EXPECT_LT(std::abs(value), k_single_precision) << "every corner is on the surface";
  }
  const TriangleMesh finer = written_mesh(model, {.meshing = {.resolution = 256}});
  EXPECT_GT(finer.triangles.size(), mesh.triangles.size());
  const TriangleMesh cells = written_mesh(model, {.meshing = coarse.meshing, .exact_meshes = false});
  EXPECT_GT(cells.triangles.size(), 2 * mesh.triangles.size()) << "planes need no cells";
}

TEST(ExportModel, MeshesOfFreeFormsAreContoured) {
  const Model model = data_model("m1.json");
  const MeshingOptions meshing{.resolution = 40};
  const TriangleMesh contour = mesh_surface(model, model_extent(model), meshing);
  EXPECT_EQ(written_mesh(model, {.meshing = meshing}).triangles.size(), contour.triangles.size());
}

/// A block with a bore, a dent and a cone on top, off the origin.
Model block_with_a_bore(double scale) {
  const Eigen::Vector3d place = scale * Eigen::Vector3d(30, -20, 10);
  const auto at = [&](double x, double z) { return Pose{.position = place + scale * Eigen::Vector3d(x, 0, z)}; };
  Model model;
  model.primitives = {
      {.id = "block", .shape = Box{.size = scale * Eigen::Vector3d(4, 2, 1)}, .pose = at(0, 0)},
      {.id = "cone", .shape = Cone{.radius_bottom = 0.8 * scale, .radius_top = 0, .height = scale}, .pose = at(-1, 1)},
      {.id = "bore", .shape = Cylinder{.radius = 0.5 * scale, .height = 2 * scale}, .pose = at(1, 0)},
      {.id = "dent", .shape = Sphere{.radius = 0.4 * scale}, .pose = at(0, 0.5)}};
  const CsgTree body = unite(CsgTree::leaf(0), CsgTree::leaf(1));
  model.tree = subtract(subtract(body, CsgTree::leaf(2)), CsgTree::leaf(3));
  return model;
}

TEST(MeshBrep, IsClosedWhateverTheSizeAndPlace) {
  if (!has_brep()) GTEST_SKIP() << "built without OpenCASCADE";
  for (const double scale : {1e-3, 1.0, 1e4}) {
    const Model model = block_with_a_bore(scale);
    const BrepMesh made = mesh_brep(model);
    EXPECT_TRUE(made.report.is_exact({})) << scale;
    EXPECT_TRUE(is_watertight(made.mesh)) << scale;
    EXPECT_NEAR(volume_of(made.mesh) / made.report.volume, 1, 5e-3) << scale;
  }
}

TEST(MeshBrep, RefusesADeviationThatIsNone) {
  const Model model = data_model("m2.json");
  EXPECT_THROW((void)mesh_brep(model, {.mesh_deviation = 0}), Error);
}

bool is_script(const std::string& ending) {
  return ending == ".scad" || ending == ".csg" || ending == ".FCMacro" || ending == ".py";
}

/// How an export says that it cut a model, by the ending.
std::optional<AlignedBox> cut_of(const std::string& tree, const char* ending) {
  const Model model = parse_model(R"({"format": "cloud2csg", "version": 1, "primitives": [
    {"id": "down", "type": "half_space"}, {"id": "ball", "type": "sphere", "radius": 2},
    {"id": "up", "type": "half_space", "pose": {"position": [0, 0, -1], "quaternion": [0, 1, 0, 0]}},
    {"id": "wave", "type": "expression", "distance": "x", "bounds": [[-1, -1, -1], [1, 1, 1]]}], "tree": )" +
                                  tree + "}");
  const std::filesystem::path file = temporary(std::string("cut") + ending);
  const ExportReport report = export_model(file, model, {.meshing = {.resolution = 16}});
  if (is_script(ending)) {
    EXPECT_EQ(content_of(file).find("is unbounded") != std::string::npos, report.cut_at.has_value());
  }
  std::filesystem::remove(file);
  return report.cut_at;
}

TEST(ExportModel, SaysWhereItCutsWhatHasNoBounds) {
  const auto operation = [](const char* name, const char* children) {
    return std::string(R"({"op": ")") + name + R"(", "children": [)" + children + "]}";
  };
  for (const char* ending : {".stl", ".off", ".obj", ".scad", ".csg", ".FCMacro", ".py"}) {
    for (const std::string& unbounded :
         {std::string(R"({"primitive": "down"})"), operation("complement", R"({"primitive": "ball"})"),
          operation("intersection", R"({"primitive": "down"}, {"primitive": "up"})"), std::string(R"({"op": "full"})"),
          operation("difference", R"({"primitive": "up"}, {"primitive": "wave"})")}) {
      const std::optional<AlignedBox> cut = cut_of(unbounded, ending);
      ASSERT_TRUE(cut.has_value()) << unbounded << ending;
      EXPECT_TRUE(cut->min().allFinite() && cut->max().allFinite());
    }
    for (const std::string& bounded :
         {std::string(R"({"primitive": "ball"})"), std::string(R"({"primitive": "wave"})"),
          std::string(R"({"op": "empty"})"),
          operation("intersection", R"({"primitive": "down"}, {"primitive": "ball"})"),
          operation("complement", R"({"op": "union", "children": [{"op": "complement", "children":
                    [{"primitive": "ball"}]}, {"primitive": "down"}]})")}) {
      const bool can_be_empty = std::string_view(ending) == ".scad" || std::string_view(ending) == ".csg";
      if (bounded.find("empty") != std::string::npos && !can_be_empty) {
        EXPECT_THROW((void)cut_of(bounded, ending), Error) << "the solid is empty";
        continue;
      }
      EXPECT_FALSE(cut_of(bounded, ending).has_value()) << bounded << ending;
    }
  }
  EXPECT_FALSE(cut_of(R"({"primitive": "down"})", ".json").has_value());
  EXPECT_FALSE(cut_of(R"({"primitive": "down"})", ".dot").has_value());
}

TEST(ExportModel, WritesNoMeshWithoutTriangles) {
  const Revolution sliver{.profile = {.paths = {test::regular_path(4, 1)}}, .angle_deg = 0.001};
  Model model{.primitives = {test::placed("sliver", sliver, {0, 0, 0})}, .tree = CsgTree::leaf(0)};
  for (PathCorner& corner : std::get<Revolution>(model.primitives[0].shape).profile.paths[0]) corner.point.x() += 2;
  const std::filesystem::path file = temporary("sliver.off");
  try {
    export_model(file, model, {.exact_meshes = false});
    ADD_FAILURE() << "an empty mesh";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("empty or thinner than a cell; check the tree, or give a larger"),
              std::string::npos);
  }
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(ExportModel, RefusesUnknownEndingsAndMissingTrees) {
  Model model = data_model("m2.json");
  const auto message_for = [&model](const char* name) -> std::string {
    try {
      export_model(temporary(name), model);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(message_for("model.docx").find(".json .scad .csg .FCMacro .py .step .stp .brep .stl .off .obj .3mf .dot"),
            std::string::npos);
  model.tree.reset();
  EXPECT_NE(message_for("model.scad").find("a model with a tree"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(temporary("model.scad")));
  EXPECT_EQ(message_for("primitives.json"), "no error");
  std::filesystem::remove(temporary("primitives.json"));
}

}  // namespace
}  // namespace cloud2csg
