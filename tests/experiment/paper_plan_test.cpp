#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <set>
#include <tuple>

#include "bench/experiment/paper.hpp"
#include "cloud2csg/error.hpp"

namespace cloud2csg {
namespace {

TEST(PaperPlan, HasEachRunOnce) {
  const std::vector<RunName> plan = plan_runs({.models = {"a", "b"}, .repeats = 3, .seed = 40});
  EXPECT_EQ(plan.size(), 2U * 2 * 3 * 6);
  std::set<std::tuple<std::string, Sampling, std::string, std::uint64_t>> different;
  for (const RunName& name : plan) different.emplace(name.model, name.sampling, name.mode, name.seed);
  EXPECT_EQ(different.size(), plan.size());
  for (const RunName& name : plan) EXPECT_TRUE(name.seed >= 40 && name.seed <= 42) << name.seed;
}

TEST(PaperPlan, ModesTakeTurns) {
  const std::vector<RunName> plan = plan_runs({.models = {"a"}, .repeats = 2});
  ASSERT_EQ(plan.size(), 2U * 2 * 6);
  for (std::size_t i = 0; i < plan.size(); ++i) EXPECT_EQ(plan[i].mode, paper_modes()[i % 6].name) << i;
}

TEST(PaperPlan, ModesAreThoseOfThePaper) {
  EXPECT_EQ(paper_mode("BMTGA").strategy, Strategy::baseline);
  EXPECT_EQ(paper_mode("BMTGA").parallel, Parallel::population);
  EXPECT_EQ(paper_mode("SMTP").strategy, Strategy::partition);
  EXPECT_EQ(paper_mode("SMTP").parallel, Parallel::partitions);
  EXPECT_THROW((void)paper_mode("SMT"), Error);
}

TEST(PaperPlan, OptionsAreRefusedByName) {
  const auto refused = [](const std::function<void(PaperOptions&)>& change) -> std::string {
    PaperOptions options{.models = {"m1"}};
    change(options);
    try {
      validate(options);
    } catch (const Error& error) {
      return error.parts().where;
    }
    return "nothing";
  };
  EXPECT_EQ(refused([](PaperOptions&) {}), "nothing");
  EXPECT_EQ(refused([](PaperOptions& o) { o.models.clear(); }), "models");
  EXPECT_EQ(refused([](PaperOptions& o) { o.models = {"m1", "m0", "m1"}; }), "models");
  EXPECT_EQ(refused([](PaperOptions& o) { o.low_points = 0; }), "low_points");
  EXPECT_EQ(refused([](PaperOptions& o) { o.high_points = o.low_points; }), "high_points");
  EXPECT_EQ(refused([](PaperOptions& o) { o.noise = -1; }), "noise");
  EXPECT_EQ(refused([](PaperOptions& o) { o.noise = std::numeric_limits<double>::infinity(); }), "noise");
  EXPECT_EQ(refused([](PaperOptions& o) { o.repeats = 0; }), "repeats");
  EXPECT_EQ(refused([](PaperOptions& o) { o.threads = 0; }), "threads");
  EXPECT_EQ(refused([](PaperOptions& o) { o.evaluator = PaperEvaluator::reference; }), "nothing");
  EXPECT_EQ(refused([](PaperOptions& o) { o.evaluator = PaperEvaluator::reference, o.preset = PaperPreset::standard; }),
            "evaluator");
}

}  // namespace
}  // namespace cloud2csg
