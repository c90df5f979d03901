#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/error.hpp"
#include "cloud2csg/extract.hpp"
#include "pipeline/strategies.hpp"
#include "support/scene.hpp"
#include "tree/random_trees.hpp"

namespace cloud2csg {
namespace {

/// Searches of a moment, some of them as in the paper.
ExtractOptions random_options(RandomStream& random) {
  ExtractOptions options = random.chance(0.3) ? paper_options() : ExtractOptions{};
  constexpr std::array k_strategies{Strategy::automatic, Strategy::cells, Strategy::partition, Strategy::baseline};
  constexpr std::array k_trusts{0.01, 0.97, test::k_never_by_cells};
  options.strategy = k_strategies[random.below(k_strategies.size())];
  options.cell_trust = k_trusts[random.below(k_trusts.size())];
  options.search.population = 2 + static_cast<int>(random.below(40));
  options.search.elites = static_cast<int>(random.below(2));
  options.search.idle_generations = 1 + static_cast<int>(random.below(5));
  options.search.generation_limit = 1 + static_cast<int>(random.below(10));
  options.search.listing_limit = random.below(5);
  options.search.polish = random.chance(0.5);
  options.search.seeds = random.chance(0.3);
  if (random.chance(0.3)) options.segmentation.distance_tolerance = random.uniform(0.01, 0.3);
  options.seed = random.next();
  return options;
}

void expect_valid(const Extraction& result, std::size_t primitives) {
  RC_ASSERT(test::is_well_formed(result.tree()));
  RC_ASSERT(simplify(result.tree()) == result.tree());
  for (const PrimitiveIndex p : primitives_of(result.tree())) RC_ASSERT(p < primitives);
  const bool is_searched = !result.statistics.partitions.empty();
  RC_ASSERT(is_searched || result.statistics.cells);
  RC_ASSERT(result.statistics.merge.ways.size() == (is_searched ? result.statistics.components : 0));
  RC_ASSERT(std::isfinite(result.statistics.fit.objective));
  RC_ASSERT(result.statistics.merge.worst_shortfall <= 1.0);
}

/// Solids that coincide, contain each other or lie apart, and points that fit none of it: the result may be poor, but
/// it is a tree, and the same for any number of threads.
RC_GTEST_PROP(AnyInput, GivesAValidTreeOrSaysThatNoPointIsNear, (std::uint64_t seed)) {
  RandomStream random(seed);
  const std::size_t primitives = 1 + random.below(10);
  const test::Scene scene = test::random_scene(primitives, 1 + random.below(200), random);
  ExtractOptions options = random_options(random);
  try {
    const Extraction result = extract_csg(scene.cloud, scene.primitives, options);
    expect_valid(result, primitives);
    options.parallel = Parallel::partitions;
    RC_ASSERT(extract_csg(scene.cloud, scene.primitives, options, {.threads = 3}).tree() == result.tree());
  } catch (const Error& error) {
    RC_ASSERT(error.parts().expected == "no point of the cloud is near any primitive");
  }
}

}  // namespace
}  // namespace cloud2csg
