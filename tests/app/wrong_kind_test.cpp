#include "app/program.hpp"

namespace cloud2csg::test {
namespace {

/// A file of the wrong kind is told what it is, and which command takes it.
class WrongKind : public ProgramTest {
 protected:
  WrongKind() {
    (void)file("cloud.ply", k_ply_head + std::string("end_header\n0 0 0\n"));
    (void)file("mesh.ply",
               k_ply_head + std::string("element face 1\nproperty list uchar int v\nend_header\n0 0 0\n3 0 0 0\n"));
    (void)file("mesh.stl", "solid part\n facet normal 0 0 1\n");
    (void)file("part.step", "ISO-10303-21;\nHEADER;\n");
    (void)file("graph.dot", "digraph { a -> b }\n");
    (void)file("script.py", "import cadquery\n");
    (void)file("page.html", "<!doctype html>\n");
    (void)file("picture.png", "\x89PNG\r\n");
    (void)file("numbers.json", R"({"unassigned_points": 3})");
  }

  void expect_told(const std::vector<std::string>& arguments, const std::vector<std::string>& parts) {
    const Outcome refused = run(arguments);
    expect_failure(refused, 1, parts);
    EXPECT_LE(refused.err.size(), 200 + folder().string().size()) << refused.err;
  }

 private:
  static constexpr const char* k_ply_head =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
};

TEST_F(WrongKind, IsToldByTheEnding) {
  expect_told({"extract", shipped("m1.json"), "-o", path("x.scad")},
              {"m1.json: expected a point cloud or a mesh, found a model; 'convert' writes it"});
  expect_told({"convert", path("mesh.stl"), "-o", path("x.scad")},
              {"mesh.stl: expected a model, found a mesh; 'extract' makes a model from it"});
  expect_told({"extract", path("cloud.ply"), "--primitives", path("mesh.stl"), "-o", path("x.scad")},
              {"mesh.stl: expected a model, found a mesh"});
  expect_told({"extract", path("mesh.stl"), "--primitives", path("mesh.stl"), "-o", path("x.scad")},
              {"mesh.stl: expected a model, found a mesh"});
  expect_told({"info", path("picture.png")},
              {"picture.png: expected a model or a mesh or a point cloud, found a picture"});
  expect_told({"extract", path("part.step"), "-o", path("x.json")},
              {"found an exact solid; no command reads it; export"});
  expect_told({"convert", path("script.py"), "-o", path("x.json")}, {"found a script; no command reads it"});
  expect_told({"compare", shipped("m1.json"), path("graph.dot")}, {"found a graph; no command reads it; Graphviz"});
  expect_told({"sample", path("page.html"), "-o", path("x.ply")}, {"found a page; no command reads it; a browser"});
}

TEST_F(WrongKind, IsToldByTheContent) {
  expect_told({"convert", path("cloud.ply"), "-o", path("x.scad")},
              {"cloud.ply: expected a model, found a point cloud"});
  expect_told({"convert", path("mesh.ply"), "-o", path("x.scad")}, {"mesh.ply: expected a model, found a mesh"});
  expect_told({"convert", path("numbers.json"), "-o", path("x.scad")},
              {"numbers.json: expected a model, found statistics by its content; no command reads it"});
  expect_told({"extract", file("lies.ply", "\x89PNG\r\n"), "-o", path("x.scad")},
              {"lies.ply: expected a point cloud or a mesh, found a picture by its content"});
  expect_told({"info", file("unknown", "\x89PNG\r\n")}, {"unknown: expected", "found a picture by its content"});
}

TEST_F(WrongKind, AnEndingThatLiesIsToldTheRightOne) {
  expect_told({"extract", file("lies.ply", "solid part\n facet normal 0 0 1\n"), "-o", path("x.scad")},
              {"lies.ply: its ending does not match its content (STL file); name it lies.stl"});
  expect_told({"info", file("unknown", "OFF\n3 1 0\n")},
              {"unknown: its ending does not match its content (OFF file)", "unknown.off"});
}

TEST_F(WrongKind, WhatIsNothingIsToldWhereItIsWrong) {
  expect_told({"compare", shipped("m1.json"), file("notes.txt", "buy apples\n")}, {"notes.txt: line 1: expected"});
  expect_told(
      {"compare", shipped("m1.json"), file("notes.md", "buy apples\n")},
      {"notes.md: expected a model (.json .scad .csg) or a mesh (.stl .off .obj .3mf .glb .ply) or a point cloud "
       "(.ply .pcd .xyz .txt .xyzn .pts), found the ending '.md'"});
}

TEST_F(WrongKind, OutputsAreToldBeforeAnyWork) {
  expect_failure(run({"sample", path("missing.json"), "-o", path("x.stl")}), 2,
                 {"x.stl: a mesh ('.stl') cannot be written by this command; use one of .ply .pcd"});
  expect_failure(run({"convert", path("missing.json"), "-o", path("x.glb")}), 2,
                 {"x.glb: a mesh ('.glb') cannot be written by this command"});
  expect_failure(run({"detect", path("cloud.ply"), "-o", path("x.scad")}), 2, {"use one of .json .ply .png"});
}

}  // namespace
}  // namespace cloud2csg::test
