#include <gtest/gtest.h>

#include "bench/families/family.hpp"
#include "cells/labelled.hpp"
#include "cloud2csg/sample.hpp"

namespace cloud2csg {
namespace {

/// Clusters of twelve solids, more than 64 in all, and the same cluster by cluster.
TEST(SolveLargeCells, ClimbsCoreByCoreInLargeModels) {
  const CellSolveOptions options;
  CellSolveOptions without = options;
  without.climb.work_limit = 0;
  const auto total = [&](const CellSolution& of) {
    return of.cost + options.leaf_cost * static_cast<double>(leaf_count(of.tree));
  };
  std::size_t better = 0;
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Model model = make_family(Family::random, {.primitives = 72, .clique_size = 12, .seed = seed});
    const PointCloud cloud = sample_surface(model, {.count = 9000, .noise = k_noise, .seed = seed});
    const Labelled labelled = label(cloud, model.primitives);
    const std::optional<CellSolution> climbed = labelled.solve(options);
    const std::optional<CellSolution> start = labelled.solve(without);
    ASSERT_TRUE(climbed && start);
    EXPECT_LE(total(*climbed), total(*start)) << seed;
    EXPECT_TRUE(has_labels(climbed->tree, labelled, options.least_evidence.front())) << seed;
    EXPECT_LE(climbed->least_leaves.value_or(0), leaf_count(climbed->tree)) << seed;
    better += total(*climbed) < total(*start) ? 1 : 0;
    ASSERT_FALSE(climbed->steps.empty());
    EXPECT_EQ(climbed->steps.front().size, start->steps.front().size);
    EXPECT_EQ(climbed->steps.back().size, climbed->tree.size());
  }
  EXPECT_GT(better, 0U);
}

}  // namespace
}  // namespace cloud2csg
