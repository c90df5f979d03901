#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "cloud2csg/advanced/brep.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/export.hpp"
#include "core/base/files.hpp"
#include "shape/mesh/model_extent.hpp"
#include "support/every_type.hpp"
#include "support/flange.hpp"
#include "support/known_solids.hpp"
#include "support/outside_program.hpp"

namespace cloud2csg {
namespace {

/// Points of a lattice that are not so near the surface that its facets matter, and whether they are in the solid.
struct Probe {
  Points points;
  std::string inside;
};

Probe probe_of(const Model& model) {
  const AlignedBox extent = model_extent(model);
  const Points all = test::lattice(extent, 10);
  const std::vector<double> values = implicit_value(*model.tree, model.primitives, all);
  Probe probe;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::abs(values[i]) < 0.01 * extent.sizes().maxCoeff()) continue;
    probe.points.push_back(all[i]);
    probe.inside += values[i] < 0 && extent.contains(all[i]) ? '1' : '0';
  }
  return probe;
}

void write_points(const std::filesystem::path& file, const Points& points) {
  std::string lines;
  for (std::size_t i = 0; i < points.size(); ++i) {
    lines += fmt::format("{} {} {}\n", points.x[i], points.y[i], points.z[i]);
  }
  write_text_file(file, lines);
}

/// Both scripts, run by Python against modules that know membership only, say of each point what the tree says.
void expect_scripts_make(const Model& model) {
  const Probe probe = probe_of(model);
  ASSERT_NE(probe.inside.find('1'), std::string::npos) << "the lattice is too coarse for this model";
  ASSERT_NE(probe.inside.find('0'), std::string::npos) << "the lattice is too coarse for this model";
  const test::ScratchFolder folder;
  write_points(folder.file("points"), probe.points);
  for (const char* script : {"part.py", "part.FCMacro"}) {
    export_model(folder.file(script), model);
    const test::Run run = test::judge(folder, script, "points");
    ASSERT_EQ(run.status, 0) << script << "\n" << run.output;
    EXPECT_EQ(run.output.substr(0, run.output.find('\n')), probe.inside) << script;
  }
}

Model model_of(const std::string& primitives, const std::string& formula) {
  Model model = parse_model(R"({"format": "cloud2csg", "version": 1, "primitives": [)" + primitives + "]}");
  model.tree = parse_tree(formula, model.primitives);
  return model;
}

TEST(PythonScripts, MakeEveryType) {
  expect_scripts_make(test::model_of_every_type());
}

TEST(PythonScripts, MakeTheModelsOfThePaper) {
  for (const char* name : {"m0", "m1", "m2"}) expect_scripts_make(test::paper_model(name));
}

TEST(PythonScripts, MakeWhatRepeats) {
  expect_scripts_make(test::flange());
}

TEST(PythonScripts, MakeCommonPartsAndComplements) {
  const std::string balls = R"({"id": "a", "type": "sphere", "radius": 2},
    {"id": "b", "type": "sphere", "radius": 2, "pose": {"position": [1.5, 0, 0]}},
    {"id": "c", "type": "sphere", "radius": 2, "pose": {"position": [0.7, 1.4, 0]}},
    {"id": "down", "type": "half_space", "pose": {"position": [0, 0.5, 0], "quaternion": [0.8, 0.6, 0, 0]}})";
  for (const char* formula : {"a & b & c", "(a & b & c) - down", "~a", "~(a | b)", "~a & ~b", "a | ~b", "down",
                              "down | a", "~down", "a", "(a - b) | (b - a)", "a & (b | (c - a))", "full - a"}) {
    SCOPED_TRACE(formula);
    expect_scripts_make(model_of(balls, formula));
  }
}

TEST(PythonScripts, MakeHollowAndSeveralShells) {
  // A ball in a hollow ball, and one beside it: four shells.
  expect_scripts_make(model_of(
      R"json({"id": "hollow", "type": "expression", "bounds": [[-3, -3, -3], [6, 3, 3]], "distance":
         "min(min(abs(sqrt(x^2 + y^2 + z^2) - 2) - 0.5, sqrt(x^2 + y^2 + z^2) - 0.8), sqrt((x-4.5)^2 + y^2 + z^2) - 1)"})json",
      "hollow"));
}

TEST(PythonScripts, RefuseTheEmptySolid) {
  const Model model = model_of(R"({"id": "a", "type": "sphere", "radius": 2})", "a & empty");
  for (const auto to_script : {to_freecad_macro, to_cadquery}) {
    EXPECT_THROW((void)to_script(model, {}), Error);
    EXPECT_THROW((void)to_script({.primitives = model.primitives, .tree = CsgTree::leaf(0)}, {.facet_resolution = 2}),
                 Error);
  }
}

TEST(PythonScripts, LongChainsNeedNoStack) {
  const Model model = model_of(R"({"id": "a", "type": "sphere", "radius": 2}, {"id": "b", "type": "sphere",
    "radius": 2, "pose": {"position": [1, 0, 0]}})",
                               "a");
  CsgTree tree = CsgTree::leaf(0);
  for (int i = 0; i < 3000; ++i) tree = i % 2 == 0 ? unite(CsgTree::leaf(1), tree) : intersect(CsgTree::leaf(1), tree);
  for (const auto to_script : {to_freecad_macro, to_cadquery}) {
    EXPECT_LT(to_script({.primitives = model.primitives, .tree = tree}, {}).size(), 1'000'000U);
  }
}

TEST(CadQueryScript, HasItsValuesAtTheTop) {
  const Model model = test::flange();
  const std::string text = to_cadquery(model);
  EXPECT_LT(text.find("bore_radius = 6\n"), text.find("def ")) << text;
  EXPECT_NE(text.find("bore = cylinder(bore_radius, bore_height, bore_position)\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("def sphere"), std::string::npos) << "what is not used is not there";
}

std::string freecad() {
  for (const char* name : {"freecadcmd", "FreeCADCmd"}) {
    if (test::has_program(name)) return name;
  }
  return {};
}

double volume_of_mesh(const Model& model) {
  return volume_of(mesh_surface(model, bounds_of(model), {.resolution = 128}));
}

TEST(FreeCadProgram, ReadsTheFlatLanguageWithTrueSolids) {
  const std::string program = freecad();
  if (program.empty()) GTEST_SKIP() << "needs FreeCAD's freecadcmd (Debian: freecad-python3)";
  for (const Model& model : {test::paper_model("m0"), test::model_of_every_type()}) {
    const test::ScratchFolder folder;
    export_model(folder.file("part.csg"), model, {.openscad = {.mesh_resolution = 16}});
    write_text_file(folder.file("read.py"), R"(import FreeCAD, importCSG
importCSG.open("part.csg")
document = FreeCAD.ActiveDocument
document.recompute()
print("VOLUME", sum(thing.Shape.Volume for thing in document.RootObjects))
print("KINDS", *(thing.TypeId for thing in document.Objects), "END")
)");
    const test::Run run = test::run_in(folder, "HOME=. timeout 300 " + program + " read.py");
    const std::size_t place = run.output.find("VOLUME ");
    ASSERT_NE(place, std::string::npos) << run.output;
    EXPECT_NEAR(std::stod(run.output.substr(place + 7)) / volume_of_mesh(model), 1, 0.01);
    EXPECT_NE(run.output.find(" Part::Sphere "), std::string::npos) << run.output;
  }
}

/// What FreeCAD sees in a .step file: "VOLUME x SOLIDS n VALID True".
std::string seen_in_step(const test::ScratchFolder& folder, const std::string& program) {
  write_text_file(folder.file("read.py"), R"(import Part
shape = Part.Shape()
shape.read("part.step")
print("VOLUME", shape.Volume, "SOLIDS", len(shape.Solids), "VALID", shape.isValid())
)");
  const std::string output = test::run_in(folder, "HOME=. timeout 300 " + program + " read.py").output;
  const std::size_t place = output.find("VOLUME ");
  EXPECT_NE(place, std::string::npos) << output;
  return place == std::string::npos ? "" : output.substr(place, output.find('\n', place) - place);
}

TEST(FreeCadProgram, OpensStepFilesOfTheTreesVolume) {
  const std::string program = freecad();
  if (program.empty()) GTEST_SKIP() << "needs FreeCAD's freecadcmd (Debian: freecad-python3)";
  if (!has_brep()) GTEST_SKIP() << "built without OpenCASCADE";
  for (const Model& model : {test::paper_model("m0"), test::paper_model("m2"), test::flange()}) {
    const test::ScratchFolder folder;
    const ExportReport report = export_model(folder.file("part.step"), model, {.brep = {.name = "a part ('a')"}});
    ASSERT_TRUE(report.brep.has_value());
    const std::string seen = seen_in_step(folder, program);
    ASSERT_NE(seen.find("VALID True"), std::string::npos) << seen;
    EXPECT_NEAR(std::stod(seen.substr(7)) / report.brep->tree_volume, 1, 1e-3) << seen;
  }
}

TEST(FreeCadProgram, SeesTheSameSolidsWhateverTheirNames) {
  const std::string program = freecad();
  if (program.empty()) GTEST_SKIP() << "needs FreeCAD's freecadcmd (Debian: freecad-python3)";
  if (!has_brep()) GTEST_SKIP() << "built without OpenCASCADE";
  const test::ScratchFolder folder;
  Model model = test::flange();
  export_model(folder.file("part.step"), model, {.brep = {.name = "part", .with_primitives = true}});
  const std::string harmless = seen_in_step(folder, program);
  model.primitives[0].id = "rod ('left')";
  model.primitives[1].id = "6', long";
  export_model(folder.file("part.step"), model, {.brep = {.name = "a part ('a')", .with_primitives = true}});
  EXPECT_EQ(seen_in_step(folder, program), harmless);
}

TEST(FreeCadProgram, MakesTheTreesVolume) {
  const std::string program = freecad();
  if (program.empty()) GTEST_SKIP() << "needs FreeCAD's freecadcmd (Debian: freecad-python3)";
  for (const Model& model :
       {test::paper_model("m0"), test::paper_model("m1"), test::model_of_every_type(), test::flange()}) {
    const test::ScratchFolder folder;
    export_model(folder.file("part.FCMacro"), model);
    std::ofstream(folder.file("part.FCMacro"), std::ios::app)
        << "print('VOLUME', part.Shape.Volume, 'VALID', part.Shape.isValid())\n";
    const test::Run run = test::run_in(folder, "HOME=. timeout 300 " + program + " part.FCMacro");
    const std::size_t place = run.output.find("VOLUME ");
    ASSERT_NE(place, std::string::npos) << run.output;
    EXPECT_NE(run.output.find("VALID True"), std::string::npos) << run.output;
    EXPECT_NEAR(std::stod(run.output.substr(place + 7)) / volume_of_mesh(model), 1, 0.01);
  }
}

}  // namespace
}  // namespace cloud2csg
