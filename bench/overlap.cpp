// Seconds for the overlap graph and its maximal cliques by number of primitives, on one core.

#include <fmt/format.h>

#include "measure.hpp"
#include "random_solids.hpp"

namespace cloud2csg::bench {
namespace {

void report(std::size_t count, double primitives_a_unit) {
  const PrimitiveSet solids = random_solids(count, primitives_a_unit);
  OverlapGraph graph;
  const Timing building = time_runs(5, [&] { graph = build_overlap_graph(solids); });
  std::vector<Clique> cliques;
  const Timing enumerating = time_runs(5, [&] { cliques = maximal_cliques(graph); });
  fmt::print("| {:10} | {:8} | {:6.1f} | {:9} | {:7} | {:9.1f} | {:11.1f} |\n", count, graph.edge_count(),
             2.0 * static_cast<double>(graph.edge_count()) / static_cast<double>(count), cliques.size(),
             clique_histogram(cliques).size(), building.median * 1e3, enumerating.median * 1e3);
}

}  // namespace
}  // namespace cloud2csg::bench

int main() {
  fmt::print("Overlap graph and maximal cliques of random solids, one core, medians of 5, milliseconds\n\n");
  fmt::print("| primitives | overlaps | degree | cliques   | largest | graph, ms | cliques, ms |\n");
  fmt::print("|------------|----------|--------|-----------|---------|-----------|-------------|\n");
  for (const double primitives_a_unit : {1.0, 4.0}) {
    for (const std::size_t count : {100U, 1'000U, 10'000U}) cloud2csg::bench::report(count, primitives_a_unit);
  }
}
