#include <memory>
#include <stdexcept>

#include "cloud2csg/advanced/evolve.hpp"
#include "micro/work.hpp"
#include "scene.hpp"

/// Generations of the paper's genetic algorithm on M0's largest clique.
namespace cloud2csg::bench {
namespace {

GaOptions always_fifty_generations() {
  GaOptions options = paper_ga_options();
  options.generation_limit = 50;
  options.idle_generations = options.generation_limit;
  return options;
}

/// Counts only one look-up per class and scored tree, since tree sizes are unknown here.
Work search_work(const RankClasses& table, const Evolution& found) {
  const auto generations = static_cast<double>(found.generations);
  return {.unit = "generation",
          .units = generations,
          .look_ups = static_cast<double>(found.evaluations * table.class_count()) / generations,
          .look_up_rows = table.class_count(),
          .look_up_row = 2 * table.primitive_count() + 1};
}

}  // namespace

std::vector<Microbenchmark> search_benchmarks() {
  const auto table = std::make_shared<RankClasses>(largest_clique_table(Scene("m0", k_points)));
  const GaOptions options = always_fifty_generations();
  const Evolution found = evolve_tree(*table, options, 1);
  return {{"generations/m0_largest_clique", search_work(*table, found), [=] {
             if (evolve_tree(*table, options, 1).generations != found.generations)
               throw std::logic_error("another run");
           }}};
}

}  // namespace cloud2csg::bench
