#pragma once

#include <string>
#include <vector>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "cloud2csg/advanced/rank_classes.hpp"
#include "measure.hpp"

namespace cloud2csg::bench {

/// A shipped model, its cloud as in the paper, and the extraction's data before the search; one core.
struct Scene {
  Scene(const std::string& model_name, std::size_t points);

  std::string name;
  Model model;
  PointCloud cloud;
  PointPassOptions options;
  std::vector<Clique> cliques;
  /// One per clique, then one per connected component.
  std::vector<RankClassesRequest> requests;
};

/// For each clique, the true tree restricted to it: similar to a search result, without a search.
[[nodiscard]] std::vector<CsgTree> clique_trees(const Scene& scene);

[[nodiscard]] RankClasses largest_clique_table(const Scene& scene);

/// Formulas like those of the genetic algorithm, with at least `nodes` nodes in all.
[[nodiscard]] std::vector<CsgTree> random_trees(std::size_t primitives, int height, std::size_t nodes);

[[nodiscard]] std::size_t total_size(std::span<const CsgTree> trees);

}  // namespace cloud2csg::bench
