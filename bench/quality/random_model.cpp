#include "quality/random_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <vector>

#include "cloud2csg/csg_tree.hpp"
#include "core/base/random.hpp"

namespace cloud2csg::bench {
namespace {

constexpr std::uint64_t k_model_stream = 0x7175616c697479;
constexpr std::uint64_t k_tree_stream = 0x72657065617473;
constexpr std::size_t k_least_clique = 2, k_most_clique = 12;
constexpr std::size_t k_least_primitives = 5, k_most_primitives = 40;
constexpr std::size_t k_least_levels = 2, k_most_levels = 5;
constexpr std::array k_turns{Family::random, Family::nest,   Family::random, Family::plate,  Family::random,
                             Family::chain,  Family::random, Family::panel,  Family::random, Family::random};

std::size_t draw_between(std::size_t least, std::size_t most, RandomStream& random) {
  return least + random.below(most + 1 - least);
}

CsgTree draw_term(std::span<const PrimitiveIndex> leaves, RandomStream& random) {
  CsgTree term = CsgTree::leaf(leaves.front());
  for (const PrimitiveIndex p : leaves.subspan(1)) {
    const CsgTree leaf = CsgTree::leaf(p);
    term = random.chance(0.4) ? intersect(term, leaf) : subtract(term, leaf);
  }
  return term;
}

/// Draws terms of one to three leaves, most of them united: each primitive once, plus `repeats` repeated leaves.
CsgTree draw_repeating_tree(std::size_t primitives, std::size_t repeats, RandomStream& random) {
  std::vector<PrimitiveIndex> leaves(primitives);
  std::iota(leaves.begin(), leaves.end(), PrimitiveIndex{0});
  for (std::size_t i = 0; i < repeats; ++i) leaves.push_back(static_cast<PrimitiveIndex>(random.below(primitives)));
  for (std::size_t i = leaves.size(); i > 1; --i) std::swap(leaves[i - 1], leaves[random.below(i)]);
  CsgTree tree = CsgTree::empty();
  for (std::size_t begin = 0; begin < leaves.size();) {
    const std::size_t length = std::min<std::size_t>(1 + random.below(3), leaves.size() - begin);
    const CsgTree term = draw_term(std::span(leaves).subspan(begin, length), random);
    tree = begin == 0 || random.chance(0.75) ? unite(tree, term) : subtract(tree, term);
    begin += length;
  }
  return simplify(tree);
}

/// Share of the primitives' bounds inside the tree, from a thousand places.
double volume_share(const CsgTree& tree, const PrimitiveSet& primitives, RandomStream& random) {
  AlignedBox box;
  for (const Primitive& primitive : primitives) box.extend(bounds(primitive));
  Points places;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d share(random.uniform(), random.uniform(), random.uniform());
    places.push_back(box.min() + share.cwiseProduct(box.sizes()));
  }
  const std::vector<double> values = implicit_value(tree, primitives, places);
  return static_cast<double>(std::ranges::count_if(values, [](double value) { return value < 0; })) / 1000;
}

}  // namespace

Model make_model(const RandomModel& random_model) {
  Model model = make_family(random_model.family, random_model.options);
  if (random_model.repeats == 0) return model;
  constexpr double k_least_share = 0.01;  // a smaller solid is hardly visible
  RandomStream random(random_model.options.seed, k_tree_stream);
  do {
    model.tree = draw_repeating_tree(model.primitives.size(), random_model.repeats, random);
  } while (volume_share(*model.tree, model.primitives, random) < k_least_share);
  return model;
}

Family family_of_seed(std::uint64_t seed) {
  return k_turns[seed % k_turns.size()];
}

RandomModel draw_model(Family family, std::uint64_t seed) {
  RandomStream random(seed, k_model_stream);
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
  if (model.options.least_clique_size == 0) {
    const std::string leaves =
        model.repeats == 0 ? "" : fmt::format(", {} leaves", model.options.primitives + model.repeats);
    return fmt::format("one cluster of {}{}", model.options.primitives, leaves);
  }
  return fmt::format("{}, cliques of {}-{}", to_string(model.family), k_least_clique, model.options.clique_size);
}

std::string source_of(const RandomModel& model) {
  std::string special;
  if (model.family == Family::random) {
    special = fmt::format(".clique_size = {}, .least_clique_size = {}, ", model.options.clique_size,
                          model.options.least_clique_size);
  }
  if (model.family == Family::nest) special = fmt::format(".levels = {}, ", model.options.levels);
  const std::string repeats = model.repeats == 0 ? "" : fmt::format(", {} leaves more", model.repeats);
  return fmt::format("make_family(Family::{}, {{.primitives = {}, {}.seed = {}}}){}", to_string(model.family),
                     model.options.primitives, special, model.options.seed, repeats);
}

}  // namespace cloud2csg::bench
