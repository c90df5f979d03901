// Seconds for the overlap graph and its maximal cliques against the number of primitives, on one core: boxes, cylinders
// and spheres turned and placed at random in a cube that grows with their number, so that the degree stays the same.

#include <fmt/format.h>

#include <cmath>

#include "base/random.hpp"
#include "cloud2csg/overlap_graph.hpp"
#include "measure.hpp"

namespace cloud2csg::bench {
namespace {

PrimitiveSet random_solids(std::size_t count, double half_side, RandomStream& random) {
  PrimitiveSet solids;
  for (std::size_t i = 0; i < count; ++i) {
    const auto size = [&random] { return random.uniform(0.5, 1.0); };
    const Shape shape = i % 3 == 0   ? Shape(Box{.size = {size(), size(), size()}})
                        : i % 3 == 1 ? Shape(Cylinder{.radius = 0.5 * size(), .height = size()})
                                     : Shape(Sphere{.radius = 0.5 * size()});
    const auto coordinate = [&] { return random.uniform(-half_side, half_side); };
    solids.push_back(
        {.id = fmt::format("p{}", i),
         .shape = shape,
         .pose = {
             .position = {coordinate(), coordinate(), coordinate()},
             .orientation =
                 Eigen::Quaterniond{random.normal(), random.normal(), random.normal(), random.normal()}.normalized()}});
  }
  return solids;
}

void report(std::size_t count, double primitives_a_unit) {
  RandomStream random(count);
  const double half_side = 0.5 * std::cbrt(static_cast<double>(count) / primitives_a_unit);
  const PrimitiveSet solids = random_solids(count, half_side, random);
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
