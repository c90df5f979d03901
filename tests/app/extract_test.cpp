#include <algorithm>
#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/program.hpp"

namespace cloud2csg::test {
namespace {

using nlohmann::json;

class Extract : public ProgramTest {
 protected:
  /// A cloud of a shipped model.
  std::string sampled(const std::string& model, const std::string& count) {
    const std::string cloud = path("cloud.ply");
    EXPECT_EQ(run({"sample", shipped(model), "-n", count, "--noise", "0.005", "-o", cloud, "--quiet"}).status, 0);
    return cloud;
  }
};

TEST_F(Extract, FindsTheModelAgain) {
  const std::string cloud = sampled("m1.json", "4000");
  const Outcome outcome = run({"extract", cloud, "--primitives", shipped("m1.json"), "-o", path("m.json"), "-o",
                               path("m.scad"), "--stats", path("s.json"), "--threads", "2"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(files(), (std::vector<std::string>{"cloud.ply", "m.json", "m.scad", "s.json"}));
  const Outcome compared =
      run({"compare", shipped("m1.json"), path("m.json"), "--resolution", "64", "--samples", "2000", "--json"});
  EXPECT_GT(json::parse(compared.out)["intersection_over_union"].get<double>(), 0.99) << compared.err;
}

TEST_F(Extract, RefinesPrimitives) {
  const std::string cloud = sampled("m2.json", "4000");
  json model = json::parse(read_file(shipped("m2.json")));
  const double radius = model["primitives"][0]["radius"];
  model.erase("tree");
  for (json& primitive : model["primitives"]) primitive["radius"] = 1.02 * radius;
  const std::string given = file("given.json", model.dump());
  const auto refine = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"extract",      cloud,     "--primitives", given,       "-o",
                                       path("m.json"), "--stats", path("s.json"), "--threads", "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  ASSERT_EQ(refine({}).status, 0);
  EXPECT_TRUE(json::parse(read_file(path("s.json")))["refine"].is_null());
  const Outcome outcome = refine({"--refine"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("refined "), std::string::npos) << outcome.err;
  const json refined = json::parse(read_file(path("m.json")));
  for (const json& primitive : refined["primitives"]) {
    EXPECT_NEAR(primitive["radius"].get<double>(), radius, 0.005 * radius);
  }
  const json statistics = json::parse(read_file(path("s.json")))["refine"];
  EXPECT_EQ(statistics["is_taken"], true);
  EXPECT_LT(statistics["rms_after"].get<double>(), statistics["rms_before"].get<double>());
  EXPECT_EQ(statistics["primitives"].size(), 20U);
  EXPECT_GT(statistics["largest_shift"].get<double>(), 0.01 * radius);
}

TEST_F(Extract, WritesStatistics) {
  const std::string cloud = sampled("m2.json", "4000");
  const Outcome outcome = run({"extract", cloud, "--primitives", shipped("m2.json"), "-o", path("m.json"), "--stats",
                               path("s.json"), "--seed", "7", "--threads", "2", "--quiet"});
  ASSERT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err.find("good: "), 0U) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  const json statistics = json::parse(read_file(path("s.json")));
  for (const char* field : {"version", "strategy", "parallel", "threads", "seed", "complete", "points", "primitives",
                            "clique_histogram", "seconds", "search", "merge", "tree", "fit", "warnings"}) {
    EXPECT_TRUE(statistics.contains(field)) << field;
  }
  EXPECT_EQ(statistics["points"], 4000);
  EXPECT_EQ(statistics["primitives"], 20);
  EXPECT_EQ(statistics["seed"], 7);
  EXPECT_EQ(statistics["complete"], true);
  EXPECT_EQ(statistics["clique_histogram"], (json{0, 0, 0, 12}));
  double shares = 0;
  for (const auto& [stage, share] : statistics["share"].items()) shares += share.get<double>();
  EXPECT_GT(shares, 0.5);
  EXPECT_LE(shares, 1.0);
  const json& seconds = statistics["seconds"];
  EXPECT_GT(seconds["read"].get<double>(), 0);
  EXPECT_GT(seconds["write"].get<double>(), 0);
  EXPECT_GE(seconds["total"].get<double>(), seconds["read"].get<double>() + seconds["extraction"].get<double>());
}

TEST_F(Extract, SameSeedSameFile) {
  const std::string cloud = sampled("m1.json", "2000");
  const auto extract = [&](const std::string& threads, const std::string& parallel) {
    const std::string out = path("m" + threads + parallel + ".json");
    EXPECT_EQ(run({"extract", cloud, "--primitives", shipped("m1.json"), "-o", out, "--threads", threads, "--parallel",
                   parallel, "--seed", "5"})
                  .status,
              0);
    return read_file(out);
  };
  const std::string once = extract("1", "none");
  EXPECT_EQ(once, extract("2", "both"));
  EXPECT_EQ(once, extract("3", "population"));
}

TEST_F(Extract, PresetsAndStrategiesAreTaken) {
  const std::string cloud = sampled("m1.json", "1000");
  const auto strategy_of = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"extract", cloud,          "--primitives", shipped("m1.json"),
                                       "-o",      path("m.json"), "--stats",      path("s.json")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(read_file(path("s.json")))["strategy"].get<std::string>();
  };
  EXPECT_EQ(strategy_of({}), "auto");
  EXPECT_EQ(strategy_of({"--strategy", "cells"}), "cells");
  EXPECT_EQ(strategy_of({"--preset", "paper"}), "partition");
  EXPECT_EQ(strategy_of({"--preset", "paper", "--strategy", "baseline"}), "baseline");
}

TEST_F(Extract, UnexplainedPointsAreWritten) {
  const std::string cloud = sampled("m0.json", "3000");
  const auto unexplained_with = [&](const std::vector<std::string>& options, int status) {
    std::vector<std::string> arguments{"extract", cloud,          "--primitives",  shipped("m0.json"),
                                       "-o",      path("m.json"), "--unexplained", path("rest.xyz")};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    const std::string rest = read_file(path("rest.xyz"));
    return std::count(rest.begin(), rest.end(), '\n');
  };
  const auto few = unexplained_with({}, 0);
  EXPECT_GT(few, 0);
  EXPECT_LT(few, 600);  // at edges, where noise turns the nearest surface by a right angle
  EXPECT_GT(unexplained_with({"--distance-tolerance", "0.005"}, 3), 2 * few);
}

TEST_F(Extract, PrecisionIsTaken) {
  const std::string cloud = sampled("m1.json", "3000");
  const auto objective_of = [&](const std::string& precision) {
    const Outcome outcome = run({"extract", cloud, "--primitives", shipped("m1.json"), "-o", path("m.json"), "--stats",
                                 path("s.json"), "--strategy", "partition", "--precision", precision});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(read_file(path("s.json")))["search"]["partitions"][0]["objective"].get<double>();
  };
  EXPECT_NE(objective_of("full"), objective_of("single"));
  EXPECT_NEAR(objective_of("full"), objective_of("single"), 1e-5 * objective_of("full"));
  EXPECT_EQ(objective_of("auto"), objective_of("single"));
}

TEST_F(Extract, SearchOptionsAreTaken) {
  const std::string cloud = sampled("m0.json", "1500");
  const auto evaluations_with = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"extract",  cloud,          "--primitives", shipped("m0.json"),
                                       "-o",       path("m.json"), "--stats",      path("s.json"),
                                       "--preset", "paper",        "--parallel",   "none"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(read_file(path("s.json")))["search"]["evaluations"].get<int>();
  };
  const int paper = evaluations_with({});
  EXPECT_EQ(paper, evaluations_with({"--no-seeds", "--no-local-search", "--no-polish", "--trust", "0"}));
  EXPECT_NE(paper, evaluations_with({"--seeds"}));
  EXPECT_NE(paper, evaluations_with({"--local-search"}));
  const int restarted = evaluations_with({"--trust", "1", "--restarts", "2"});
  EXPECT_GT(restarted, paper);
  EXPECT_LT(evaluations_with({"--trust", "1", "--restarts", "2", "--restart-budget", "0"}), restarted);
}

TEST_F(Extract, ModelKeepsPrimitivesThatTheTreeDoesNot) {
  const std::string cloud = sampled("m1.json", "2000");
  json given = json::parse(read_file(shipped("m1.json")));
  given.erase("tree");
  // Far from every point, and first: the indices of the others must stay.
  const json spare{{"id", "spare"}, {"type", "sphere"}, {"radius", 0.5}, {"pose", {{"position", {90, 0, 0}}}}};
  given["primitives"].insert(given["primitives"].begin(), spare);
  const Outcome outcome = run({"extract", cloud, "--primitives", file("p.json", given.dump()), "-o", path("m.json"),
                               "--stats", path("s.json")});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("spare"), std::string::npos) << outcome.err;
  const json written = json::parse(read_file(path("m.json")));
  ASSERT_EQ(written["primitives"].size(), given["primitives"].size());
  for (std::size_t i = 0; i < given["primitives"].size(); ++i) {
    EXPECT_EQ(written["primitives"][i]["id"], given["primitives"][i]["id"]);
  }
  EXPECT_EQ(written["tree"].dump().find("spare"), std::string::npos);
  EXPECT_NE(json::parse(read_file(path("s.json")))["warnings"].dump().find("spare"), std::string::npos);
}

/// A search that takes minutes when nobody stops it.
std::vector<std::string> endless(const std::string& cloud, const std::string& model, const std::string& out,
                                 const std::string& statistics) {
  return {"extract",
          cloud,
          "--primitives",
          model,
          "-o",
          out,
          "--stats",
          statistics,
          "--preset",
          "paper",
          "--strategy",
          "baseline",
          "--threads",
          "1",
          "--population",
          "20000",
          "--idle-generations",
          "1000000"};
}

/// Waits until the program says that the overlap graph is done: then it is about to search.
void wait_for_search(const RunningProgram& program) {
  for (int i = 0; i < 600 && program.err_so_far().find("overlap") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
}

TEST_F(Extract, FirstInterruptWritesTheBestSoFar) {
  const std::string cloud = sampled("m0.json", "3000");
  RunningProgram program = start(endless(cloud, shipped("m0.json"), path("m.json"), path("s.json")));
  wait_for_search(program);
  program.send_signal(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("cloud2csg: interrupted: the best tree so far was written\n"), std::string::npos)
      << outcome.err;
  ASSERT_EQ(files(), (std::vector<std::string>{"cloud.ply", "m.json", "s.json"}));
  EXPECT_EQ(json::parse(read_file(path("s.json")))["complete"], false);
  const json model = json::parse(read_file(path("m.json")));
  EXPECT_EQ(model["description"].get<std::string>().rfind("INCOMPLETE", 0), 0U);
  EXPECT_EQ(run({"info", path("m.json")}).status, 0);
}

TEST_F(Extract, SecondInterruptEndsAtOnce) {
  const std::string cloud = sampled("m0.json", "3000");
  RunningProgram program = start(endless(cloud, shipped("m0.json"), path("m.json"), path("s.json")));
  wait_for_search(program);
  // Two kinds, since two pending signals of one kind are delivered as one.
  program.send_signal(SIGINT);
  program.send_signal(SIGTERM);
  EXPECT_EQ(program.wait().status, 130);
  EXPECT_EQ(files(), std::vector<std::string>{"cloud.ply"});
}

TEST_F(Extract, TimeLimitIsNotAFailure) {
  const std::string cloud = sampled("m0.json", "3000");
  std::vector<std::string> arguments = endless(cloud, shipped("m0.json"), path("m.json"), path("s.json"));
  arguments.insert(arguments.end(), {"--time-limit", "0.5"});
  const Outcome outcome = run(arguments);
  EXPECT_TRUE(outcome.status == 0 || outcome.status == 3) << outcome.err;
  EXPECT_EQ(json::parse(read_file(path("s.json")))["complete"], false);
}

}  // namespace
}  // namespace cloud2csg::test
