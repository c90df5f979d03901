#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "bench/experiment/scaling.hpp"
#include "cloud2csg/error.hpp"

namespace cloud2csg::test {
namespace {

ScalingOptions small() {
  return {.families = {Family::random, Family::grid},
          .primitives = {20, 10},
          .points_per_primitive = 100,
          .at_points = 2000,
          .points = {1000, 2000},
          .at_primitives = 20,
          .cliques = {2, 4},
          .repeats = 2,
          .threads = 2};
}

TEST(ScalingPlan, SweepsAscend) {
  const std::vector<ScalingCase> cases = cases_of(small(), Sweep::primitives, Family::grid);
  ASSERT_EQ(cases.size(), 2U);
  EXPECT_EQ(cases[0].primitives, 10U);
  EXPECT_EQ(cases[0].points, 1000U);
  EXPECT_EQ(cases[1].primitives, 20U);
  EXPECT_EQ(cases[1].points, 2000U);
  EXPECT_EQ(size_in(Sweep::primitives, cases[1]), 20);
  EXPECT_EQ(size_in(Sweep::points, cases[1]), 2000);
}

TEST(ScalingPlan, OnlyRandomHasCliques) {
  EXPECT_TRUE(cases_of(small(), Sweep::cliques, Family::grid).empty());
  const std::vector<ScalingCase> cases = cases_of(small(), Sweep::cliques, Family::random);
  ASSERT_EQ(cases.size(), 2U);
  EXPECT_EQ(cases[0].clique_size, 2U);
  EXPECT_EQ(size_in(Sweep::cliques, cases[1]), 4);
}

TEST(ScalingPlan, HoldsEveryCaseOfEverySweepOnceARepeat) {
  const ScalingOptions options = small();
  const auto plan = plan_runs(options);
  for (auto run = plan.begin(); run != plan.end(); ++run) EXPECT_EQ(std::find(plan.begin(), run, *run), run);
  for (const Family family : options.families) {
    std::vector<ScalingCase> wanted = thread_cases(options, family);
    for (const Sweep sweep : all_sweeps()) {
      const std::vector<ScalingCase> cases = cases_of(options, sweep, family);
      wanted.insert(wanted.end(), cases.begin(), cases.end());
    }
    for (const ScalingCase& one : wanted) {
      for (const std::uint64_t seed : {1U, 2U}) {
        EXPECT_EQ(std::count(plan.begin(), plan.end(), std::pair(one, seed)), 1);
      }
    }
  }
}

TEST(ScalingPlan, TheLargestRunsOnOneThreadToo) {
  const std::vector<ScalingCase> cases = thread_cases(small(), Family::grid);
  ASSERT_EQ(cases.size(), 2U);
  EXPECT_EQ(cases[0].threads, 1);
  EXPECT_EQ(cases[1].threads, 2);
  EXPECT_EQ(cases[0].primitives, 20U);
  ScalingOptions single = small();
  single.threads = 1;
  EXPECT_EQ(thread_cases(single, Family::grid).size(), 1U);
}

TEST(ScalingPlan, BadOptionsAreNamed) {
  const auto refused = [](const auto& change) {
    ScalingOptions options = small();
    change(options);
    try {
      validate(options);
    } catch (const Error& error) {
      return error.parts().where;
    }
    return std::string("none");
  };
  EXPECT_EQ(refused([](ScalingOptions&) {}), "none");
  EXPECT_EQ(refused([](ScalingOptions& o) { o.families.clear(); }), "families");
  EXPECT_EQ(refused([](ScalingOptions& o) { o.families = {Family::grid, Family::grid}; }), "families");
  EXPECT_EQ(refused([](ScalingOptions& o) { o.primitives = {10, 10}; }), "primitives");
  EXPECT_EQ(refused([](ScalingOptions& o) { o.points = {0}; }), "points");
  EXPECT_EQ(refused([](ScalingOptions& o) { o.cliques = {21}; }), "cliques");
  EXPECT_EQ(refused([](ScalingOptions& o) { o.noise = -1; }), "noise");
  EXPECT_EQ(refused([](ScalingOptions& o) { o.repeats = 0; }), "repeats");
  EXPECT_EQ(refused([](ScalingOptions& o) { o.threads = 0; }), "threads");
  EXPECT_EQ(refused([](ScalingOptions& o) { o.time_limit_seconds = std::numeric_limits<double>::infinity(); }),
            "time_limit_seconds");
}

}  // namespace
}  // namespace cloud2csg::test
