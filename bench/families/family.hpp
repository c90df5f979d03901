#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/model.hpp"

/// Families of models with known truth, of any size: for measuring how the method scales and how good its trees are.
namespace cloud2csg {

enum class Family {
  /// Spheres, boxes, cylinders and cones in a row, each overlapping the next only, in pairs that are united or of
  /// which the first is cut by the second.
  chain,
  /// The paper's M2, 20 primitives, grown: spheres on a square lattice, all united, four to a clique.
  grid,
  /// Plates in a row, each with holes, bosses, bosses with a hole, and holes in which a hollow pin stands.
  plate,
  /// Clusters of solids of all kinds that all overlap each other, under a random tree each, joined by one bar each.
  random,
  /// Boxes in boxes: each nest is a box less (a box less (a box less ...)).
  nest,
  /// One panel with holes through it, bosses on it and round dents in it, on a lattice: it overlaps all others.
  panel,
};

/// All, in the order above.
[[nodiscard]] std::span<const Family> all_families();
constexpr auto names_of(Family /*any*/) {
  return std::to_array<EnumName<Family>>({{"chain", Family::chain},
                                          {"grid", Family::grid},
                                          {"plate", Family::plate},
                                          {"random", Family::random},
                                          {"nest", Family::nest},
                                          {"panel", Family::panel}});
}
/// @throws Error when there is none of this name.
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
  field(&O::primitives, "primitives", "Exactly so many", k_family_sizes);
  field(&O::clique_size, "clique_size",
        "random: primitives of a cluster, that is of a largest clique; the last may have fewer", k_clique_sizes);
  field(&O::least_clique_size, "least_clique_size",
        "random: clusters have this many to `clique_size` primitives, drawn evenly; 0: all have that many",
        OptionRange{.least = k_clique_sizes.least, .most = k_clique_sizes.most, .takes_zero = true});
  field(&O::levels, "levels", "nest: boxes in a nest; the last nest may have fewer", from_to(1, 8));
  field(&O::seed, k_seed);
}
/// More primitives in the least cluster than in the largest.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const FamilyOptions& options);

/// A model of a family. Its tree has each primitive as one leaf. All solids are bounded, and their overlap graph is
/// connected. Of each primitive, a part is surface of the solid, so that it can be recovered: about a twentieth of its
/// own surface at least. No faces coincide. Features are of about unit size, walls a tenth of that: noise of 0.01 (the
/// paper's) leaves them be, distances between solids that do not overlap as well. Along a spiral, so that a model of n
/// primitives is no larger than about sqrt(n). The same for the same options, always. O(n log n)
/// @throws Error as validate()
[[nodiscard]] Model make_family(Family family, const FamilyOptions& options = {});

}  // namespace cloud2csg
