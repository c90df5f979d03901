#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

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
/// "chain", "grid", "plate", "random", "nest", "panel"
[[nodiscard]] std::string_view to_string(Family family);
/// @throws Error when there is none of this name.
[[nodiscard]] Family family_of(std::string_view name);

struct FamilyOptions {
  std::size_t primitives = 20;  ///< exactly so many
  /// random: primitives of a cluster, that is of a largest clique, 2 to 20; the last may have fewer.
  std::size_t clique_size = 4;
  /// random: clusters have this many to clique_size primitives, drawn evenly; 0: all have clique_size.
  std::size_t least_clique_size = 0;
  std::size_t levels = 5;  ///< nest: boxes in a nest, 1 to 8; the last nest may have fewer
  std::uint64_t seed = 1;
};
/// @throws Error naming the field
void validate(const FamilyOptions& options);

/// A model of a family. Its tree has each primitive as one leaf. All solids are bounded, and their overlap graph is
/// connected. Of each primitive, a part is surface of the solid, so that it can be recovered: about a twentieth of its
/// own surface at least. No faces coincide. Features are of about unit size, walls a tenth of that: noise of 0.01 (the
/// paper's) leaves them be, distances between solids that do not overlap as well. Along a spiral, so that a model of n
/// primitives is no larger than about sqrt(n). The same for the same options, always. O(n log n)
/// @throws Error as validate()
[[nodiscard]] Model make_family(Family family, const FamilyOptions& options = {});

}  // namespace cloud2csg
