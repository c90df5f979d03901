#include "paper/paper_method.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "cloud2csg/model.hpp"
#include "cloud2csg/sample.hpp"
#include "paper/evolve/genetic_algorithm.hpp"

namespace cloud2csg::test {
namespace {

class PaperMethod : public ::testing::Test {
 protected:
  PaperMethod()
      : model_(read_model(std::filesystem::path(CLOUD2CSG_DATA_DIR) / "models" / "m1.json")),
        cloud_(sample_surface(model_, {.count = 300, .noise = 0.01})) {}

  /// As text, so that a difference can be read.
  [[nodiscard]] std::string tree_by_points(const ExtractOptions& options, int threads = 1) const {
    return text_of(extract_as_in_paper(cloud_, model_.primitives, options, {.threads = threads}));
  }
  [[nodiscard]] std::string text_of(const Extraction& extraction) const {
    return to_text(extraction.tree(), model_.primitives);
  }

  Model model_;
  PointCloud cloud_;
};

TEST_F(PaperMethod, FindsTheTreeThatClassesFind) {
  for (const Strategy strategy : {Strategy::baseline, Strategy::partition}) {
    std::size_t compared = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      ExtractOptions options = paper_options();
      options.strategy = strategy;
      options.seed = seed;
      const Extraction by_classes = extract_csg(cloud_, model_.primitives, options, {});
      // Where extract_csg() took a fall-back, which the reference does not have, it is right to differ.
      const MergeWay way = by_classes.statistics.merge.ways.front();
      if (way != MergeWay::paper && way != MergeWay::single) continue;
      ++compared;
      EXPECT_EQ(tree_by_points(options), text_of(by_classes)) << to_string(strategy) << ", seed " << seed;
    }
    EXPECT_GE(compared, 1U) << to_string(strategy);
  }
}

TEST_F(PaperMethod, IsTheSameForAnyThreads) {
  ExtractOptions options = paper_options();
  options.parallel = Parallel::none;
  const std::string once = tree_by_points(options);
  for (const Parallel parallel : {Parallel::population, Parallel::partitions, Parallel::both}) {
    options.parallel = parallel;
    EXPECT_EQ(tree_by_points(options, 2), once) << to_string(parallel);
  }
}

TEST_F(PaperMethod, GeneticAlgorithmCountsEvaluationsOfAnyObjective) {
  // The smallest tree is the best.
  const TreeObjective objective{.primitives = 3, .geometry = [](const CsgTree&) { return 7.0; }, .alpha = 2};
  const Evolution found = run_genetic_algorithm(objective, {}, paper_ga_options(), 0, {});
  EXPECT_EQ(found.tree.size(), 1U);
  EXPECT_EQ(found.score, 5);
  EXPECT_EQ(found.geometry, 7);
  // 150 at first, then all but the two elites anew.
  EXPECT_EQ(found.evaluations, 150 + 148 * found.generations);
}

}  // namespace
}  // namespace cloud2csg::test
