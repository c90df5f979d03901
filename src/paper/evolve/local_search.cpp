#include "core/tree/local_search.hpp"

#include "cloud2csg/advanced/evolve.hpp"

namespace cloud2csg {

Evolution local_search(const RankClasses& table, const CsgTree& start, const LocalSearchOptions& options,
                       const RunContext& run) {
  RankScratch scratch;
  const TreeObjective objective{.primitives = table.primitive_count(),
                                .geometry = [&](const CsgTree& tree) { return table.geometry(tree, scratch); },
                                .alpha = table.objective().alpha,
                                .work_per_node = static_cast<double>(table.class_count())};
  const LocalOptimum best = local_search(objective, start, options, run);
  return {.tree = best.tree,
          .score = best.score,
          .geometry = table.geometry(best.tree, scratch),
          .evaluations = best.evaluations,
          .complete = best.complete};
}

}  // namespace cloud2csg
