#include <gtest/gtest.h>

#include <numeric>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "cloud2csg/error.hpp"
#include "cloud2csg/extract.hpp"
#include "pipeline/strategies.hpp"
#include "support/known_solids.hpp"
#include "tree/random_trees.hpp"

namespace cloud2csg {
namespace {

struct Input {
  Model model;
  PointCloud cloud;
};

Input small_input(const char* name) {
  Input input{.model = test::paper_model(name), .cloud = {}};
  input.cloud = sample_surface(input.model, {.count = 2000, .noise = 0.01, .seed = 5});
  return input;
}

/// A search that does not end by itself within the test.
ExtractOptions endless(Strategy strategy) {
  ExtractOptions options;
  options.strategy = strategy;
  options.cell_trust = test::k_never_by_cells;
  options.search.listing_limit = 1;
  options.search.seeds = false;  // or a local search may find what needs no more
  options.search.idle_generations = 1'000'000;
  options.search.generation_limit = 1'000'000;
  return options;
}

void expect_the_best_so_far(const Extraction& result, const PrimitiveSet& primitives) {
  EXPECT_FALSE(result.statistics.complete);
  EXPECT_TRUE(test::is_well_formed(result.tree()));
  ASSERT_FALSE(primitives_of(result.tree()).empty());
  EXPECT_LT(primitives_of(result.tree()).back(), primitives.size());
  ASSERT_FALSE(result.statistics.warnings.empty());
  EXPECT_NE(result.statistics.warnings.back().find("stopped early"), std::string::npos);
}

TEST(Interruption, BeforeTheSearchThereIsNothingToGive) {
  const Input input = small_input("m0");
  std::stop_source stop;
  stop.request_stop();
  for (const ExtractOptions& options : test::all_strategies()) {
    for (const int threads : {1, 2}) {
      const RunContext run{.stop = stop.get_token(), .threads = threads};
      EXPECT_THROW((void)extract_csg(input.cloud, input.model.primitives, options, run), Cancelled);
    }
  }
}

/// The first partition that is done asks for the end.
TEST(Interruption, DuringTheSearchGivesTheBestSoFar) {
  const Input input = small_input("m0");
  for (const Strategy strategy : {Strategy::automatic, Strategy::partition}) {
    const ExtractOptions options{.strategy = strategy, .cell_trust = test::k_never_by_cells};
    for (const int threads : {1, 2}) {
      std::stop_source stop;
      const auto stop_at_first = [&stop](const Progress& progress) {
        if (progress.stage == "search" && progress.done > 0) stop.request_stop();
      };
      const RunContext run{.stop = stop.get_token(), .on_progress = stop_at_first, .threads = threads};
      expect_the_best_so_far(extract_csg(input.cloud, input.model.primitives, options, run), input.model.primitives);
    }
  }
}

class TimeLimitOfASearch : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Paper, TimeLimitOfASearch, ::testing::Values("m0", "m1", "m2", "m3"));

TEST_P(TimeLimitOfASearch, EndsEverySearchWithATree) {
  const Input input = small_input(GetParam());
  for (const Strategy strategy : {Strategy::automatic, Strategy::partition, Strategy::baseline}) {
    for (const double seconds : {1e-9, 0.05}) {
      ExtractOptions options = endless(strategy);
      options.time_limit_seconds = seconds;
      expect_the_best_so_far(extract_csg(input.cloud, input.model.primitives, options, {.threads = 2}),
                             input.model.primitives);
    }
  }
}

/// The tree of the cells comes with the pass over the points, which is always completed.
TEST_P(TimeLimitOfASearch, LeavesTheTreeOfTheCells) {
  const Input input = small_input(GetParam());
  for (const Strategy strategy : {Strategy::automatic, Strategy::cells}) {
    const Extraction expected = extract_csg(input.cloud, input.model.primitives, {.strategy = strategy});
    const Extraction result =
        extract_csg(input.cloud, input.model.primitives, {.strategy = strategy, .time_limit_seconds = 1e-9});
    EXPECT_EQ(result.tree(), expected.tree());
    EXPECT_TRUE(result.statistics.complete);
    EXPECT_TRUE(result.statistics.warnings.empty());
  }
}

/// Also where the tree of the cells is the one that is taken.
TEST_P(TimeLimitOfASearch, SaysThatPartitionsWereNotSearched) {
  const Input input = small_input(GetParam());
  const Extraction result =
      extract_csg(input.cloud, input.model.primitives, {.cell_trust = 1, .time_limit_seconds = 1e-9});
  EXPECT_FALSE(result.statistics.complete);
  ASSERT_FALSE(result.statistics.warnings.empty());
  EXPECT_EQ(result.statistics.warnings.back(), "stopped early: this is the best tree so far");
}

TEST(TimeLimitThatIsLong, ChangesNothing) {
  const Input input = small_input("m1");
  for (ExtractOptions options : test::with_and_without_cells()) {
    const Extraction expected = extract_csg(input.cloud, input.model.primitives, options);
    options.time_limit_seconds = 3600;
    const Extraction result = extract_csg(input.cloud, input.model.primitives, options);
    EXPECT_EQ(result.tree(), expected.tree());
    EXPECT_TRUE(result.statistics.complete);
  }
}

TEST(Progress, CountsPartitionsAndComponents) {
  const Input input = small_input("m0");
  std::vector<std::size_t> search;
  std::vector<std::size_t> merge;
  const RunContext run{.stop = {},
                       .on_progress =
                           [&](const Progress& progress) {
                             if (progress.stage == "search") search.push_back(progress.done);
                             if (progress.stage == "merge") merge.push_back(progress.done);
                             EXPECT_LE(progress.done, progress.total);
                           },
                       .threads = 3};
  const ExtractOptions options{.cell_trust = test::k_never_by_cells};
  const Extraction result = extract_csg(input.cloud, input.model.primitives, options, run);
  std::vector<std::size_t> expected(result.statistics.partitions.size() + 1);
  std::iota(expected.begin(), expected.end(), std::size_t{0});
  EXPECT_EQ(search, expected);
  EXPECT_EQ(merge.size(), result.statistics.components);
}

TEST(Progress, ASingleSearchTellsItsGenerations) {
  const Input input = small_input("m0");
  std::vector<std::size_t> generations;
  const RunContext run{.stop = {},
                       .on_progress =
                           [&generations](const Progress& progress) {
                             if (progress.stage == "search" && progress.total == 0)
                               generations.push_back(progress.done);
                           },
                       .threads = 2};
  ExtractOptions options{.strategy = Strategy::baseline};
  options.search.generation_limit = 5;
  options.search.seeds = false;
  (void)extract_csg(input.cloud, input.model.primitives, options, run);
  ASSERT_GE(generations.size(), 5U);
  EXPECT_EQ(std::vector(generations.begin(), generations.begin() + 5), (std::vector<std::size_t>{0, 1, 2, 3, 4}));
}

TEST(Progress, ErrorsOfTheCallerComeThrough) {
  const Input input = small_input("m0");
  struct Mine {};
  const auto extract_until = [&input](std::string_view stage, const ExtractOptions& options) {
    const auto throw_at = [stage](const Progress& progress) {
      if (progress.stage == stage) throw Mine{};
    };
    (void)extract_csg(input.cloud, input.model.primitives, options,
                      {.stop = {}, .on_progress = throw_at, .threads = 2});
  };
  EXPECT_THROW(extract_until("segment", {}), Mine);
  EXPECT_THROW(extract_until("search", {.cell_trust = test::k_never_by_cells}), Mine);
}

}  // namespace
}  // namespace cloud2csg
