#pragma once

#include <string>
#include <vector>

#include "cloud2csg/advanced/overlap_graph.hpp"
#include "cloud2csg/advanced/rank_classes.hpp"
#include "measure.hpp"

namespace cloud2csg::bench {

/// A shipped model, its cloud as in the paper, and what the extraction makes of both before it searches: one core.
struct Scene {
  Scene(const std::string& model_name, std::size_t points);

  std::string name;
  Model model;
  PointCloud cloud;
  PointPassOptions options;
  std::vector<Clique> cliques;
  /// One for each clique, then one for each connected component.
  std::vector<RankClassesRequest> requests;
};

/// For each clique, what is left of the true tree without the other primitives: much like what a search finds, without
/// depending on one.
[[nodiscard]] std::vector<CsgTree> clique_trees(const Scene& scene);

/// The table of the clique with the most primitives.
[[nodiscard]] RankClasses largest_clique_table(const Scene& scene);

/// Formulas over some primitives as the genetic algorithm makes them, of so many nodes in all or a few more.
[[nodiscard]] std::vector<CsgTree> random_trees(std::size_t primitives, int height, std::size_t nodes);

[[nodiscard]] std::size_t total_size(std::span<const CsgTree> trees);

}  // namespace cloud2csg::bench
