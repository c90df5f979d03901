#include <memory>
#include <stdexcept>

#include "micro/work.hpp"
#include "random_solids.hpp"

/// Enumeration of maximal cliques in overlap graphs of random solids.
namespace cloud2csg::bench {
namespace {

/// Reads the graph once and writes the cliques once.
Work clique_work(const OverlapGraph& graph, std::span<const Clique> cliques) {
  std::size_t members = 0;
  for (const Clique& clique : cliques) members += clique.size();
  const auto count = static_cast<double>(cliques.size());
  const std::size_t graph_bytes = 2 * graph.edge_count() * sizeof(PrimitiveIndex);
  const std::size_t clique_bytes = members * sizeof(PrimitiveIndex);
  return {.unit = "clique",
          .units = count,
          .bytes_read = static_cast<double>(graph_bytes) / count,
          .bytes_written = static_cast<double>(clique_bytes) / count,
          .footprint = graph_bytes + clique_bytes};
}

}  // namespace

std::vector<Microbenchmark> clique_benchmarks() {
  std::vector<Microbenchmark> all;
  for (const double solids_a_unit : {1.0, 4.0}) {
    const auto graph = std::make_shared<OverlapGraph>(build_overlap_graph(random_solids(1000, solids_a_unit)));
    const std::size_t count = maximal_cliques(*graph).size();
    all.push_back(
        {solids_a_unit < 2 ? "cliques/sparse" : "cliques/dense", clique_work(*graph, maximal_cliques(*graph)), [=] {
           if (maximal_cliques(*graph).size() != count) throw std::logic_error("other cliques");
         }});
  }
  return all;
}

}  // namespace cloud2csg::bench
