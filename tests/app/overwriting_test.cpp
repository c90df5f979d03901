#include "app/program.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/export.hpp"
#include "cloud2csg/point_cloud.hpp"
#include "cloud2csg/view.hpp"
#include "io/formats/formats.hpp"

namespace cloud2csg::test {
namespace {

class Overwriting : public ProgramTest {};

/// Endings that models are written with here.
std::vector<std::string> endings() {
  std::vector<std::string> endings{".json", ".scad", ".csg", ".FCMacro", ".py", ".stl",
                                   ".off",  ".obj",  ".3mf", ".dot",     ".png"};
  if (has_report_page()) endings.emplace_back(".html");
  if (has_brep()) endings.insert(endings.end(), {".step", ".stp", ".brep"});
  return endings;
}

Model small_model() {
  Model model{.primitives = {{.id = "ball", .shape = Sphere{.radius = 1}}}};
  model.tree = parse_tree("ball", model.primitives);
  return model;
}

void write(const std::filesystem::path& file, const Model& model) {
  if (file.extension() == ".html") return write_report(file, {.title = "ball", .model = model});
  if (file.extension() == ".png") return write_picture(file, {.model = model});
  (void)export_model(file, model, {.meshing = {.resolution = 8}, .exact_meshes = false});
}

TEST_F(Overwriting, TakesFilesOfItsOwnKindAndEmptyOnes) {
  const Model model = small_model();
  for (const std::string& ending : endings()) {
    const std::string out = file("m" + ending, "");
    EXPECT_NO_THROW(check_overwriting(out)) << ending;
    write(out, model);
    EXPECT_NO_THROW(check_overwriting(out)) << ending;
    EXPECT_GT(std::filesystem::file_size(out), 20U) << ending;
  }
}

TEST_F(Overwriting, LeavesOtherFilesAlone) {
  for (const std::string& ending : endings()) {
    for (const std::string work :
         {"my notes", "<!doctype html><title>mine</title>", "difference() { a(); }", "1 2 3"}) {
      EXPECT_THROW(check_overwriting(file("work" + ending, work)), Error) << ending << ": " << work;
    }
  }
}

TEST_F(Overwriting, TellsWhatToDo) {
  const std::string work = file("work.scad", "cube(1);\n");
  const Outcome refused = run({"convert", shipped("m1.json"), "-o", work});
  expect_failure(refused, 1,
                 {"work.scad: already exists and is no OpenSCAD script of cloud2csg", "choose another name"});
  EXPECT_EQ(read_file(work), "cube(1);\n");
}

TEST_F(Overwriting, TheProgramTakesItsOwnScript) {
  const std::string out = path("m.scad");
  for (int k = 0; k < 2; ++k) EXPECT_EQ(run({"convert", shipped("m1.json"), "-o", out}).status, 0);
}

TEST_F(Overwriting, ModelsMayBeWithoutSpaces) {
  EXPECT_NO_THROW(check_overwriting(file("c.json", R"({"format":"cloud2csg","version":1,"primitives":[]})")));
}

TEST_F(Overwriting, ModelsAndStatisticsAreTwoKinds) {
  ASSERT_EQ(run({"sample", shipped("m1.json"), "-n", "500", "-o", path("c.ply")}).status, 0);
  const auto extract = [&](const std::string& model, const std::string& statistics) {
    return run(
        {"extract", path("c.ply"), "--primitives", shipped("m1.json"), "-o", path(model), "--stats", path(statistics)});
  };
  ASSERT_EQ(extract("m.json", "s.json").status, 0);
  EXPECT_NO_THROW(check_overwriting(path("m.json")));
  EXPECT_NO_THROW(check_overwriting(path("s.json"), true));
  expect_failure(extract("s.json", "new.json"), 1, {"s.json: already exists and is no model of cloud2csg"});
  expect_failure(extract("new.json", "m.json"), 1, {"m.json: already exists and is no file of statistics"});
}

TEST_F(Overwriting, MeshesOfOtherProgramsAreOfTheirKind) {
  const std::vector<std::pair<std::string, std::string>> theirs{
      {"a.stl", "solid part\n facet normal 0 0 1\n  outer loop\n"},
      {"b.stl", std::string(80, 'x') + std::string("\1\0\0\0", 4) + std::string(50, '\0')},
      {"c.obj", "# made elsewhere\nmtllib a.mtl\no part\nv 1 2 3\nvn 0 0 1\nf 1 2 3\n"},
      {"d.off", "# made elsewhere\nCOFF\n3 1 0\n"},
      {"e.ply", "ply\r\nformat ascii 1.0\r\nelement vertex 1\r\n"},
      {"f.step", "ISO-10303-21;\nHEADER;\n"}};
  for (const auto& [name, text] : theirs) EXPECT_NO_THROW(check_overwriting(file(name, text))) << name;
  EXPECT_THROW(check_overwriting(file("g.stl", std::string(80, 'x') + std::string("\2\0\0\0", 4) + "short")), Error);
  EXPECT_THROW(check_overwriting(file("h.obj", "v 1 2 3\nvery much my notes\n")), Error);
}

TEST_F(Overwriting, CloudsTakeTheirOwnKind) {
  PointCloud cloud;
  for (int k = 0; k < 500; ++k) cloud.positions.push_back({0.1 * k, 1.0 / (k + 1), -3.0});
  for (const std::string ending : {".ply", ".pcd", ".xyz", ".txt", ".pts"}) {
    const std::string out = path("c" + ending);
    write_point_cloud(out, cloud);
    EXPECT_NO_THROW(check_overwriting(out)) << ending;
    EXPECT_THROW(check_overwriting(file("p" + ending, "3 apples, my notes\n")), Error) << ending;
  }
}

}  // namespace
}  // namespace cloud2csg::test
