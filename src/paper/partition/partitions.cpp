#include "paper/partition/partitions.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/run.hpp"
#include "core/geometry/boxes.hpp"

namespace cloud2csg {
namespace {

/// The oriented bounds, in its own frame, of the points on each unbounded primitive: only they matter for overlap.
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

/// Takes the components that `is_whole` accepts, then the cliques of the others.
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

class Cutter {
 public:
  Cutter(std::span<const AlignedBox> reach, std::size_t limit) : reach_(reach), limit_(limit) {}

  void cut(const Region& region) {
    std::optional<Halves> best;
    for (int axis = 0; axis < 3 && region.near.size() > limit_; ++axis) {
      std::optional<Halves> halves = cut_across(region, axis);
      if (halves && (!best || halves->larger() < best->larger())) best = std::move(halves);
    }
    // Cuts that part off little would be too many.
    if (!best || 8 * best->larger() > 7 * region.near.size()) {
      regions_.push_back(region);
      return;
    }
    cut(best->below);
    cut(best->above);
  }

  [[nodiscard]] std::vector<Region>& regions() { return regions_; }

 private:
  struct Halves {
    Region below, above;
    [[nodiscard]] std::size_t larger() const { return std::max(below.near.size(), above.near.size()); }
  };

  /// Cuts at the median of the middles of the boxes.
  [[nodiscard]] std::optional<Halves> cut_across(const Region& region, int axis) const {
    std::vector<double> middles;
    for (const PrimitiveIndex p : region.near) {
      const double middle = reach_[p].center()[axis];
      if (middle > region.box.min()[axis] && middle < region.box.max()[axis]) middles.push_back(middle);
    }
    if (middles.empty()) return std::nullopt;
    const auto median = middles.begin() + static_cast<std::ptrdiff_t>(middles.size() / 2);
    std::ranges::nth_element(middles, median);
    Halves halves{.below = region, .above = region};
    halves.below.box.max()[axis] = *median;
    halves.above.box.min()[axis] = *median;
    keep_near(halves.below);
    keep_near(halves.above);
    return halves;
  }

  void keep_near(Region& region) const {
    std::erase_if(region.near, [&](PrimitiveIndex p) { return !reach_[p].intersects(region.box); });
  }

  std::span<const AlignedBox> reach_;
  std::size_t limit_;
  std::vector<Region> regions_;
};

/// Bytes for a table in the making, when each of its points may be a class of its own.
constexpr std::size_t k_table_bytes = std::size_t{64} << 20U;

/// Tables over sets that are too large for k_table_bytes use every k-th point.
std::size_t stride_for(std::size_t primitives, std::size_t points) {
  if (primitives <= RankClasses::k_shared_limit) return 1;
  const std::size_t row_bytes = 2 * sizeof(double) * primitives;
  return std::max<std::size_t>(1, points * row_bytes / k_table_bytes);
}

PointPassOptions pass_options(const NoiseScale& scale, const ExtractOptions& options) {
  return {.tolerances = scale.tolerances,
          .objective = options.objective,
          .noise = scale.noise,
          .precision = options.precision};
}

/// Collects the tables that the search and the merge need.
class Requests {
 public:
  Requests(const PointCloud& cloud, const PrimitiveSet& primitives, const Partitions& partitions, double tolerance,
           const ExtractOptions& options)
      : cloud_(cloud), options_(options), partitions_(partitions) {
    for (const Primitive& primitive : primitives) {
      reach_.push_back(reach(primitive, tolerance));
    }
  }

  void add_partitions() {
    for (const Clique& partition : partitions_.sets) {
      add(partition, {}, stride_for(partition.size(), cloud_.size()), surroundings(partition));
    }
  }

  /// For a component of several partitions.
  std::vector<TableWindow> add_windows(const std::vector<PrimitiveIndex>& component) {
    if (component.size() <= k_whole_limit) {
      return {{.table = add(component, {}, stride_for(component.size(), cloud_.size()), {})}};
    }
    std::vector<TableWindow> windows;
    for (PrimitiveIndex local = 0; local < component.size(); ++local) {
      const PrimitiveIndex p = component[local];
      const std::vector<Region> regions = cut_into_regions(partitions_.graph.neighbours[p], reach_, k_whole_limit - 1);
      std::size_t largest = 0;
      for (const Region& region : regions) largest = std::max(largest, region.near.size() + 1);
      // A primitive's scores in its windows are added up, so points must weigh the same in all.
      const std::size_t stride = stride_for(largest, cloud_.size());
      for (const Region& region : regions) {
        std::vector<PrimitiveIndex> set = region.near;
        set.insert(std::ranges::upper_bound(set, p), p);
        const auto box = regions.size() == 1 ? std::nullopt : std::optional(region.box);
        windows.push_back({.table = add(std::move(set), {p}, stride, box), .judged = local});
      }
    }
    return windows;
  }

  [[nodiscard]] std::vector<RankClassesRequest> take() && { return std::move(requests_); }

 private:
  /// Whether it overlaps so many others that only those nearby may be looked at.
  [[nodiscard]] bool is_hub(PrimitiveIndex p) const { return partitions_.graph.neighbours[p].size() >= k_whole_limit; }

  std::size_t add(std::vector<PrimitiveIndex> primitives, std::vector<PrimitiveIndex> owners, std::size_t stride,
                  const std::optional<AlignedBox>& region) {
    requests_.push_back({.primitives = std::move(primitives),
                         .owners = std::move(owners),
                         .stride = stride,
                         .without_strangers = options_.without_strangers,
                         .region = region});
    return requests_.size() - 1;
  }

  /// Where a partition with hubs is judged: at its other primitives and around them. The paper judges by all points.
  [[nodiscard]] std::optional<AlignedBox> surroundings(const Clique& partition) const {
    const bool has_hub = std::ranges::any_of(partition, [&](PrimitiveIndex p) { return is_hub(p); });
    if (!has_hub || !options_.without_strangers || options_.strategy == Strategy::baseline) return std::nullopt;
    AlignedBox box;
    for (const PrimitiveIndex p : partition) {
      if (!is_hub(p)) box.extend(reach_[p]);
    }
    if (box.isEmpty() || !box.sizes().allFinite()) return std::nullopt;
    const Eigen::Vector3d margin = box.sizes() / 2;
    return AlignedBox(box.min() - margin, box.max() + margin);
  }

  const PointCloud& cloud_;
  const ExtractOptions& options_;
  const Partitions& partitions_;
  std::vector<AlignedBox> reach_;  // by primitive
  std::vector<RankClassesRequest> requests_;
};

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

std::vector<Region> cut_into_regions(std::span<const PrimitiveIndex> primitives, std::span<const AlignedBox> reach,
                                     std::size_t limit) {
  Cutter cutter(reach, limit);
  cutter.cut({.box = everywhere(), .near = {primitives.begin(), primitives.end()}});
  return std::move(cutter.regions());
}

PartitionTables build_partition_tables(const PointCloud& cloud, const PrimitiveSet& primitives,
                                       const Partitions& partitions, const NoiseScale& scale,
                                       const ExtractOptions& options, const RunContext& run) {
  Requests requests(cloud, primitives, partitions, scale.tolerances.distance, options);
  requests.add_partitions();
  PartitionTables tables;
  for (std::size_t c = 0; c < partitions.components.size(); ++c) {
    const std::vector<std::size_t>& sets = partitions.sets_of[c];
    tables.windows_of.push_back(sets.size() == 1 ? std::vector<TableWindow>{{.table = sets.front()}}
                                                 : requests.add_windows(partitions.components[c]));
  }
  tables.pass = build_rank_classes(cloud, primitives, std::move(requests).take(), pass_options(scale, options), run);
  return tables;
}

RankClasses build_table_over(const PrimitiveSet& members, const PointCloud& cloud, const NoiseScale& scale,
                             const ExtractOptions& options, bool all_points, const RunContext& run) {
  RankClassesRequest request{.primitives = std::vector<PrimitiveIndex>(members.size()),
                             .stride = stride_for(members.size(), cloud.size()),
                             .all_points = all_points};
  std::iota(request.primitives.begin(), request.primitives.end(), PrimitiveIndex{0});
  PointPass pass = build_rank_classes(cloud, members, std::span(&request, 1), pass_options(scale, options), run);
  return std::move(pass.tables.front());
}

}  // namespace cloud2csg
