#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "bench/experiment/paper.hpp"
#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

/// Five repeats of one model: durations about 100 ms, 1 % apart; trees of 9 nodes.
PaperResults steady_results() {
  PaperResults results{.options = {.models = {"m"}}};
  for (const RunName& name : plan_runs(results.options)) {
    PaperRun run{.name = name, .finished = {}, .formula = {}};
    run.seconds.extraction = 0.1 + 0.001 * static_cast<double>(name.seed);
    run.tree.size = 9;
    run.evaluations = 1000 + 10 * name.seed;
    results.runs.push_back(run);
  }
  return results;
}

PaperResults changed(const std::function<void(PaperRun&)>& change) {
  PaperResults results = steady_results();
  for (PaperRun& run : results.runs) change(run);
  return results;
}

std::size_t count_of(const std::vector<Change>& changes, Difference difference) {
  return static_cast<std::size_t>(std::count_if(changes.begin(), changes.end(),
                                                [difference](const Change& c) { return c.difference == difference; }));
}

TEST(CompareResults, NothingChanged) {
  const std::vector<Change> changes = compare_paper_results(steady_results(), steady_results());
  // Two samplings; durations of six modes, three more measures of two.
  EXPECT_EQ(changes.size(), 2U * (6 + 3 * 2));
  EXPECT_EQ(count_of(changes, Difference::same), changes.size());
}

TEST(CompareResults, SlowerModeIsWorse) {
  const PaperResults slower = changed([](PaperRun& run) {
    if (run.name.mode == "SMTP" && run.name.sampling == Sampling::high) run.seconds.extraction *= 1.2;
  });
  const std::vector<Change> changes = compare_paper_results(steady_results(), slower);
  ASSERT_EQ(count_of(changes, Difference::worse), 1U);
  EXPECT_EQ(count_of(changes, Difference::same), changes.size() - 1);
  const auto worse = std::find_if(changes.begin(), changes.end(),
                                  [](const Change& change) { return change.difference == Difference::worse; });
  EXPECT_EQ(worse->mode, "SMTP");
  EXPECT_EQ(worse->sampling, Sampling::high);
  EXPECT_EQ(worse->measure, "duration, ms");
  EXPECT_NEAR(worse->relative, 0.2, 1e-9);
  // The other way round it is better.
  const std::vector<Change> back = compare_paper_results(slower, steady_results());
  EXPECT_EQ(count_of(back, Difference::better), 1U);
  EXPECT_EQ(count_of(back, Difference::worse), 0U);
}

TEST(CompareResults, ChangeWithinTheNoiseIsNone) {
  // The mean moves by a fifth, by one run that took twice as long.
  const PaperResults noisy = changed([](PaperRun& run) {
    if (run.name.seed == 5) run.seconds.extraction *= 2;
  });
  EXPECT_EQ(count_of(compare_paper_results(steady_results(), noisy), Difference::worse), 0U);
}

TEST(CompareResults, SureButSmallChangeIsNone) {
  const PaperResults a_bit = changed([](PaperRun& run) { run.seconds.extraction *= 1.08; });
  EXPECT_EQ(count_of(compare_paper_results(steady_results(), a_bit), Difference::worse), 0U);
  EXPECT_EQ(count_of(compare_paper_results(steady_results(), a_bit, {.least_time_change = 0.05}), Difference::worse),
            12U);
}

TEST(CompareResults, LargerTreesAreWorse) {
  const PaperResults larger = changed([](PaperRun& run) { run.tree.size = 10; });
  const std::vector<Change> changes = compare_paper_results(steady_results(), larger);
  EXPECT_EQ(count_of(changes, Difference::worse), 4U);  // BST and SST, low and high
  for (const Change& change : changes) {
    EXPECT_EQ(change.difference == Difference::worse, change.measure == "nodes") << change.measure;
  }
}

TEST(CompareResults, OneRepeatTellsNothing) {
  PaperResults single = steady_results();
  std::erase_if(single.runs, [](const PaperRun& run) { return run.name.seed > 1; });
  const std::vector<Change> changes = compare_paper_results(steady_results(), single);
  EXPECT_EQ(count_of(changes, Difference::unknown), changes.size());
}

TEST(CompareResults, OtherOptionsAreRefusedByName) {
  PaperResults other = steady_results();
  other.options.high_points = 999'999;
  try {
    (void)compare_paper_results(steady_results(), other);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().where, "high points");
  }
  // More repeats are more of the same.
  other = steady_results();
  other.options.repeats = 6;
  EXPECT_NO_THROW((void)compare_paper_results(steady_results(), other));
}

TEST(CompareResults, TableShowsTheChange) {
  const PaperResults slower = changed([](PaperRun& run) { run.seconds.extraction *= 1.5; });
  const std::vector<Change> changes = compare_paper_results(steady_results(), slower);
  const std::string text = changes_markdown(changes);
  EXPECT_NE(text.find("| duration, ms | 103.0 ± 1.6"), std::string::npos) << text;
  EXPECT_NE(text.find("+50.0 %"), std::string::npos) << text;
  EXPECT_NE(text.find("worse"), std::string::npos) << text;
}

// t = 3 / sqrt(4 / 5 + 9 / 8) = 2.1622 with 10.873 degrees of freedom; the tail by numerical integration.
TEST(WelchTest, ByHand) {
  const Spread a{.count = 5, .mean = 20, .deviation = 2};
  const Spread b{.count = 8, .mean = 23, .deviation = 3};
  EXPECT_NEAR(welch_test(a, b), 0.053774, 1e-6);
  EXPECT_DOUBLE_EQ(welch_test(a, b), welch_test(b, a));
}

TEST(WelchTest, WithoutDeviation) {
  const Spread a{.count = 2, .mean = 3, .deviation = 0};
  const Spread b{.count = 2, .mean = 4, .deviation = 0};
  EXPECT_EQ(welch_test(a, a), 1);
  EXPECT_EQ(welch_test(a, b), 0);
}

}  // namespace
}  // namespace cloud2csg
