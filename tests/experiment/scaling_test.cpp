#include "bench/experiment/scaling.hpp"

#include <algorithm>
#include <stop_token>

#include "bench/experiment/peak_memory.hpp"
#include "bench/experiment/scaling_figures.hpp"
#include "bench/experiment/scaling_tables.hpp"
#include "cloud2csg/error.hpp"
#include "core/base/files.hpp"
#include "experiment/experiment_fixture.hpp"

namespace cloud2csg::test {
namespace {

class Scaling : public ExperimentTest {
 protected:
  /// Eight runs that take milliseconds.
  [[nodiscard]] static ScalingOptions small() {
    return {.families = {Family::grid},
            .primitives = {5, 10},
            .points_per_primitive = 200,
            .at_points = 2000,
            .points = {2000, 4000},
            .at_primitives = 10,
            .repeats = 2,
            .threads = 1};
  }
  [[nodiscard]] std::filesystem::path file() const { return folder() / "scaling.json"; }
  [[nodiscard]] ScalingResults measure_again(const ScalingOptions& options, const RunContext& run = {}) const {
    return measure_scaling(options, folder(), run);
  }
  [[nodiscard]] std::string refusal(const ScalingOptions& options) const {
    try {
      (void)measure_again(options);
    } catch (const Error& error) {
      return error.what();
    }
    return "none";
  }
};

TEST_F(Scaling, MakesEveryPlannedRun) {
  const ScalingResults results = measure_again(small());
  const auto plan = plan_runs(small());
  ASSERT_EQ(results.runs.size(), plan.size());
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const ScalingRun& run = results.runs[i];
    EXPECT_EQ(run.scaling_case, plan[i].first);
    EXPECT_EQ(run.seed, plan[i].second);
    EXPECT_TRUE(run.complete);
    EXPECT_GT(run.seconds.extraction, 0);
    EXPECT_EQ(run.true_tree.size, 2 * run.scaling_case.primitives - 1);
    EXPECT_EQ(run.tree.size, run.true_tree.size);
    EXPECT_EQ(run.components, 1U);
    EXPECT_EQ(run.cloud_bytes, 48 * run.scaling_case.points);
    EXPECT_EQ(run.wrong_primitives, 0U);
  }
}

TEST_F(Scaling, TextKeepsEverything) {
  const std::string text = to_json(measure_again(small()));
  EXPECT_EQ(read_text_file(file()), text);
  const ScalingResults read = read_scaling_results(file());
  EXPECT_EQ(read.options, small());
  EXPECT_EQ(to_json(read), text);
}

TEST_F(Scaling, FinishedRunsAreNotMadeAgain) {
  ScalingResults results = measure_again(small());
  for (ScalingRun& run : results.runs) run.finished = "before";
  const ScalingRun missing = results.runs[3];
  results.runs.erase(results.runs.begin() + 3);
  write_text_file(file(), to_json(results));
  const ScalingResults again = measure_again(small());
  ASSERT_EQ(again.runs.size(), results.runs.size() + 1);
  EXPECT_EQ(std::ranges::count(again.runs, "before", &ScalingRun::finished),
            static_cast<std::ptrdiff_t>(results.runs.size()));
  EXPECT_EQ(again.runs.back().scaling_case, missing.scaling_case);
  EXPECT_EQ(again.runs.back().fingerprint, missing.fingerprint);
}

TEST_F(Scaling, InterruptKeepsFinishedRuns) {
  std::stop_source stop;
  const RunContext run{.stop = stop.get_token(), .on_progress = [&stop](const Progress& progress) {
                         if (progress.done == 3) stop.request_stop();
                       }};
  EXPECT_THROW((void)measure_again(small(), run), Cancelled);
  EXPECT_EQ(read_scaling_results(file()).runs.size(), 3U);
  EXPECT_EQ(measure_again(small()).runs.size(), plan_runs(small()).size());
}

TEST_F(Scaling, OtherOptionsAndMachinesAreRefused) {
  ScalingResults results = measure_again(small());
  ScalingOptions options = small();
  options.primitives = {5};
  EXPECT_NE(refusal(options).find("primitives 5, 10, not 5"), std::string::npos) << refusal(options);
  options = small();
  options.families = {Family::grid, Family::nest};
  EXPECT_NE(refusal(options).find("families grid, not grid, nest"), std::string::npos) << refusal(options);
  results.environment.cpu = "Another";
  write_text_file(file(), to_json(results));
  EXPECT_NE(refusal(small()).find("cpu Another, not"), std::string::npos);
  write_text_file(file(), R"({"format": "cloud2csg-paper", "format_version": 1})");
  EXPECT_NE(refusal(small()).find("no results of the scaling experiment"), std::string::npos) << refusal(small());
}

TEST_F(Scaling, ThreadsThatChangeATreeAreNamed) {
  ScalingOptions options = small();
  options.threads = 2;
  ScalingResults results = measure_again(options);
  EXPECT_EQ(thread_disagreements(results), std::vector<std::string>{});
  const auto changed =
      std::ranges::find_if(results.runs, [](const ScalingRun& run) { return run.scaling_case.threads == 1; });
  ASSERT_NE(changed, results.runs.end());
  changed->fingerprint = "other";
  ASSERT_EQ(thread_disagreements(results).size(), 1U);
  EXPECT_NE(thread_disagreements(results)[0].find("grid, 10 primitives, 2000 points, seed 1"), std::string::npos);
}

/// Results made up so that the search takes n^2 / 1000 milliseconds, all else nothing.
ScalingResults quadratic_results() {
  ScalingResults results{.options = {.families = {Family::grid},
                                     .primitives = {10, 100, 1000},
                                     .points = {1000, 100'000},
                                     .repeats = 2,
                                     .threads = 2},
                         .environment = {.version = "1", .compiler = "g++", .cpu = "Some CPU", .cores = 2}};
  for (const auto& [one, seed] : plan_runs(results.options)) {
    ScalingRun run{.scaling_case = one, .seed = seed, .finished = "2020-01-02T03:04:05Z", .true_tree = {.size = 10}};
    const auto n = static_cast<double>(one.primitives);
    run.seconds.search = run.seconds.extraction = 1e-6 * n * n * (one.threads == 1 ? 2 : 1);
    run.tree.size = 15;
    run.peak_bytes = 1000 * one.points;
    results.runs.push_back(run);
  }
  return results;
}

TEST_F(Scaling, TablesHoldExponentsAndSpeedUp) {
  const ScalingResults results = quadratic_results();
  EXPECT_NEAR(fitted(results, Sweep::primitives, Family::grid, extraction_milliseconds()).exponent, 2, 1e-9);
  EXPECT_NEAR(fitted(results, Sweep::primitives, Family::grid, peak_memory()).exponent, 1, 1e-9);
  EXPECT_NEAR(fitted(results, Sweep::primitives_at_points, Family::grid, peak_memory()).exponent, 0, 1e-9);
  EXPECT_NEAR(fitted(results, Sweep::points, Family::grid, peak_memory()).exponent, 1, 1e-9);
  EXPECT_NEAR(fitted(results, Sweep::points, Family::grid, extraction_milliseconds()).exponent, 0, 1e-9);
  const std::vector<Table> tables = scaling_tables(results);
  const std::string exponents = to_markdown(table_of(tables, "exponents"));
  EXPECT_NE(exponents.find("| primitives, 500 points each"), std::string::npos) << exponents;
  EXPECT_NE(to_csv(table_of(tables, "threads")).find("grid,1000,500000,2000,0,1000,0,2,0"), std::string::npos)
      << to_csv(table_of(tables, "threads"));
  EXPECT_NE(to_csv(table_of(tables, "trees_primitives")).find("grid,,10,5000,0,0,10,0,15,0,1.5,0"), std::string::npos)
      << to_csv(table_of(tables, "trees_primitives"));
  EXPECT_EQ(scaling_runs_table(results).rows.size(), results.runs.size());
}

TEST_F(Scaling, RunsThatWereCutOffAreLeftOutOfFits) {
  ScalingResults results = quadratic_results();
  for (ScalingRun& run : results.runs) {
    if (run.scaling_case.primitives != 1000) continue;
    run.complete = false;
    run.seconds.extraction = 1;
  }
  const PowerLaw law = fitted(results, Sweep::primitives, Family::grid, extraction_milliseconds());
  EXPECT_NEAR(law.exponent, 2, 1e-9);
  EXPECT_EQ(law.count, 4U);
}

TEST_F(Scaling, ReportIsWritten) {
  const std::vector<std::string> notes = write_scaling_report(folder(), quadratic_results());
  const std::string text = read_text_file(folder() / "scaling.md");
  EXPECT_NE(text.find("Some CPU, 2 cores"), std::string::npos);
  EXPECT_NE(text.find("seeds 1 to 2"), std::string::npos);
  EXPECT_NE(read_text_file(folder() / "runs.csv").find("\ngrid,,10,"), std::string::npos);
  const std::string script = read_text_file(folder() / "time_primitives.gp");
  EXPECT_NE(script.find("set logscale xy"), std::string::npos);
  EXPECT_NE(script.find("grid ~ n^2.00"), std::string::npos) << script;
  EXPECT_NE(script.find("$line0 << END\n10 "), std::string::npos) << script;
  if (!notes.empty()) GTEST_SKIP() << "gnuplot is not installed";
  for (const Figure& figure : scaling_figures(quadratic_results())) {
    EXPECT_NE(read_text_file(folder() / (figure.name + ".svg")).find("</svg>"), std::string::npos) << figure.name;
  }
}

/// The address sanitizer does, to catch its use.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool k_keeps_freed_memory = true;
#elif defined(__has_feature)
constexpr bool k_keeps_freed_memory = __has_feature(address_sanitizer);
#else
constexpr bool k_keeps_freed_memory = false;
#endif

TEST(PeakMemory, IsWhatWasUsedAtOnce) {
  constexpr std::size_t k_bytes = std::size_t{64} << 20U;
  const PeakMemory memory;
  if (!memory.grown_bytes()) GTEST_SKIP() << "the system does not tell";
  for (int i = 0; i < 3; ++i) {
    const std::vector<char> block(k_bytes, static_cast<char>(i + 1));
    ASSERT_EQ(block[k_bytes / 2], i + 1);
  }
  EXPECT_GE(*memory.grown_bytes(), k_bytes * 9 / 10);
  if (!k_keeps_freed_memory) {
    EXPECT_LE(*memory.grown_bytes(), k_bytes * 3);
  }
}

}  // namespace
}  // namespace cloud2csg::test
