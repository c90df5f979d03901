#include <nlohmann/json.hpp>

#include "app/program.hpp"

namespace cloud2csg::test {
namespace {

using nlohmann::json;

class Bench : public ProgramTest {
 protected:
  /// The paper's experiment, as small as it goes, with options added.
  Outcome run_small(const std::vector<std::string>& options = {}, const std::string& repeats = "1") {
    std::vector<std::string> arguments{
        "bench", "paper",         "-o",  path("out"), "--only", "m1",        "--low-points",
        "200",   "--high-points", "400", "--threads", "2",      "--repeats", repeats};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(arguments);
  }
};

TEST_F(Bench, PaperWritesResultsAndTables) {
  const Outcome outcome = run_small();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("12 runs"), std::string::npos) << outcome.err;
  const json results = json::parse(read_file(folder() / "out" / "paper.json"));
  EXPECT_EQ(results["runs"].size(), 12U);
  EXPECT_EQ(results["options"]["preset"], "paper");
  const std::string text = read_file(folder() / "out" / "paper.md");
  EXPECT_NE(text.find("the same tree"), std::string::npos);
  EXPECT_NE(text.find("| m1    | high     |"), std::string::npos) << text;
}

TEST_F(Bench, PaperGoesOnWhereItStopped) {
  ASSERT_EQ(run_small().status, 0);
  const std::string before = read_file(folder() / "out" / "paper.json");
  ASSERT_EQ(run_small().status, 0);
  EXPECT_EQ(read_file(folder() / "out" / "paper.json"), before);
  expect_failure(run_small({"--seed", "2", "--quiet"}), 1, {"paper.json", "seed 1, not 2", "another folder"});
}

TEST_F(Bench, PaperTakesModelsOfAFolder) {
  std::filesystem::create_directory(folder() / "models");
  std::filesystem::copy(shipped("m1.json"), folder() / "models" / "mine.json");
  const Outcome outcome = run({"bench", "paper", "--models", path("models"), "-o", path("out"), "--low-points", "200",
                               "--high-points", "400", "--repeats", "1", "--preset", "default"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json results = json::parse(read_file(folder() / "out" / "paper.json"));
  EXPECT_EQ(results["options"]["models"], json{"mine"});
  EXPECT_EQ(results["options"]["preset"], "default");
}

TEST_F(Bench, CompareTellsWhatGotWorse) {
  ASSERT_EQ(run_small({}, "3").status, 0);
  const std::string before = (folder() / "out" / "paper.json").string();
  const Outcome same = run({"bench", "compare", before, before});
  EXPECT_EQ(same.status, 0) << same.err;
  EXPECT_EQ(same.out, "24 measures: 0 worse, 0 better, 24 the same within the noise, 0 unknown\n");
  json results = json::parse(read_file(before));
  for (json& one : results["runs"]) one["tree"]["size"] = one["tree"]["size"].get<int>() + 100;
  const std::string after = file("after.json", results.dump());
  const Outcome worse = run({"bench", "compare", before, after});
  EXPECT_EQ(worse.status, 1);
  EXPECT_EQ(worse.err, "cloud2csg: " + after + ": 4 measures got worse\n");
  EXPECT_NE(worse.out.find("| m1    | high     | SST  | nodes "), std::string::npos) << worse.out;
  EXPECT_EQ(worse.out.find("duration"), std::string::npos) << worse.out;
  EXPECT_EQ(run({"bench", "compare", after, before}).status, 0);
}

TEST_F(Bench, CompareRefusesWhatItCannot) {
  ASSERT_EQ(run_small().status, 0);
  const std::string before = (folder() / "out" / "paper.json").string();
  json results = json::parse(read_file(before));
  results["options"]["preset"] = "default";
  const std::string other = file("other.json", results.dump());
  expect_failure(run({"bench", "compare", before, other}), 1, {before, other, "preset", "paper and default"});
  expect_failure(run({"bench", "compare", before, shipped("m1.json")}), 1, {"m1.json", "no results"});
  expect_failure(run({"bench", "compare", before}), 2, {"after"});
  expect_failure(run({"bench", "compare", before, before, "--error-rate", "2"}), 2, {"--error-rate"});
}

TEST_F(Bench, WrongUsageIsNamed) {
  expect_failure(run({"bench", "ppaer"}), 2, {"unknown command 'ppaer'", "did you mean 'paper'?"});
  expect_failure(run({"bench", "paper", "--ouput", "x"}), 2,
                 {"'--ouput'", "did you mean '--output'?", "cloud2csg bench paper --help"});
  expect_failure(run_small({"--noise", "-1"}), 2, {"--noise", "0 or more"});
  expect_failure(run({"bench", "paper", "-o", path("out"), "--low-points", "9", "--high-points", "9"}), 2,
                 {"--high-points", "--low-points"});
  expect_failure(run_small({"--evaluator", "reference", "--preset", "default"}), 2, {"--evaluator", "--preset paper"});
  expect_failure(run({"bench", "paper", "-o", path("out"), "--preset", "papers"}), 2, {"--preset", "default"});
}

TEST_F(Bench, BadInputIsNamed) {
  expect_failure(run_small({"--models", path("nowhere")}), 1, {"nowhere"});
  expect_failure(run({"bench", "paper", "-o", path("out"), "--models", path("nowhere")}), 1, {"nowhere", "--models"});
  const std::string taken = file("taken", "");
  expect_failure(run({"bench", "paper", "-o", taken}), 1, {taken, "cannot be created"});
}

}  // namespace
}  // namespace cloud2csg::test
