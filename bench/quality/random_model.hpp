#pragma once

#include <cstdint>
#include <string>

#include "bench/families/family.hpp"

namespace cloud2csg::bench {

struct RandomModel {
  Family family = Family::random;
  FamilyOptions options = {};
  /// Number of repeated leaves. If above 0, the model gets another tree, in which some primitives appear again.
  std::size_t repeats = 0;
};

[[nodiscard]] Model make_model(const RandomModel& random_model);

inline constexpr std::size_t k_points_per_primitive = 400;

/// Out of ten consecutive seeds, six give family random, and one each nest, plate, chain and panel.
[[nodiscard]] Family family_of_seed(std::uint64_t seed);
/// A model of 5 to 40 primitives, clusters of up to 2 to 12, nests of 2 to 5 levels; a function of family and seed.
[[nodiscard]] RandomModel draw_model(Family family, std::uint64_t seed);

/// The row of a model in a table: "random, cliques of 2-7", "one cluster of 12".
[[nodiscard]] std::string kind_of(const RandomModel& model);
/// As in source code: "make_family(Family::random, {.primitives = 23, .clique_size = 7, ...})".
[[nodiscard]] std::string source_of(const RandomModel& model);

}  // namespace cloud2csg::bench
