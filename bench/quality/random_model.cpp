#include "quality/random_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/random.hpp"

namespace cloud2csg::bench {
namespace {

constexpr std::uint64_t k_stream = 0x7175616c697479;
constexpr std::size_t k_least_clique = 2, k_most_clique = 12;
constexpr std::size_t k_least_primitives = 5, k_most_primitives = 40;
constexpr std::size_t k_least_levels = 2, k_most_levels = 5;
constexpr std::array k_turns{Family::random, Family::nest,   Family::random, Family::plate,  Family::random,
                             Family::chain,  Family::random, Family::panel,  Family::random, Family::random};

std::size_t draw_between(std::size_t least, std::size_t most, RandomStream& random) {
  return least + random.below(most + 1 - least);
}

}  // namespace

Family family_of_seed(std::uint64_t seed) {
  return k_turns[seed % k_turns.size()];
}

RandomModel draw_model(Family family, std::uint64_t seed) {
  RandomStream random(seed, k_stream);
  RandomModel model{.family = family, .options = {.seed = seed}};
  std::size_t least_primitives = k_least_primitives;
  if (family == Family::random) {
    model.options.clique_size = draw_between(k_least_clique, k_most_clique, random);
    model.options.least_clique_size = k_least_clique;
    least_primitives = std::max(least_primitives, model.options.clique_size);
  }
  if (family == Family::nest) model.options.levels = draw_between(k_least_levels, k_most_levels, random);
  model.options.primitives = draw_between(least_primitives, k_most_primitives, random);
  return model;
}

std::string kind_of(const RandomModel& model) {
  if (model.family != Family::random) return std::string(to_string(model.family));
  return fmt::format("{}, cliques of {}-{}", to_string(model.family), k_least_clique, model.options.clique_size);
}

std::string source_of(const RandomModel& model) {
  std::string special;
  if (model.family == Family::random) {
    special = fmt::format(".clique_size = {}, .least_clique_size = {}, ", model.options.clique_size,
                          model.options.least_clique_size);
  }
  if (model.family == Family::nest) special = fmt::format(".levels = {}, ", model.options.levels);
  return fmt::format("make_family(Family::{}, {{.primitives = {}, {}.seed = {}}})", to_string(model.family),
                     model.options.primitives, special, model.options.seed);
}

}  // namespace cloud2csg::bench
