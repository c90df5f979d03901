#include "paper/evolve/genetic_algorithm.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <numeric>

#include "core/base/parallel.hpp"

namespace cloud2csg {
namespace {

int level_of(const CsgTree& tree, std::size_t node) {
  int level = 0;
  for (std::size_t above = node + 1; above < tree.size(); ++above) {
    if (above + 1 - tree.nodes()[above].length() <= node) ++level;
  }
  return level;
}

CsgTree with_subtree(const CsgTree& tree, std::size_t node, std::span<const CsgNode> replacement, int height_limit) {
  CsgTree child = tree;
  child.replace(node, replacement);
  return depth(child) <= static_cast<std::size_t>(height_limit) ? child : tree;
}

enum class Stream : std::uint64_t { first_generation = 0x6761'0001, breeding = 0x6761'0002 };

/// Every child is a pure function of (seed, item, generation, place), so any number of threads may breed.
class GeneticAlgorithm {
 public:
  GeneticAlgorithm(const TreeObjective& objective, const GaOptions& options, std::uint64_t item, const RunContext& run)
      : primitives_(objective.primitives),
        options_(options),
        item_(item),
        run_(run),
        height_limit_(options.height_limit.value_or(default_height_limit(primitives_))),
        population_(static_cast<std::size_t>(options.population)),
        next_(population_.size()),
        evaluators_(TreeEvaluator(objective)) {}

  Evolution run(std::span<const CsgTree> seeds) {
    first_generation(seeds);
    ScoredTree best = population_[order_.front()];
    std::size_t generation = 0;
    int idle = 0;
    bool complete = true;
    while (idle < options_.idle_generations && generation < static_cast<std::size_t>(options_.generation_limit)) {
      if (run_.stop.stop_requested()) {
        complete = false;
        break;
      }
      run_.report("search", generation, 0, "generations");
      breed(++generation);
      ++idle;
      if (population_[order_.front()].score > best.score) {
        best = population_[order_.front()];
        idle = 0;
      }
    }
    return {.tree = best.tree,
            .score = best.score,
            .geometry = evaluators_.local().geometry(best.tree),
            .generations = generation,
            .evaluations = count_evaluations(),
            .complete = complete};
  }

 private:
  [[nodiscard]] RandomStream stream(Stream name, std::size_t generation, std::size_t place) const {
    return RandomStream(options_.seed, static_cast<std::uint64_t>(name), item_, generation << 32U | place);
  }

  void first_generation(std::span<const CsgTree> seeds) {
    for_each_index_in_arena(population_.size(), run_, [&](std::size_t i) {
      RandomStream random = stream(Stream::first_generation, 0, i);
      ScoredTree& individual = population_[i];
      individual.tree = i < seeds.size() ? seeds[i] : random_tree(primitives_, height_limit_, random);
      individual.score = evaluators_.local().score(individual.tree);
    });
    rank();
  }

  void breed(std::size_t generation) {
    const auto elites = std::min(static_cast<std::size_t>(options_.elites), population_.size());
    for (std::size_t i = 0; i < elites; ++i) next_[i] = population_[order_[i]];
    const std::size_t pairs = (population_.size() - elites + 1) / 2;
    for_each_index_in_arena(pairs, run_, [&](std::size_t pair) {
      RandomStream random = stream(Stream::breeding, generation, pair);
      const CsgTree& mother = tournament(random);
      const CsgTree& father = tournament(random);
      Children children = random.chance(options_.crossover_rate) ? crossover(mother, father, height_limit_, random)
                                                                 : Children{mother, father};
      const std::size_t place = elites + 2 * pair;
      place_child(place, std::move(children.first), random);
      if (place + 1 < next_.size()) place_child(place + 1, std::move(children.second), random);
    });
    population_.swap(next_);
    rank();
  }

  void place_child(std::size_t place, CsgTree child, RandomStream& random) {
    if (random.chance(options_.mutation_rate)) {
      child = random.chance(options_.new_tree_rate) ? random_tree(primitives_, height_limit_, random)
                                                    : mutate_subtree(child, primitives_, height_limit_, random);
    }
    next_[place].score = evaluators_.local().score(child);
    next_[place].tree = std::move(child);
  }

  [[nodiscard]] const CsgTree& tournament(RandomStream& random) const {
    const ScoredTree* winner = &population_[random.below(population_.size())];
    for (int round = 1; round < options_.tournament; ++round) {
      const ScoredTree& rival = population_[random.below(population_.size())];
      if (rival.score > winner->score) winner = &rival;
    }
    return winner->tree;
  }

  /// Puts the elites' places first in `order_`, best first, ties by place.
  void rank() {
    order_.resize(population_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    const auto last = order_.begin() + std::max(1, std::min(options_.elites, options_.population));
    std::partial_sort(order_.begin(), last, order_.end(), [this](std::size_t a, std::size_t b) {
      return population_[a].score != population_[b].score ? population_[a].score > population_[b].score : a < b;
    });
  }

  [[nodiscard]] std::size_t count_evaluations() const {
    std::size_t count = 0;
    for (const TreeEvaluator& evaluator : evaluators_) count += evaluator.evaluations();
    return count;
  }

  std::size_t primitives_;
  const GaOptions& options_;
  std::uint64_t item_;
  const RunContext& run_;
  int height_limit_;
  std::vector<ScoredTree> population_, next_;
  std::vector<std::size_t> order_;
  oneapi::tbb::enumerable_thread_specific<TreeEvaluator> evaluators_;
};

}  // namespace

CsgTree random_tree(std::size_t count, int height, RandomStream& random) {
  if (height <= 0 || random.chance(0.5)) return CsgTree::leaf(random.below(count));
  const std::uint32_t operation = random.below(4);
  const CsgTree first = random_tree(count, height - 1, random);
  if (operation == 3) return complement(first);
  const CsgTree second = random_tree(count, height - 1, random);
  return operation == 0 ? unite(first, second) : operation == 1 ? intersect(first, second) : subtract(first, second);
}

Children crossover(const CsgTree& a, const CsgTree& b, int height_limit, RandomStream& random) {
  const std::size_t at_a = random.below(a.size());
  const std::size_t at_b = random.below(b.size());
  return {with_subtree(a, at_a, b.subtree(at_b), height_limit), with_subtree(b, at_b, a.subtree(at_a), height_limit)};
}

CsgTree mutate_subtree(const CsgTree& tree, std::size_t primitives, int height_limit, RandomStream& random) {
  const std::size_t node = random.below(tree.size());
  const CsgTree fresh = random_tree(primitives, height_limit - level_of(tree, node), random);
  CsgTree child = tree;
  child.replace(node, fresh.nodes());
  return child;
}

TreeObjective objective_on(const RankClasses& table) {
  return {.primitives = table.primitive_count(),
          .geometry = [&table,
                       scratch = RankScratch()](const CsgTree& tree) mutable { return table.geometry(tree, scratch); },
          .alpha = table.objective().alpha,
          .work_per_node = static_cast<double>(table.class_count())};
}

Evolution run_genetic_algorithm(const TreeObjective& objective, std::span<const CsgTree> seeds,
                                const GaOptions& options, std::uint64_t item, const RunContext& run) {
  return GeneticAlgorithm(objective, options, item, run).run(seeds);
}

}  // namespace cloud2csg
