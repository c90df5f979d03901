#include "bench/experiment/reference_extraction.hpp"

#include "cloud2csg/sample.hpp"
#include "experiment/experiment_fixture.hpp"
#include "paper/evolve/genetic_algorithm.hpp"

namespace cloud2csg::test {
namespace {

class ReferenceExtraction : public ExperimentTest {
 protected:
  ReferenceExtraction()
      : model_(read_model(shipped_models() / "m1.json")),
        cloud_(sample_surface(*model_.tree, model_.primitives, {.count = 300, .noise = 0.01})) {}

  /// As text, so that a difference can be read.
  [[nodiscard]] std::string tree_by_points(const ExtractOptions& options, int threads = 1) const {
    return text_of(reference_extraction(cloud_, model_.primitives, options, {.threads = threads}));
  }
  [[nodiscard]] std::string text_of(const Extraction& extraction) const {
    return to_text(extraction.tree, model_.primitives);
  }

  Model model_;
  PointCloud cloud_;
};

TEST_F(ReferenceExtraction, FindsTheTreeThatClassesFind) {
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

TEST_F(ReferenceExtraction, IsTheSameForAnyThreads) {
  ExtractOptions options = paper_options();
  options.parallel = Parallel::none;
  const std::string once = tree_by_points(options);
  for (const Parallel parallel : {Parallel::population, Parallel::partitions, Parallel::both}) {
    options.parallel = parallel;
    EXPECT_EQ(tree_by_points(options, 2), once) << to_string(parallel);
  }
}

TEST_F(ReferenceExtraction, GoesIntoTheExperiment) {
  PaperOptions options = small_experiment();
  options.low_points = 60;
  options.high_points = 120;
  options.evaluator = "reference";
  const PaperResults results = reproduce(options);
  EXPECT_EQ(results.runs.size(), 12U);
  EXPECT_EQ(mode_disagreements(results), std::vector<std::string>{});
  for (const PaperRun& run : results.runs) {
    EXPECT_EQ(run.seconds.classes, 0);
    EXPECT_GT(run.evaluations, 0U);
    EXPECT_GT(run.generations, 9U);
  }
}

TEST_F(ReferenceExtraction, GeneticAlgorithmCountsEvaluationsOfAnyObjective) {
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
