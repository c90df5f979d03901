#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/program.hpp"

namespace cloud2csg::test {
namespace {

using nlohmann::json;
using Commands = ProgramTest;

TEST_F(Commands, SampleMakesAsManyPointsAsAsked) {
  const std::string cloud = path("m1.ply");
  const Outcome outcome = run({"sample", shipped("m1.json"), "-n", "1234", "--noise", "0.01", "-o", cloud});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  const json info = json::parse(run({"info", cloud, "--json"}).out);
  EXPECT_EQ(info["kind"], "cloud");
  EXPECT_EQ(info["points"], 1234);
  EXPECT_EQ(info["normals"], true);
  EXPECT_GT(info["bounds"][1][1].get<double>(), 0.4);
  EXPECT_LT(info["bounds"][1][1].get<double>(), 1.2);
}

TEST_F(Commands, ScanSeesModelsAndMeshes) {
  const Outcome outcome = run({"scan", shipped("m1.json"), "-n", "1234", "--resolution", "48", "-o", path("m.pcd")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("1234 points from 20 views"), std::string::npos) << outcome.err;
  const json info = json::parse(run({"info", path("m.pcd"), "--json"}).out);
  EXPECT_EQ(info["points"], 1234);
  EXPECT_EQ(info["sensor_positions"], true);
  EXPECT_EQ(info["normals"], false);

  ASSERT_EQ(run({"convert", shipped("m1.json"), "-o", path("m.stl"), "--resolution", "48"}).status, 0);
  ASSERT_EQ(
      run({"scan", path("m.stl"), "--views", "3", "--angular-step", "1", "--normals", "--perfect", "-o", path("m.ply")})
          .status,
      0);
  EXPECT_EQ(json::parse(run({"info", path("m.ply"), "--json"}).out)["normals"], true);
  const json comparison =
      json::parse(run({"compare", path("m.stl"), path("m.ply"), "--samples", "1000", "--json"}).out);
  EXPECT_LT(comparison["mean_distance"].get<double>(), 0.1);
}

TEST_F(Commands, ScanIsRepeatableForAnyNumberOfThreads) {
  const auto scan = [this](const std::string& name, const std::string& seed, const std::string& threads) {
    EXPECT_EQ(run({"scan", shipped("m1.json"), "-n", "500", "--resolution", "48", "--seed", seed, "--threads", threads,
                   "-o", path(name)})
                  .status,
              0);
    return read_file(path(name));
  };
  const std::string once = scan("a.ply", "3", "1");
  EXPECT_EQ(once, scan("b.ply", "3", "2"));
  EXPECT_NE(once, scan("c.ply", "4", "1"));
}

TEST_F(Commands, ScanRefusesCloudsAndItsOwnInput) {
  ASSERT_EQ(run({"sample", shipped("m1.json"), "-n", "100", "-o", path("c.ply")}).status, 0);
  const Outcome cloud = run({"scan", path("c.ply"), "-o", path("d.ply")});
  EXPECT_EQ(cloud.status, 1);
  EXPECT_NE(cloud.err.find("found a point cloud"), std::string::npos) << cloud.err;
  EXPECT_EQ(run({"scan", path("c.ply"), "-o", path("c.ply")}).status, 2);
  EXPECT_EQ(run({"scan", shipped("m1.json"), "--perfect", "--noise", "0.1", "-o", path("d.ply")}).status, 2);
  EXPECT_EQ(files(), std::vector<std::string>{"c.ply"});
}

TEST_F(Commands, SampleIsRepeatable) {
  const auto sample = [this](const std::string& name, const std::string& seed) {
    EXPECT_EQ(run({"sample", shipped("m1.json"), "-n", "500", "--seed", seed, "-o", path(name)}).status, 0);
    return read_file(path(name));
  };
  const std::string once = sample("a.ply", "3");
  EXPECT_EQ(once, sample("b.ply", "3"));
  EXPECT_NE(once, sample("c.ply", "4"));
}

TEST_F(Commands, SampleWritesEveryEnding) {
  const Outcome outcome = run({"sample", shipped("m1.json"), "-n", "300", "--ascii", "-o", path("c.ply"), "-o",
                               path("c.pcd"), "-o", path("c.xyz"), "-o", path("c.pts")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(files(), (std::vector<std::string>{"c.pcd", "c.ply", "c.pts", "c.xyz"}));
  for (const std::string& name : files()) {
    EXPECT_EQ(json::parse(run({"info", path(name), "--json"}).out)["points"], 300) << name;
  }
  EXPECT_NE(read_file(path("c.ply")).find("format ascii"), std::string::npos);
}

TEST_F(Commands, ConvertWritesEveryEnding) {
  const Outcome outcome =
      run({"convert", shipped("m1.json"), "-o", path("m.json"), "-o", path("m.scad"), "-o", path("m.dot"), "-o",
           path("m.stl"), "-o", path("m.off"), "-o", path("m.obj"), "--resolution", "32"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(files(), (std::vector<std::string>{"m.dot", "m.json", "m.obj", "m.off", "m.scad", "m.stl"}));
  EXPECT_NE(read_file(path("m.scad")).find("difference()"), std::string::npos);
  EXPECT_NE(read_file(path("m.dot")).find("digraph"), std::string::npos);
  for (const char* mesh : {"m.stl", "m.off", "m.obj"}) {
    const json info = json::parse(run({"info", path(mesh), "--json"}).out);
    EXPECT_EQ(info["kind"], "mesh");
    EXPECT_EQ(info["watertight"], true) << mesh;
    EXPECT_GT(info["volume"].get<double>(), 0.2) << mesh;
  }
}

/// Whether the program was built with OpenCASCADE.
bool writes_step(const Outcome& outcome) {
  return outcome.err.find("need OpenCASCADE") == std::string::npos;
}

TEST_F(Commands, ConvertWritesExactSolids) {
  const Outcome outcome = run({"convert", shipped("m3.json"), "-o", path("it's \"m3\".step"), "-o", path("m.STP"), "-o",
                               path("m.brep"), "--with-primitives", "--quiet"});
  if (!writes_step(outcome)) GTEST_SKIP() << "needs OpenCASCADE";
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "") << "nothing that the kernel prints";
  EXPECT_EQ(files(), (std::vector<std::string>{"it's \"m3\".step", "m.STP", "m.brep"}));
  const std::string step = read_file(path("it's \"m3\".step"));
  EXPECT_EQ(step.rfind("ISO-10303-21;", 0), 0U);
  EXPECT_NE(step.find(R"(PRODUCT('it\X\27s "m3" assembly')"), std::string::npos);
  EXPECT_NE(step.find("PRODUCT('housing'"), std::string::npos);
  EXPECT_NE(read_file(path("m.brep")).find("CASCADE Topology"), std::string::npos);
}

TEST_F(Commands, ExtractWritesExactSolids) {
  const std::string cloud = path("c.ply");
  ASSERT_EQ(run({"sample", shipped("m3.json"), "-n", "20000", "-o", cloud}).status, 0);
  const Outcome outcome = run({"extract", cloud, "--primitives", shipped("m3.json"), "-o", path("x.step"), "--quiet"});
  if (!writes_step(outcome)) GTEST_SKIP() << "needs OpenCASCADE";
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(read_file(path("x.step")).find("MANIFOLD_SOLID_BREP('x'"), std::string::npos);
}

TEST_F(Commands, ExactSolidsSayWhatHasFacets) {
  const std::string model = file("egg.json", R"({"format": "cloud2csg", "version": 1, "primitives": [
      {"id": "egg", "type": "expression", "distance": "sqrt(x^2+y^2+2*z^2)-1", "bounds": [[-2,-2,-2],[2,2,2]]}],
      "tree": {"primitive": "egg"}})");
  const Outcome outcome = run({"convert", model, "-o", path("egg.step"), "--facet-resolution", "8"});
  if (!writes_step(outcome)) GTEST_SKIP() << "needs OpenCASCADE";
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("'egg' has no exact surface"), std::string::npos) << outcome.err;
}

TEST_F(Commands, FailedExactSolidsLeaveOlderFiles) {
  const std::string model = file("none.json", R"({"format": "cloud2csg", "version": 1, "primitives": [
      {"id": "a", "type": "sphere", "radius": 1},
      {"id": "b", "type": "sphere", "radius": 1, "pose": {"position": [9, 0, 0]}}],
      "tree": {"op": "intersection", "children": [{"primitive": "a"}, {"primitive": "b"}]}})");
  const std::string older = file("x.step", "ISO-10303-21; an older result");
  const Outcome outcome = run({"convert", model, "-o", path("x.scad"), "-o", older, "--quiet"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find(older), std::string::npos) << outcome.err;
  EXPECT_EQ(files(), (std::vector<std::string>{"none.json", "x.step"}));
  EXPECT_EQ(read_file(older), "ISO-10303-21; an older result");
}

TEST_F(Commands, ConvertWarnsWhereItCuts) {
  const std::string model = file("h.json", R"({"format": "cloud2csg", "version": 1,
      "primitives": [{"id": "h", "type": "half_space"}], "tree": {"primitive": "h"}})");
  const Outcome outcome =
      run({"convert", model, "-o", path("h.off"), "-o", path("h.scad"), "-o", path("h.dot"), "--resolution", "8"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: " + path("h.off") + ": the solid is unbounded"), std::string::npos)
      << outcome.err;
  EXPECT_NE(outcome.err.find("warning: " + path("h.scad")), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("h.dot"), std::string::npos) << outcome.err;
  EXPECT_NE(read_file(path("h.scad")).find("// The solid is unbounded"), std::string::npos);
  EXPECT_EQ(run({"convert", shipped("m1.json"), "-o", path("m.off"), "--resolution", "8"}).err.find("warning"),
            std::string::npos);
}

TEST_F(Commands, SecondInterruptLeavesNoTemporaries) {
  const std::string older = file("m.scad", "// Written by cloud2csg: an older result");
  RunningProgram program = start({"convert", shipped("m0.json"), "-o", path("m.json"), "-o", older, "-o", path("m.stl"),
                                  "--resolution", "2048", "--contour"});
  // The mesh takes long; by then its own temporary file and those of the others are there.
  for (int i = 0; i < 600 && files().size() < 4; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(files().size(), 4U);
  program.send_signal(SIGINT);
  program.send_signal(SIGTERM);
  EXPECT_EQ(program.wait().status, 130);
  EXPECT_EQ(files(), std::vector<std::string>{"m.scad"});
  EXPECT_EQ(read_file(older), "// Written by cloud2csg: an older result");
}

TEST_F(Commands, ConvertedModelIsTheSameModel) {
  ASSERT_EQ(run({"convert", shipped("m0.json"), "-o", path("m.json")}).status, 0);
  json before = json::parse(run({"info", shipped("m0.json"), "--json"}).out);
  EXPECT_EQ(before, json::parse(run({"info", path("m.json"), "--json"}).out));
}

TEST_F(Commands, InfoDescribesAModel) {
  const json info = json::parse(run({"info", shipped("m1.json"), "--json"}).out);
  EXPECT_EQ(info["kind"], "model");
  EXPECT_EQ(info["primitives"], 4);
  EXPECT_EQ(info["types"], (json{{"cylinder", 1}, {"displaced box", 1}, {"sphere", 2}}));
  EXPECT_EQ(info["tree"]["size"], 7);
  EXPECT_EQ(info["tree"]["leaves"], 4);
  EXPECT_EQ(info["tree"]["depth"], 3);
  const Outcome table = run({"info", shipped("m1.json")});
  EXPECT_EQ(table.status, 0);
  EXPECT_NE(table.out.find("primitives"), std::string::npos);
  EXPECT_NE(table.out.find(info["tree"]["text"].get<std::string>()), std::string::npos) << table.out;
}

TEST_F(Commands, InfoOfAnUnboundedModelIsValidJson) {
  const std::string model = file("h.json", R"({"format": "cloud2csg", "version": 1,
      "primitives": [{"id": "h", "type": "half_space"}], "tree": {"primitive": "h"}})");
  const Outcome outcome = run({"info", model, "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(json::parse(outcome.out)["bounds"][0][0].is_null());
}

TEST_F(Commands, CompareWithItselfIsPerfect) {
  const std::vector<std::string> same{
      "compare", shipped("m1.json"), shipped("m1.json"), "--resolution", "48", "--samples", "2000", "--json"};
  const Outcome outcome = run(same);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json comparison = json::parse(outcome.out);
  EXPECT_NEAR(comparison["intersection_over_union"].get<double>(), 1, 1e-9);
  EXPECT_EQ(comparison["size_ratio"], 1);
  EXPECT_EQ(comparison["depth_ratio"], 1);
}

TEST_F(Commands, CompareSaysWhatCannotBeHad) {
  ASSERT_EQ(run({"sample", shipped("m1.json"), "-n", "2000", "-o", path("c.ply")}).status, 0);
  const std::vector<std::string> arguments{"compare", shipped("m1.json"), path("c.ply"), "--samples", "2000"};
  const Outcome table = run(arguments);
  ASSERT_EQ(table.status, 0) << table.err;
  EXPECT_NE(table.out.find("intersection over union   -\n"), std::string::npos) << table.out;
  std::vector<std::string> with_json = arguments;
  with_json.emplace_back("--json");
  const json comparison = json::parse(run(with_json).out);
  EXPECT_TRUE(comparison["intersection_over_union"].is_null());
  EXPECT_LT(comparison["mean_distance"].get<double>(), 0.05);
}

TEST_F(Commands, QuietSaysNothing) {
  const Outcome outcome = run({"convert", shipped("m1.json"), "-o", path("m.stl"), "--resolution", "24", "--quiet"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
}

TEST_F(Commands, ProgressInALogIsPlainLines) {
  const Outcome outcome = run({"convert", shipped("m1.json"), "-o", path("m.stl"), "--resolution", "24"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err, "");
  EXPECT_EQ(outcome.err.find_first_of("\x1b\r"), std::string::npos) << outcome.err;
}

/// A pseudo-terminal: what the program writes to it can be read back.
class Terminal {
 public:
  Terminal() : master_(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0) return;
    name_ = ::ptsname(master_);
    slave_ = ::open(name_.c_str(), O_RDWR | O_NOCTTY);  // keeps what was written when the program has ended
  }
  ~Terminal() {
    ::close(slave_);
    ::close(master_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  Terminal(Terminal&&) = delete;
  Terminal& operator=(Terminal&&) = delete;

  [[nodiscard]] bool is_open() const { return slave_ >= 0; }
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::string read_all() const {
    std::string text;
    char buffer[4096];
    for (ssize_t got = 0; (got = ::read(master_, buffer, sizeof buffer)) > 0;) {
      text.append(buffer, static_cast<std::size_t>(got));
    }
    return text;
  }

 private:
  int master_ = -1;
  int slave_ = -1;
  std::string name_;
};

TEST_F(Commands, ProgressOnATerminalIsABar) {
  const Terminal terminal;
  if (!terminal.is_open()) GTEST_SKIP() << "no pseudo-terminals here";
  const std::vector<std::string> arguments{"convert", shipped("m1.json"), "-o", path("m.stl"), "--resolution", "24"};
  const std::string green = "\x1b[32m";
  const auto show = [&](const std::string& setup) {
    EXPECT_EQ(start(arguments, setup, terminal.name()).wait().status, 0);
    return terminal.read_all();
  };
  const std::string colored = show("export TERM=xterm; unset NO_COLOR");
  EXPECT_NE(colored.find("\r\x1b[K"), std::string::npos);
  const std::string plain = show("export TERM=xterm NO_COLOR=1");
  EXPECT_NE(plain.find("\r\x1b[K"), std::string::npos);
  EXPECT_EQ(plain.find(green), std::string::npos);
  EXPECT_EQ(show("export TERM=dumb").find('\x1b'), std::string::npos);
}

}  // namespace
}  // namespace cloud2csg::test
