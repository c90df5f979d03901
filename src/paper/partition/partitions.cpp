#include "paper/partition/partitions.hpp"

#include <numeric>

#include "core/base/run.hpp"

namespace cloud2csg {
namespace {

/// The oriented bounds of the points on each unbounded primitive, in its own frame: what of it matters for overlap.
std::vector<std::optional<OrientedBox>> extents_of_unbounded(const PointCloud& cloud, const PrimitiveSet& primitives,
                                                             const SegmentationTolerances& tolerances,
                                                             const RunContext& run) {
  std::vector<std::optional<OrientedBox>> extents(primitives.size());
  for (std::size_t p = 0; p < extents.size(); ++p) {
    const Primitive& primitive = primitives[p];
    if (!std::holds_alternative<HalfSpace>(primitive.shape)) continue;
    const Segmentation segmentation = segment_points(cloud, {primitive}, tolerances, run);
    AlignedBox local;
    for (const std::uint32_t point : segmentation.points_of.front()) {
      local.extend(primitive.pose.to_local(cloud.positions[point]));
    }
    if (local.isEmpty()) continue;
    extents[p] =
        OrientedBox{.pose = compose(primitive.pose, {.position = local.center()}), .half_size = local.sizes() / 2};
  }
  return extents;
}

/// One partition with all primitives: the paper's baseline.
void take_all_at_once(Partitions& partitions) {
  Clique all(partitions.graph.size());
  std::iota(all.begin(), all.end(), PrimitiveIndex{0});
  partitions.components = {all};
  partitions.sets = {std::move(all)};
  partitions.component_of = {0};
}

/// Components that `is_whole` says so of, then the cliques of the others.
template <typename IsWhole>
void take_cliques(Partitions& partitions, IsWhole is_whole) {
  std::vector<std::size_t> component_of_primitive(partitions.graph.size());
  for (std::size_t c = 0; c < partitions.components.size(); ++c) {
    for (const PrimitiveIndex p : partitions.components[c]) component_of_primitive[p] = c;
    if (!is_whole(partitions.components[c])) continue;
    partitions.sets.push_back(partitions.components[c]);
    partitions.component_of.push_back(c);
  }
  for (const Clique& clique : partitions.cliques) {
    const std::size_t component = component_of_primitive[clique.front()];
    if (is_whole(partitions.components[component])) continue;
    partitions.sets.push_back(clique);
    partitions.component_of.push_back(component);
  }
}

}  // namespace

OverlapGraph overlap_graph_of(const PointCloud& cloud, const PrimitiveSet& primitives, const NoiseScale& scale,
                              const ExtractOptions& options, const RunContext& run) {
  return build_overlap_graph(primitives,
                             {.tolerance = options.overlap_tolerance.value_or(scale.noise),
                              .extents = extents_of_unbounded(cloud, primitives, scale.tolerances, run)},
                             run);
}

Partitions partition_primitives(const PointCloud& cloud, const PrimitiveSet& primitives, const NoiseScale& scale,
                                const ExtractOptions& options, const RunContext& run) {
  Partitions partitions;
  Stopwatch watch;
  partitions.graph = overlap_graph_of(cloud, primitives, scale, options, run);
  partitions.overlap_seconds = watch.lap();
  partitions.cliques = maximal_cliques(partitions.graph);
  partitions.components = connected_components(partitions.graph);
  if (options.strategy == Strategy::baseline) {
    take_all_at_once(partitions);
  } else {
    take_cliques(partitions, [&options](const std::vector<PrimitiveIndex>& component) {
      return options.strategy == Strategy::automatic && component.size() <= options.search.listing_limit;
    });
  }
  partitions.sets_of.resize(partitions.components.size());
  for (std::size_t k = 0; k < partitions.sets.size(); ++k) partitions.sets_of[partitions.component_of[k]].push_back(k);
  partitions.partition_seconds = watch.lap();
  return partitions;
}

}  // namespace cloud2csg
