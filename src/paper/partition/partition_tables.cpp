#include "paper/partition/partition_tables.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "paper/partition/regions.hpp"

namespace cloud2csg {
namespace {

/// How many bytes a table may take while it is made, when each of its points may be a class of its own.
constexpr std::size_t k_table_bytes = std::size_t{64} << 20U;

/// Tables over sets that are too large for that use every k-th point.
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

/// Of the tables that the search and the merge need.
class Requests {
 public:
  Requests(const PointCloud& cloud, const PrimitiveSet& primitives, const Partitions& partitions, double tolerance,
           const ExtractOptions& options)
      : cloud_(cloud), options_(options), partitions_(partitions) {
    for (const Primitive& primitive : primitives) {
      reach_.push_back(reach(primitive, tolerance));
    }
  }

  /// One a partition.
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
      // What a primitive scores in its windows is added up: points must weigh the same in all.
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
  /// Overlaps so many others that only those nearby may be looked at.
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

  /// Where a partition with hubs is decided: at its other primitives, and around them. The paper judges by all points.
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
