#include "app/program.hpp"

namespace cloud2csg::test {
namespace {

constexpr const char* k_sphere = R"({"id": "s", "type": "sphere", "radius": 1})";

std::string model_of(const std::string& primitives, const std::string& tree = R"({"primitive": "s"})") {
  return R"({"format": "cloud2csg", "version": 1, "primitives": [)" + primitives + R"(], "tree": )" + tree + "}";
}

struct BadModel {
  const char* name;
  std::string content;
  std::vector<std::string> message;
};

class BadModels : public ProgramTest, public ::testing::WithParamInterface<BadModel> {};

TEST_P(BadModels, AreRefusedWithThePlace) {
  const std::string model = file("bad.json", GetParam().content);
  std::vector<std::string> parts{model};
  for (const std::string& part : GetParam().message) parts.push_back(part);
  expect_failure(run({"convert", model, "-o", path("out.scad")}), 1, parts);
  expect_failure(run({"sample", model, "-o", path("out.ply")}), 1, parts);
  expect_failure(run({"info", model}), 1, parts);
  EXPECT_EQ(files(), std::vector<std::string>{"bad.json"});
}

INSTANTIATE_TEST_SUITE_P(
    All, BadModels,
    ::testing::Values(
        BadModel{"NotJson", R"({"format": "cloud2csg", )", {}},  //
        BadModel{"NotAModel", R"([1, 2])", {}},
        BadModel{"UnknownField", R"({"format": "cloud2csg", "version": 1, "primitives": [], "colour": 1})", {"colour"}},
        BadModel{"UnknownType", model_of(R"({"id": "s", "type": "blob", "radius": 1})"), {"/primitives/0", "blob"}},
        BadModel{"DuplicateId", model_of(std::string(k_sphere) + "," + k_sphere), {"/primitives/1/id", "s"}},
        BadModel{"DanglingId", model_of(k_sphere, R"({"primitive": "t"})"), {"/tree/primitive", "t"}},
        BadModel{
            "NegativeRadius", model_of(R"({"id": "s", "type": "sphere", "radius": -1})"), {"/primitives/0/radius"}},
        BadModel{"ZeroSize", model_of(R"({"id": "s", "type": "box", "size": [1, 0, 1]})"), {"/primitives/0/size"}},
        BadModel{"NotANumber", model_of(R"({"id": "s", "type": "sphere", "radius": NaN})"), {}},
        BadModel{"TooLargeForANumber", model_of(R"({"id": "s", "type": "sphere", "radius": 1e999})"), {}}),
    [](const auto& instance) { return std::string(instance.param.name); });

using BadInput = ProgramTest;

TEST_F(BadInput, MissingFiles) {
  const std::string missing = path("missing.json");
  expect_failure(run({"convert", missing, "-o", path("x.scad")}), 1, {missing, "No such file"});
  expect_failure(run({"info", path("missing.ply")}), 1, {path("missing.ply"), "No such file"});
  expect_failure(run({"compare", missing, shipped("m1.json")}), 1, {missing});
  expect_failure(run({"extract", path("c.ply"), "--primitives", missing, "-o", path("x.json")}), 1, {missing});
  expect_failure(run({"extract", path("c.ply"), "--primitives", shipped("m1.json"), "-o", path("x.json")}), 1,
                 {path("c.ply"), "No such file"});
}

TEST_F(BadInput, UnknownEndings) {
  const std::string odd = file("cloud.doc", "1 2 3\n");
  expect_failure(run({"info", odd}), 1, {odd, ".doc"});
  expect_failure(run({"extract", odd, "--primitives", shipped("m1.json"), "-o", path("x.json")}), 1, {odd, ".doc"});
}

TEST_F(BadInput, FilesNamedTwice) {
  const std::string same = path("same.json");
  expect_failure(run({"sample", shipped("m1.json"), "-o", path("a.ply"), "-o", path("a.ply")}), 2, {"a.ply", "twice"});
  expect_failure(run({"extract", path("a.ply"), "--primitives", shipped("m1.json"), "-o", same, "--stats", same}), 2,
                 {"same.json", "twice"});
  EXPECT_FALSE(std::filesystem::exists(same));
}

TEST_F(BadInput, PicturesTooLargeAreWrongUsage) {
  expect_failure(
      run({"convert", shipped("m1.json"), "-o", path("x.png"), "--picture-width", "4096", "--picture-height", "4096"}),
      2, {"--picture-height: expected at most"});
}

TEST_F(BadInput, WhatATerminalObeysIsEscaped) {
  const std::string model = file("m.json", R"({"format": "cloud2csg", "version": 1, "description": "a\u001b[2J\u202eb",
      "primitives": [{"id": "a", "type": "sphere", "radius": 1}]})");
  const Outcome told = run({"info", model});
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_NE(told.out.find("a\\x1b[2J\\u202eb"), std::string::npos) << told.out;
  expect_failure(run({"info", path("no\x1b[2J.ply")}), 1, {"no\\x1b[2J.ply"});
}

TEST_F(BadInput, OutputsAreCheckedFirst) {
  // The inputs are missing too: the message must be about the outputs, which are looked at before any work.
  const std::string model = path("missing.json");
  const auto convert_to = [&](const std::string& out) {
    return run({"convert", model, "-o", path("x.stl"), "-o", out});
  };
  expect_failure(convert_to(path("x.doc")), 2, {"x.doc", ".doc", ".scad"});
  expect_failure(convert_to(path("x")), 2, {"no ending", ".scad"});
  expect_failure(convert_to(path("nowhere/x.scad")), 1, {"nowhere/x.scad", "no folder"});
  std::filesystem::create_directory(folder() / "f.scad");
  expect_failure(convert_to(path("f.scad")), 1, {"f.scad", "is a folder"});
  expect_failure(run({"sample", model, "-o", path("x.stl")}), 2, {"x.stl", ".ply"});
  expect_failure(run({"extract", "c.ply", "--primitives", model, "-o", path("x.json"), "--stats", path("no/s.json")}),
                 1, {"no/s.json", "no folder"});
}

TEST_F(BadInput, CloudWithoutNormals) {
  const std::string cloud = file("cloud.xyz", "0 0 1\n0 1 0\n1 0 0\n");
  expect_failure(run({"extract", cloud, "--primitives", shipped("m1.json"), "-o", path("x.json"), "--quiet"}), 1,
                 {cloud, "no normals", "save outward normals"});
  EXPECT_EQ(files(), std::vector<std::string>{"cloud.xyz"});
}

TEST_F(BadInput, NoPointNearAnyPrimitive) {
  std::string points;
  for (int i = 0; i < 100; ++i) points += std::to_string(1000 + i) + " 1000 1000 0 0 1\n";
  const std::string cloud = file("far.xyz", points);
  expect_failure(run({"extract", cloud, "--primitives", shipped("m1.json"), "-o", path("x.json"), "--quiet"}), 1,
                 {cloud, shipped("m1.json"), "no point"});
  EXPECT_EQ(files(), std::vector<std::string>{"far.xyz"});
}

TEST_F(BadInput, NoPrimitives) {
  const std::string model = file("none.json", R"({"format": "cloud2csg", "version": 1, "primitives": []})");
  const std::string cloud = file("one.xyz", "0 0 1 0 0 1\n");
  expect_failure(run({"extract", cloud, "--primitives", model, "-o", path("x.json"), "--quiet"}), 1,
                 {model, "no primitives"});
}

TEST_F(BadInput, SolidsWithoutSurfaceAreNamed) {
  const std::string half = file("half.json", model_of(R"({"id": "s", "type": "half_space"})"));
  expect_failure(run({"sample", half, "-o", path("x.ply"), "--quiet"}), 1, {half, "unbounded"});
  expect_failure(run({"compare", shipped("m1.json"), half, "--quiet"}), 1, {half, "unbounded"});
}

TEST_F(BadInput, CloudThatIsCutOff) {
  const std::string cloud = file("cut.ply",
                                 "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                 "property float z\nend_header\n0 0 0\n1 1 1\n");
  expect_failure(run({"info", cloud}), 1, {cloud});
}

TEST_F(BadInput, ModelWithoutATree) {
  const std::string model =
      file("flat.json", R"({"format": "cloud2csg", "version": 1, "primitives": [)" + std::string(k_sphere) + "]}");
  expect_failure(run({"sample", model, "-o", path("x.ply")}), 1, {model, "tree"});
  expect_failure(run({"convert", model, "-o", path("x.scad")}), 1, {model, "/tree"});
  expect_failure(run({"compare", model, shipped("m1.json"), "--quiet"}), 1, {model, "tree"});
  EXPECT_EQ(run({"convert", model, "-o", path("x.json"), "--quiet"}).status, 0);
}

TEST_F(BadInput, FullDiskLeavesNothingBehind) {
  // A limit on the size of files makes writing fail half-way, as a full disk does. In units of 512 or 1024 bytes.
  const std::string limit = "ulimit -f 16";
  expect_failure(run({"sample", shipped("m2.json"), "-n", "20000", "-o", path("x.ply"), "--quiet"}, limit), 1,
                 {path("x.ply"), "cannot be written", "File too large"});
  EXPECT_TRUE(files().empty());
  const std::string before = "solid older\nendsolid older\n";
  const std::string older = file("x.stl", before);
  expect_failure(run({"convert", shipped("m2.json"), "-o", older, "--quiet"}, limit), 1, {older, "cannot be written"});
  EXPECT_EQ(files(), std::vector<std::string>{"x.stl"});
  EXPECT_EQ(read_file(older), before);
}

TEST_F(BadInput, AllOutputsOrNone) {
  const std::string limit = "ulimit -f 32";
  const std::string older = file("m.json", R"({"format": "cloud2csg", "of": "an older result"})");
  expect_failure(
      run({"convert", shipped("m1.json"), "-o", older, "-o", path("m.stl"), "-o", path("m.dot"), "--quiet"}, limit), 1,
      {path("m.stl") + ":", "cannot be written"});
  EXPECT_EQ(files(), std::vector<std::string>{"m.json"});
  expect_failure(
      run({"sample", shipped("m1.json"), "-n", "300", "-o", path("c.ply"), "-o", path("c.xyz"), "--quiet"}, limit), 1,
      {path("c.xyz") + ":", "cannot be written"});
  EXPECT_EQ(files(), std::vector<std::string>{"m.json"});
  const std::string cloud = path("c.ply");
  ASSERT_EQ(run({"sample", shipped("m1.json"), "-n", "1000", "-o", cloud, "--quiet"}).status, 0);
  expect_failure(run({"extract", cloud, "--primitives", shipped("m1.json"), "-o", older, "-o", path("m.off"), "--stats",
                      path("s.json"), "--quiet"},
                     limit),
                 1, {path("m.off") + ":", "cannot be written"});
  EXPECT_EQ(files(), (std::vector<std::string>{"c.ply", "m.json"}));
  EXPECT_EQ(read_file(older), R"({"format": "cloud2csg", "of": "an older result"})");
}

}  // namespace
}  // namespace cloud2csg::test
