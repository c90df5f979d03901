#include "app/program.hpp"

namespace cloud2csg::test {
namespace {

using Pictures = ProgramTest;

/// Width and height as a PNG's header has them; zeros when it is none.
std::pair<unsigned, unsigned> size_of_png(const std::string& bytes) {
  if (!bytes.starts_with("\x89PNG\r\n\x1a\n") || bytes.size() < 24) return {};
  const auto number = [&bytes](std::size_t place) {
    unsigned value = 0;
    for (std::size_t i = place; i < place + 4; ++i) value = 256 * value + static_cast<unsigned char>(bytes[i]);
    return value;
  };
  return {number(16), number(20)};
}

TEST_F(Pictures, AreWrittenByConvertExtractAndDetect) {
  const std::vector<std::string> small{"--picture-height", "64", "--azimuth", "-30.5", "--elevation", "-10", "--quiet"};
  const auto with = [&small](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), small.begin(), small.end());
    return arguments;
  };
  Outcome outcome = run(with({"convert", shipped("m2.json"), "-o", path("m2.png"), "-o", path("m2.scad")}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(size_of_png(read_file(path("m2.png"))), std::pair(64U, 64U));

  ASSERT_EQ(run({"sample", shipped("m2.json"), "-n", "5000", "-o", path("m2.ply"), "--quiet"}).status, 0);
  outcome = run(with({"extract", path("m2.ply"), "--primitives", shipped("m2.json"), "-o", path("both.png")}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(size_of_png(read_file(path("both.png"))), std::pair(128U, 64U)) << "cloud and solid";

  outcome = run(with({"detect", path("m2.ply"), "-o", path("points.png"), "--picture-width", "100"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(size_of_png(read_file(path("points.png"))), std::pair(100U, 64U));
}

TEST_F(Pictures, TooManyPixelsAreRefusedBeforeTheWork) {
  expect_failure(
      run({"convert", shipped("m2.json"), "-o", path("m2.png"), "--picture-width", "4000", "--picture-height", "2000"}),
      2, {"--picture-height: expected at most 1000 pixels"});
}

TEST_F(Pictures, NeedASolid) {
  const std::string primitives = file("p.json", R"({"format": "cloud2csg", "version": 1, "primitives": []})");
  expect_failure(run({"convert", primitives, "-o", path("p.png")}), 1, {"p.json", "tree"});
  EXPECT_FALSE(std::filesystem::exists(path("p.png")));
}

TEST_F(Pictures, ScadFilesAreModels) {
  const std::string plate =
      file("plate.scad", "module plate() cube([4, 3, 1]); difference() { plate(); cylinder(h = 9, r = 0.5); }");
  const Outcome info = run({"info", plate});
  ASSERT_EQ(info.status, 0) << info.err;
  EXPECT_NE(info.out.find("plate - cylinder"), std::string::npos) << info.out;
  ASSERT_EQ(run({"convert", plate, "-o", path("plate.json")}).status, 0);
  ASSERT_EQ(run({"sample", plate, "-n", "100", "-o", path("plate.ply")}).status, 0);
  expect_failure(run({"convert", file("bad.scad", "cube(1);\nhull() cube(1);"), "-o", path("bad.json")}), 1,
                 {"bad.scad: line 2, column 1: expected a solid", "found 'hull'"});
}

}  // namespace
}  // namespace cloud2csg::test
