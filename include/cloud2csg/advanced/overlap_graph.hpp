#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "cloud2csg/advanced/option_table.hpp"
#include "cloud2csg/primitive.hpp"
#include "cloud2csg/run_context.hpp"

/// Overlap graph and partitions (section 4 of the paper: PO-graph, maximal cliques).
namespace cloud2csg {

struct OverlapOptions {
  double tolerance = 1e-6;
  /// For infinite primitives (half-spaces): oriented bounds of the points they were fitted to, by primitive index. An
  /// absent entry means the primitive itself. May be shorter than the primitive set.
  std::vector<std::optional<OrientedBox>> extents = {};
};
void option_table(OptionsOf<OverlapOptions>, auto&& field) {
  field(&OverlapOptions::tolerance, "tolerance",
        "Distance below which solids count as overlapping, in the cloud's units, so that touching faces overlap. The "
        "pipeline sets it from the measured noise.",
        at_least(0));
}
/// Refuses extents that are not finite boxes.
[[nodiscard]] std::optional<OptionConflict> conflict_in(const OverlapOptions& options);

/// Undirected, without loops: an edge joins each pair of primitives whose solids share space.
struct OverlapGraph {
  std::vector<std::vector<PrimitiveIndex>> neighbours;  ///< by primitive, each list ascending

  [[nodiscard]] std::size_t size() const { return neighbours.size(); }
  [[nodiscard]] bool has_edge(PrimitiveIndex a, PrimitiveIndex b) const;
  [[nodiscard]] std::size_t edge_count() const;
};

/// Broad phase by an R-tree over the bounds, O(n log n + pairs). The narrow phase is exact for convex pairs (libccd)
/// and uses the distance fields for all others. A solid inside another one overlaps it.
/// @throws Cancelled
[[nodiscard]] OverlapGraph build_overlap_graph(const PrimitiveSet& primitives, const OverlapOptions& options = {},
                                               const RunContext& run = {});

/// Primitives that all overlap each other, ascending: the paper's partition.
using Clique = std::vector<PrimitiveIndex>;

/// All maximal cliques in lexicographic order, by Bron-Kerbosch with pivoting in degeneracy order. A primitive without
/// neighbours is a clique of one. O(d n 3^(d/3)) for degeneracy d.
[[nodiscard]] std::vector<Clique> maximal_cliques(const OverlapGraph& graph);

/// Number of cliques with 1, 2, 3... primitives, as in the paper's table of models.
[[nodiscard]] std::vector<std::size_t> clique_histogram(std::span<const Clique> cliques);

/// The connected components, each ascending, ordered by their first primitive.
[[nodiscard]] std::vector<std::vector<PrimitiveIndex>> connected_components(const OverlapGraph& graph);

}  // namespace cloud2csg
