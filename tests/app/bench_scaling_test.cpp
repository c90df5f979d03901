#include <nlohmann/json.hpp>

#include "app/program.hpp"

namespace cloud2csg::test {
namespace {

using nlohmann::json;

class BenchScaling : public ProgramTest {
 protected:
  /// The experiment, as small as it goes, with options added.
  Outcome run_small(const std::vector<std::string>& options = {}) {
    std::vector<std::string> arguments{"bench",    "scaling",   "-o",          path("out"),
                                       "--family", "grid",      "random",      "--primitives",
                                       "5",        "10",        "--at-points", "1000",
                                       "--points", "500",       "1000",        "--at-primitives",
                                       "5",        "--cliques", "2",           "--points-per-primitive",
                                       "200",      "--repeats", "2",           "--threads",
                                       "2"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(arguments);
  }
};

TEST_F(BenchScaling, WritesResultsTablesAndFigures) {
  const Outcome outcome = run_small();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  const json results = json::parse(read_file(folder() / "out" / "scaling.json"));
  EXPECT_EQ(results["options"]["families"], (json{"grid", "random"}));
  EXPECT_EQ(results["options"]["primitives"], (json{5, 10}));
  EXPECT_NE(outcome.err.find(std::to_string(results["runs"].size()) + " runs"), std::string::npos) << outcome.err;
  const std::string text = read_file(folder() / "out" / "scaling.md");
  EXPECT_NE(text.find("## Exponents"), std::string::npos);
  EXPECT_NE(text.find("| random | 4      |         10 |   2000 |"), std::string::npos) << text;
  EXPECT_NE(read_file(folder() / "out" / "time_points.gp").find("logscale"), std::string::npos);
}

TEST_F(BenchScaling, GoesOnWhereItStopped) {
  ASSERT_EQ(run_small().status, 0);
  const std::string before = read_file(folder() / "out" / "scaling.json");
  ASSERT_EQ(run_small().status, 0);
  EXPECT_EQ(read_file(folder() / "out" / "scaling.json"), before);
  expect_failure(run_small({"--seed", "2", "--quiet"}), 1, {"scaling.json", "seed 1, not 2", "another folder"});
}

TEST_F(BenchScaling, WrongUsageIsNamed) {
  expect_failure(run({"bench", "scaling"}), 2, {"--output"});
  expect_failure(run({"bench", "scaling", "-o", path("out"), "--family", "gird"}), 2, {"--family", "grid"});
  expect_failure(run({"bench", "scaling", "-o", path("out"), "--cliques", "21"}), 2, {"--cliques", "20"});
  expect_failure(run({"bench", "scaling", "-o", path("out"), "--primitives", "0"}), 2, {"--primitives"});
  expect_failure(run({"bench", "scaling", "-o", path("out"), "--primitives", "5", "5"}), 2, {"--primitives", "twice"});
}

}  // namespace
}  // namespace cloud2csg::test
