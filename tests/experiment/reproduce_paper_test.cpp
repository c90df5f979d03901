#include <algorithm>
#include <stop_token>

#include "cloud2csg/error.hpp"
#include "core/base/files.hpp"
#include "experiment/experiment_fixture.hpp"

namespace cloud2csg::test {
namespace {

class ReproducePaper : public ExperimentTest {
 protected:
  /// What is said when results of these options are asked for where others are.
  [[nodiscard]] std::string refusal(const PaperOptions& options) const {
    try {
      (void)reproduce(options);
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  }
};

TEST_F(ReproducePaper, MakesEveryPlannedRun) {
  const PaperResults results = reproduce(small_experiment());
  const std::vector<RunName> plan = plan_runs(small_experiment());
  ASSERT_EQ(results.runs.size(), plan.size());
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const PaperRun& run = results.runs[i];
    EXPECT_EQ(run.name, plan[i]);
    EXPECT_EQ(run.points, run.name.sampling == Sampling::low ? 200U : 400U);
    EXPECT_GT(run.seconds.extraction, 0);
    EXPECT_GT(run.evaluations, 0U);
    EXPECT_EQ(run.tree.size >= run.tree.leaves, true);
    EXPECT_FALSE(run.formula.empty());
  }
  ASSERT_EQ(results.models.size(), 1U);
  EXPECT_EQ(results.models[0].primitives, 4U);
  EXPECT_EQ(results.models[0].tree.size, 7U);
  EXPECT_EQ(results.environment, current_environment());
}

TEST_F(ReproducePaper, EveryModeOfAStrategyGivesTheSameTree) {
  PaperOptions options = small_experiment();
  options.models = {"m0", "m1"};
  PaperResults results = reproduce(options);
  EXPECT_EQ(mode_disagreements(results), std::vector<std::string>{});
  // Another tree of one run is noticed, and only where it is.
  const auto changed = std::find_if(results.runs.begin(), results.runs.end(),
                                    [](const PaperRun& run) { return run.name.mode == "SMTP"; });
  changed->formula += " | other";
  EXPECT_EQ(mode_disagreements(results), std::vector<std::string>{"m0 low, seed 1: SST and SMTP"});
}

TEST_F(ReproducePaper, TextKeepsEverything) {
  const std::string text = to_json(reproduce(small_experiment()));
  EXPECT_EQ(read_text_file(results_file()), text);
  EXPECT_EQ(to_json(read_paper_results(results_file())), text);
}

TEST_F(ReproducePaper, FinishedRunsAreNotMadeAgain) {
  PaperResults results = reproduce(small_experiment());
  for (PaperRun& run : results.runs) run.finished = "before";
  const PaperRun missing = results.runs[4];
  results.runs.erase(results.runs.begin() + 4);
  write_text_file(results_file(), to_json(results));
  const PaperResults again = reproduce(small_experiment());
  ASSERT_EQ(again.runs.size(), results.runs.size() + 1);
  for (std::size_t i = 0; i < results.runs.size(); ++i) EXPECT_EQ(again.runs[i].finished, "before") << i;
  EXPECT_EQ(again.runs.back().name, missing.name);
  EXPECT_NE(again.runs.back().finished, "before");
  EXPECT_EQ(again.runs.back().formula, missing.formula);
}

TEST_F(ReproducePaper, InterruptKeepsFinishedRuns) {
  std::stop_source stop;
  const RunContext run{.stop = stop.get_token(), .on_progress = [&stop](const Progress& progress) {
                         if (progress.done == 3) stop.request_stop();
                       }};
  EXPECT_THROW((void)reproduce(small_experiment(), run), Cancelled);
  EXPECT_EQ(read_paper_results(results_file()).runs.size(), 3U);
  EXPECT_EQ(reproduce(small_experiment()).runs.size(), plan_runs(small_experiment()).size());
}

TEST_F(ReproducePaper, OtherOptionsAreRefusedByName) {
  (void)reproduce(small_experiment());
  const std::string before = read_text_file(results_file());
  PaperOptions options = small_experiment();
  options.repeats = 2;
  EXPECT_EQ(refusal(options), results_file().string() +
                                  ": holds results with repeats 1, not 2; choose another folder, or remove this one");
  options = small_experiment();
  options.low_points = 100;
  EXPECT_NE(refusal(options).find("low points 200, not 100"), std::string::npos) << refusal(options);
  options = small_experiment();
  options.models = {"m1", "m2"};
  EXPECT_NE(refusal(options).find("models m1, not m1, m2"), std::string::npos) << refusal(options);
  options = small_experiment();
  options.preset = PaperPreset::standard;
  EXPECT_NE(refusal(options).find("preset paper, not default"), std::string::npos) << refusal(options);
  EXPECT_EQ(read_text_file(results_file()), before);
}

TEST_F(ReproducePaper, OtherMachinesAndModelsAreRefused) {
  PaperResults results = reproduce(small_experiment());
  results.environment.cpu = "Another";
  write_text_file(results_file(), to_json(results));
  EXPECT_NE(refusal(small_experiment()).find("cpu Another, not"), std::string::npos);
  results.environment = current_environment();
  results.models[0].fingerprint = "0";
  write_text_file(results_file(), to_json(results));
  EXPECT_NE(refusal(small_experiment()).find("other models of the same names"), std::string::npos);
}

TEST_F(ReproducePaper, WhatIsNoResultIsRefused) {
  const auto refused = [this](const std::string& text) {
    write_text_file(results_file(), text);
    return refusal(small_experiment());
  };
  EXPECT_NE(refused("{\"format\": ").find("not JSON"), std::string::npos);
  EXPECT_NE(refused("[1]").find("no results of the paper's experiment"), std::string::npos);
  EXPECT_NE(refused(R"({"format": "cloud2csg", "version": 1})").find("no results"), std::string::npos);
  EXPECT_NE(refused(R"({"format": "cloud2csg-paper", "format_version": 1})").find("'options'"), std::string::npos);
}

TEST_F(ReproducePaper, MissingModelIsNamed) {
  PaperOptions options = small_experiment();
  options.models = {"m17"};
  EXPECT_NE(refusal(options).find("m17.json"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(results_file()));
}

TEST_F(ReproducePaper, TakesThePapersMethodItself) {
  PaperOptions options = small_experiment();
  options.low_points = 60;
  options.high_points = 120;
  options.evaluator = PaperEvaluator::reference;
  const PaperResults results = reproduce(options);
  EXPECT_EQ(results.runs.size(), 12U);
  EXPECT_EQ(mode_disagreements(results), std::vector<std::string>{});
  for (const PaperRun& run : results.runs) {
    EXPECT_EQ(run.seconds.classes, 0);
    EXPECT_GT(run.evaluations, 0U);
    EXPECT_GT(run.generations, 9U);
  }
}

}  // namespace
}  // namespace cloud2csg::test
