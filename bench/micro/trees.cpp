#include <memory>
#include <stdexcept>

#include "cloud2csg/advanced/merge.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "micro/work.hpp"
#include "scene.hpp"

/// Merging of partition trees and simplification, per node.
namespace cloud2csg::bench {
namespace {

constexpr std::size_t k_points_for_trees = 20'000;

/// Reads each node once and writes each remaining node once.
Work node_work(std::span<const CsgTree> before, std::span<const CsgTree> after) {
  const std::size_t nodes = total_size(before);
  return {.unit = "node",
          .units = static_cast<double>(nodes),
          .bytes_read = sizeof(CsgNode),
          .bytes_written = static_cast<double>(sizeof(CsgNode) * total_size(after)) / static_cast<double>(nodes),
          .footprint = sizeof(CsgNode) * (nodes + total_size(after))};
}

Microbenchmark merging(const char* name) {
  const auto trees = std::make_shared<std::vector<CsgTree>>(clique_trees(Scene(name, k_points_for_trees)));
  const MergeResult merged = merge_trees(*trees);
  return {std::string("merge/") + name, node_work(*trees, merged.trees), [=] {
            if (merge_trees(*trees).trees.size() != merged.trees.size()) throw std::logic_error("another merge");
          }};
}

/// Each run simplifies all trees.
Microbenchmark simplifying(std::size_t primitives, int height) {
  const auto trees = std::make_shared<std::vector<CsgTree>>(random_trees(primitives, height, 20'000));
  std::vector<CsgTree> simple;
  for (const CsgTree& tree : *trees) simple.push_back(simplify(tree));
  const std::size_t nodes = total_size(simple);
  return {"simplify/random_" + std::to_string(primitives), node_work(*trees, simple), [=] {
            std::size_t left = 0;
            for (const CsgTree& tree : *trees) left += simplify(tree).size();
            if (left != nodes) throw std::logic_error("other trees");
          }};
}

}  // namespace

std::vector<Microbenchmark> tree_benchmarks() {
  return {merging("m0"), merging("m2"), simplifying(6, 8), simplifying(20, 24)};
}

}  // namespace cloud2csg::bench
