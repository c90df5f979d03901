#include <algorithm>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "micro/work.hpp"
#include "scene.hpp"

namespace cloud2csg::bench {
namespace {

/// Work per class: a minimum or maximum per inner node, one more operation per sign change, and one score look-up.
/// Memory: one rank per leaf, and the table's cache line with the score.
Work evaluation_work(const RankClasses& table, const CsgTree& tree) {
  const std::size_t row = 2 * table.primitive_count() + 1;
  Work work{.unit = "tree x class", .units = static_cast<double>(table.class_count())};
  for (const CsgNode& node : tree.nodes()) {
    if (!node.is_leaf()) work.byte_extrema += node.operation() == Operation::difference ? 2 : 1;
  }
  work.look_ups = 1;
  work.look_up_rows = table.class_count();
  work.look_up_row = row;
  const std::size_t line = std::min<std::size_t>(64, row * sizeof(float));
  work.bytes_read = static_cast<double>(leaf_count(tree) + line);
  work.footprint = table.class_count() * (primitives_of(tree).size() + line);  // the same tree reads the same lines
  return work;
}

Microbenchmark evaluation(const std::string& name, RankClasses table, const CsgTree& tree) {
  const auto shared = std::make_shared<RankClasses>(std::move(table));
  const auto scratch = std::make_shared<RankScratch>();
  return {name, evaluation_work(*shared, tree), [=] {
            if (shared->geometry(tree, *scratch) < 0) throw std::logic_error("scores are not negative");
          }};
}

}  // namespace

std::vector<Microbenchmark> evaluation_benchmarks() {
  std::vector<Microbenchmark> all;
  for (const char* name : {"m0", "m2"}) {
    const Scene scene(name, k_points);
    std::vector<PrimitiveIndex> whole(scene.model.primitives.size());
    std::iota(whole.begin(), whole.end(), PrimitiveIndex{0});
    const std::vector<RankClassesRequest> requests{{.primitives = whole, .all_points = true}};
    PointPass pass = build_rank_classes(scene.cloud, scene.model.primitives, requests, scene.options);
    all.push_back(evaluation(std::string("evaluation/") + name, std::move(pass.tables.front()), *scene.model.tree));
  }
  RankClasses clique = largest_clique_table(Scene("m0", k_points));
  CsgTree tree = CsgTree::leaf(0);
  for (PrimitiveIndex p = 1; p < clique.primitive_count(); ++p) {
    tree = p % 2 == 0 ? unite(tree, CsgTree::leaf(p)) : subtract(tree, CsgTree::leaf(p));
  }
  all.push_back(evaluation("evaluation/m0_largest_clique", std::move(clique), tree));
  return all;
}

}  // namespace cloud2csg::bench
