#include "scene.hpp"

#include <algorithm>

#include "cloud2csg/csg_tree.hpp"
#include "paper/evolve/genetic_algorithm.hpp"

namespace cloud2csg::bench {

Scene::Scene(const std::string& model_name, std::size_t points)
    : name(model_name), model(shipped_model(model_name)), cloud(paper_cloud(model, points, 1)) {
  const double noise = estimate_noise(cloud, model.primitives);
  options = {.tolerances = segmentation_tolerances({}, noise), .noise = noise};
  const OverlapGraph graph = build_overlap_graph(model.primitives, {.tolerance = noise});
  cliques = maximal_cliques(graph);
  for (const Clique& clique : cliques) requests.push_back({.primitives = clique});
  for (const Clique& component : connected_components(graph)) requests.push_back({.primitives = component});
}

std::vector<CsgTree> clique_trees(const Scene& scene) {
  std::vector<CsgTree> trees;
  for (const Clique& clique : scene.cliques) {
    std::vector<CsgNode> nodes(scene.model.tree->nodes().begin(), scene.model.tree->nodes().end());
    for (CsgNode& node : nodes) {
      const bool is_kept =
          node.operation() != Operation::primitive || std::ranges::binary_search(clique, node.primitive());
      if (!is_kept) node = CsgNode::constant(Operation::empty);
    }
    trees.push_back(simplify(CsgTree(std::move(nodes))));
  }
  return trees;
}

RankClasses largest_clique_table(const Scene& scene) {
  const auto largest = std::ranges::max_element(scene.cliques, {}, [](const Clique& clique) { return clique.size(); });
  const std::vector<RankClassesRequest> request{{.primitives = *largest}};
  return build_rank_classes(scene.cloud, scene.model.primitives, request, scene.options).tables.front();
}

std::vector<CsgTree> random_trees(std::size_t primitives, int height, std::size_t nodes) {
  RandomStream random(primitives);
  std::vector<CsgTree> trees;
  while (total_size(trees) < nodes) trees.push_back(random_tree(primitives, height, random));
  return trees;
}

std::size_t total_size(std::span<const CsgTree> trees) {
  std::size_t size = 0;
  for (const CsgTree& tree : trees) size += tree.size();
  return size;
}

}  // namespace cloud2csg::bench
