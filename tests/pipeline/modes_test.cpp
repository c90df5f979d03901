#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <tuple>

#include "cloud2csg/extract.hpp"
#include "pipeline/strategies.hpp"
#include "support/known_solids.hpp"

namespace cloud2csg {
namespace {

constexpr std::array k_parallel{Parallel::none, Parallel::population, Parallel::partitions, Parallel::both};

/// A search that takes a moment, so that all modes can be tried.
ExtractOptions short_options(Strategy strategy, std::uint64_t seed) {
  ExtractOptions options;
  options.strategy = strategy;
  options.cell_trust = test::k_never_by_cells;
  options.search.population = 40;
  options.search.idle_generations = 5;
  options.search.generation_limit = 12;
  options.search.listing_limit = 2;  // the rest is left to the genetic algorithm
  options.search.polish = false;
  options.seed = seed;
  return options;
}

/// Points of one of the paper's models.
class SampledModel {
 protected:
  explicit SampledModel(const char* name) : model_(test::paper_model(name)) {
    cloud_ = sample_surface(model_, {.count = 2000, .noise = 0.01, .seed = 5});
  }

  [[nodiscard]] Extraction extract(const ExtractOptions& options, int threads) const {
    return extract_csg(cloud_, model_.primitives, options, {.threads = threads});
  }

 private:
  Model model_;
  PointCloud cloud_;
};

class Modes : public ::testing::TestWithParam<const char*>, protected SampledModel {
 protected:
  Modes() : SampledModel(GetParam()) {}
};

class Strategies : public ::testing::TestWithParam<std::tuple<Strategy, const char*>>, protected SampledModel {
 protected:
  Strategies() : SampledModel(std::get<1>(GetParam())) {}
};

INSTANTIATE_TEST_SUITE_P(Paper, Modes, ::testing::Values("m0", "m1", "m2"));
// Shards take turns at the tests: m0 and m2, which take longest, follow each other.
INSTANTIATE_TEST_SUITE_P(Paper, Strategies,
                         ::testing::Combine(::testing::Values(Strategy::cells, Strategy::partition, Strategy::baseline,
                                                              Strategy::automatic),
                                            ::testing::Values("m0", "m2", "m1")));

TEST_P(Strategies, GiveTheSameTreeForAnyThreads) {
  ExtractOptions options = short_options(std::get<0>(GetParam()), 3);
  options.parallel = Parallel::none;
  const Extraction expected = extract(options, 1);
  for (const Parallel parallel : k_parallel) {
    options.parallel = parallel;
    for (const int threads : {1, 2, 3, 8}) {
      const Extraction result = extract(options, threads);
      EXPECT_EQ(result.tree(), expected.tree()) << to_string(options.strategy) << to_string(parallel) << threads;
      EXPECT_EQ(result.statistics.fit.objective, expected.statistics.fit.objective);
      EXPECT_EQ(result.statistics.merge.evaluations, expected.statistics.merge.evaluations);
      EXPECT_EQ(result.statistics.threads, threads);
    }
  }
}

TEST_P(Modes, TheSameSeedRepeatsItself) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const ExtractOptions options = short_options(Strategy::automatic, seed);
    const Extraction first = extract(options, 0);
    const Extraction second = extract(options, 0);
    EXPECT_EQ(first.tree(), second.tree());
    for (std::size_t k = 0; k < first.statistics.partitions.size(); ++k) {
      EXPECT_EQ(first.statistics.partitions[k].score, second.statistics.partitions[k].score);
      EXPECT_EQ(first.statistics.partitions[k].evaluations, second.statistics.partitions[k].evaluations);
    }
  }
}

TEST_P(Modes, ThePapersOptionsGiveATreeToo) {
  ExtractOptions options = paper_options();
  EXPECT_EQ(options.strategy, Strategy::partition);
  EXPECT_FALSE(options.polish);
  EXPECT_EQ(options.objective.beta, 100.0);
  EXPECT_DOUBLE_EQ(options.objective.gamma, 18 / std::numbers::pi);
  EXPECT_EQ(options.search.idle_generations, paper_ga_options().idle_generations);
  const Extraction result = extract(options, 2);
  EXPECT_FALSE(primitives_of(result.tree()).empty());
}

TEST(Names, AreThoseOfTheCommandLine) {
  EXPECT_EQ(to_string(Strategy::automatic), "auto");
  EXPECT_EQ(to_string(Strategy::cells), "cells");
  EXPECT_EQ(to_string(Strategy::partition), "partition");
  EXPECT_EQ(to_string(Strategy::baseline), "baseline");
  EXPECT_EQ(to_string(Parallel::none), "none");
  EXPECT_EQ(to_string(Parallel::population), "population");
  EXPECT_EQ(to_string(Parallel::partitions), "partitions");
  EXPECT_EQ(to_string(Parallel::both), "both");
}

}  // namespace
}  // namespace cloud2csg
