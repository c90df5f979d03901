#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/model.hpp"

/// Families of models of any size with known truth, to measure scaling and the quality of trees.
namespace cloud2csg {

enum class Family {
  /// Spheres, boxes, cylinders and cones in a row that overlap neighbours only. Each pair is a union or a difference.
  chain,
  /// The paper's M2 (20 primitives), grown: a square lattice of united spheres, four to a clique.
  grid,
  /// Plates in a row with holes, bosses, hollow bosses, and holes around a hollow pin.
  plate,
  /// Clusters of mutually overlapping solids of all kinds, each under a random tree, joined by one bar each.
  random,
  /// Nested boxes: each nest is a box - (a box - (a box - ...)).
  nest,
  /// One panel with a lattice of holes, bosses and round dents: it overlaps all others.
  panel,
};

/// All families in declaration order.
[[nodiscard]] std::span<const Family> all_families();
constexpr auto names_of(Family /*any*/) {
  return std::to_array<EnumName<Family>>({{"chain", Family::chain},
                                          {"grid", Family::grid},
                                          {"plate", Family::plate},
                                          {"random", Family::random},
                                          {"nest", Family::nest},
                                          {"panel", Family::panel}});
}
/// @throws Error for an unknown name.
[[nodiscard]] Family family_of(std::string_view name);

struct FamilyOptions {
  std::size_t primitives = 20;
  std::size_t clique_size = 4;
  std::size_t least_clique_size = 0;
  std::size_t levels = 5;
  std::uint64_t seed = 1;
};
inline constexpr OptionRange k_family_sizes = from_to(1, 1e6);
inline constexpr OptionRange k_clique_sizes = from_to(2, 20);
void option_table(OptionsOf<FamilyOptions>, auto&& field) {
  using O = FamilyOptions;
  field(&O::primitives, "primitives", "Exact number of primitives", k_family_sizes);
  field(&O::clique_size, "clique_size",
        "random: primitives per cluster, that is per largest clique; the last may have fewer", k_clique_sizes);
  field(&O::least_clique_size, "least_clique_size",
        "random: clusters have this many to `clique_size` primitives, evenly distributed; 0: all have `clique_size`",
        OptionRange{.least = k_clique_sizes.least, .most = k_clique_sizes.most, .takes_zero = true});
  field(&O::levels, "levels", "nest: boxes per nest; the last nest may have fewer", from_to(1, 8));
  field(&O::seed, k_seed);
}
/// Refuses a least cluster size above the largest.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const FamilyOptions& options);

/// A model of a family with n primitives, each of them one leaf of the tree. All solids are bounded, their overlap
/// graph is connected, and no faces coincide. At least about a twentieth of each primitive's surface is surface of the
/// solid, so that the primitive can be recovered. Features have about unit size and walls a tenth of it. Noise of 0.01
/// (the paper's) preserves them and the gaps between disjoint solids. Parts lie along a spiral, so the size grows like
/// sqrt(n). Deterministic for given options. O(n log n)
/// @throws Error as validate()
[[nodiscard]] Model make_family(Family family, const FamilyOptions& options = {});

}  // namespace cloud2csg
