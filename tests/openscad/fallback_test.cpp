#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "cloud2csg/error.hpp"
#include "cloud2csg/model.hpp"
#include "core/base/files.hpp"

namespace cloud2csg {
namespace {

/// Files for OpenSCAD, and what becomes of them.
class OpenScadFallback : public ::testing::Test {
 protected:
  OpenScadFallback()
      : folder_(std::filesystem::temp_directory_path() / ("cloud2csg scad fallback " + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~OpenScadFallback() override { std::filesystem::remove_all(folder_); }

  static bool has_openscad() {
    return std::system("command -v openscad > /dev/null 2>&1") == 0;  // NOLINT: a fixed command
  }

  [[nodiscard]] std::filesystem::path file(const std::string& text, const std::string& name = "part.scad") const {
    write_text_file(folder_ / name, text);
    return folder_ / name;
  }

  [[nodiscard]] std::string refusal(const std::string& text, const std::string& name = "part.scad") const {
    try {
      (void)read_model(file(text, name));
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }

  [[nodiscard]] std::string path() const { return (folder_ / "part.scad").string(); }

 private:
  std::filesystem::path folder_;
};

TEST_F(OpenScadFallback, OpenScadFlattensWhatIsNotReadHere) {
  if (!has_openscad()) GTEST_SKIP() << "needs the openscad program";
  const std::vector<std::pair<std::string, std::string>> programs{
      {"function half(x) = x / 2; sphere(half(3));", "sphere(1.5);"},
      {"module pin(r, h = 2) cylinder(r = r, h = h); pin(1); translate([3, 0, 0]) pin(0.5, h = 4);",
       "cylinder(r = 1, h = 2); translate([3, 0, 0]) cylinder(r = 0.5, h = 4);"},
      {"module twice() { children(0); translate([3, 0, 0]) children(0); } twice() sphere(1);",
       "sphere(1); translate([3, 0, 0]) sphere(1);"},
      {"a = 2; if (a > 1) cube(a); else sphere(a);", "cube(2);"},
      {"for (x = [for (i = [0 : 2]) i * i]) translate([3 * x, 0, 0]) sphere(1);",
       "for (x = [0, 1, 4]) translate([3 * x, 0, 0]) sphere(1);"},
      {"sizes = [1, 2, 3]; cube(sizes[1]);", "cube(2);"},
      {"module plate() { half = 7 % 4; cube(half); } plate();", "cube(3);"},
      {"color(\"red\") sphere(d = 3);", "sphere(1.5);"},
      {"let (a = 2) cube(a);", "cube(2);"},
      {"a = 1; a = 2; cube(a);", "cube(2);"},
      {"cube(1); !cube(2);", "cube(2);"},
      {"cube(1, wide = 3);", "cube(1);"},
  };
  for (const auto& [program, plain] : programs) {
    SCOPED_TRACE(program);
    const Model model = read_model(file(program));
    const Model expected = parse_openscad(plain);
    ASSERT_EQ(model.primitives.size(), expected.primitives.size());
    EXPECT_EQ(leaf_count(*model.tree), leaf_count(*expected.tree));
    for (std::size_t i = 0; i < model.primitives.size(); ++i) {
      EXPECT_EQ(type_name(model.primitives[i].shape), type_name(expected.primitives[i].shape));
      const AlignedBox box = bounds(model.primitives[i]);
      EXPECT_TRUE(box.isApprox(bounds(expected.primitives[i]), 1e-5)) << box.sizes().transpose();
    }
    ASSERT_FALSE(model.warnings.empty());
    EXPECT_NE(model.warnings[0].find(
                  "OpenSCAD flattened part.scad, which loses names and digits beyond six. The reason is at line 1"),
              std::string::npos)
        << model.warnings[0];
  }
}

TEST_F(OpenScadFallback, FindsWhatAFileIncludes) {
  if (!has_openscad()) GTEST_SKIP() << "needs the openscad program";
  (void)file("module pin(r) cylinder(r = r, h = 2);", "pins.scad");
  EXPECT_EQ(read_model(file("include <pins.scad>\npin(1);")).primitives.at(0).id, "cylinder");
  EXPECT_EQ(read_model(file("use <pins.scad>\npin(1);", "-o with 'quotes'.scad")).primitives.size(), 1U);
}

TEST_F(OpenScadFallback, PassesOnWhatOpenScadWarnsOf) {
  if (!has_openscad()) GTEST_SKIP() << "needs the openscad program";
  const Model model = read_model(file("include <missing.scad>\nsphere(1); bolt();"));
  ASSERT_EQ(model.warnings.size(), 3U);
  EXPECT_NE(model.warnings[1].find("OpenSCAD says: Can't open include file 'missing.scad'"), std::string::npos);
  EXPECT_NE(model.warnings[2].find("unknown module 'bolt'"), std::string::npos);
}

TEST_F(OpenScadFallback, TellsWhyThereIsNoModel) {
  if (!has_openscad()) GTEST_SKIP() << "needs the openscad program";
  const std::string syntax = refusal("cube(1;");
  EXPECT_NE(syntax.find("part.scad: line 1, column 8: expected a closing bracket"), std::string::npos) << syntax;
  EXPECT_NE(syntax.find("; OpenSCAD says: Parser error"), std::string::npos) << syntax;
  EXPECT_NE(refusal("assert(false);").find("OpenSCAD says: Assertion 'false' failed"), std::string::npos);
  EXPECT_EQ(refusal("linear_extrude(height = 2, twist = 90) square(1);"),
            path() +
                ": line 1, column 36: expected an extrusion without a twist; extract a tree from a mesh of it "
                "(openscad -o part.stl)");
  EXPECT_EQ(refusal("function f(x) = x; hull() sphere(f(1));"),
            path() +
                ": flattened by OpenSCAD: expected a solid, a map or an operation, found 'hull'; extract a tree from "
                "a mesh of it (openscad -o part.stl)");
  EXPECT_NE(refusal("sphere(d = 3);", "part.csg").find("let OpenSCAD flatten it"), std::string::npos) << "only .scad";
}

TEST_F(OpenScadFallback, TellsWhatToInstall) {
  const std::string path = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe): one thread
  ::setenv("PATH", "/nowhere", 1);               // NOLINT(concurrency-mt-unsafe)
  const std::string message = refusal("cube(1);\nmodule pin(r) cylinder(r = r); pin(1);");
  ::setenv("PATH", path.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
  EXPECT_NE(
      message.find("part.scad: line 2, column 12: expected a module without parameters, found 'r'; install OpenSCAD"),
      std::string::npos)
      << message;
}

}  // namespace
}  // namespace cloud2csg
