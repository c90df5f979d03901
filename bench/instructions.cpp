// Runs the steps of the extraction in sequence on one thread, to count their instructions: scripts/instructions.sh runs
// this under callgrind. Always uses AVX2, so that the counts hold for any x86 machine of the last ten years.

#include <fmt/format.h>
#include <hwy/highway.h>
#include <hwy/targets.h>
#include <valgrind/callgrind.h>

#include <cstdio>

#include "cloud2csg/advanced/evolve.hpp"
#include "cloud2csg/advanced/merge.hpp"
#include "cloud2csg/csg_tree.hpp"
#include "cloud2csg/extract.hpp"
#include "random_solids.hpp"
#include "scene.hpp"

namespace cloud2csg::bench {
namespace {

constexpr std::size_t k_points = 10'000;

void use_avx2() {
  hwy::SetSupportedTargetsForTest(HWY_AVX2);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

/// Counts the instructions of `work` as a section. Prints its result, since another result explains another count.
template <class Work>
void count(const char* name, const Work& work) {
  CALLGRIND_START_INSTRUMENTATION;
  CALLGRIND_ZERO_STATS;
  const std::size_t result = work();
  CALLGRIND_DUMP_STATS_AT(name);
  CALLGRIND_STOP_INSTRUMENTATION;
  fmt::print("{} {}\n", name, result);
  std::fflush(stdout);
}

void count_overlap() {
  const PrimitiveSet solids = random_solids(1000, 2.0);
  OverlapGraph graph;
  count("overlap_graph", [&] {
    graph = build_overlap_graph(solids);
    return graph.edge_count();
  });
  count("cliques", [&] { return maximal_cliques(graph).size(); });
}

void count_steps(const Scene& scene) {
  count("class_pass_m0", [&] {
    return build_rank_classes(scene.cloud, scene.model.primitives, scene.requests, scene.options)
        .tables.back()
        .class_count();
  });
  const RankClasses table = largest_clique_table(scene);
  count("search_m0", [&] {
    GaOptions options = paper_ga_options();
    options.generation_limit = 100;
    options.idle_generations = options.generation_limit;
    return evolve_tree(table, options, 1).evaluations;
  });
  const std::vector<CsgTree> trees = clique_trees(scene);
  count("merge_m0", [&] {
    std::size_t nodes = 0;
    for (int i = 0; i < 10; ++i) nodes += total_size(merge_trees(trees).trees);
    return nodes;
  });
}

void count_simplification() {
  const std::vector<CsgTree> trees = random_trees(12, 16, 20'000);
  count("simplify", [&] {
    std::size_t nodes = 0;
    for (const CsgTree& tree : trees) nodes += simplify(tree).size();
    return nodes;
  });
}

void count_extraction(const char* name, const Scene& scene) {
  ExtractOptions options;
  options.parallel = Parallel::none;
  count(name, [&] { return extract_csg(scene.cloud, scene.model.primitives, options).tree().size(); });
}

void count_all() {
  use_avx2();
  const Scene m0("m0", k_points);
  const Scene m2("m2", k_points);
  count_overlap();
  count_steps(m0);
  count_simplification();
  count_extraction("extraction_m0", m0);
  count_extraction("extraction_m2", m2);
}

}  // namespace
}  // namespace cloud2csg::bench

int main() {
  cloud2csg::bench::count_all();
}
